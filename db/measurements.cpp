// Runs of other benchmark programs, in one transaction each.
#include "db/measurements.hpp"

#include "db/rows.hpp"
#include "db/sqlite/statement.hpp"
#include "db/sqlite/transaction.hpp"

namespace sipplab::db {
namespace {

using sqlite::Connection;

constexpr const char* kWritingMeasurements = "writing measurements";

}  // namespace

Result<MeasurementsRecorded> record_measurements(Database& database, const MeasurementRun& run) {
  Connection& connection = database.connection();
  auto transaction = SIPPLAB_TRY(sqlite::Transaction::begin(connection));
  RunRow listed;
  listed.uuid = run.uuid;
  listed.kind = "report";
  listed.suite = run.info.suite;
  listed.started_utc = run.started_utc;
  listed.wall_time_ns = 0;  // reports say when they began, not for how long they ran
  listed.command_line = run.info.command_line;
  listed.options = run.info.options;
  const auto run_id = SIPPLAB_TRY(insert_run(connection, run.info, listed));
  if (!run_id) return MeasurementsRecorded{true};
  for (const Measurement& measurement : run.measurements) {
    SIPPLAB_TRY(sqlite::run(connection,
                            "INSERT INTO measurement (run_id, benchmark, repetition, iterations, "
                            "real_time_ns, cpu_time_ns, error, aggregate, threads, label) "
                            "VALUES (?, ?, ?, ?, ?, ?, ?, ?, ?, ?)",
                            kWritingMeasurements, *run_id, measurement.benchmark, measurement.repetition,
                            measurement.iterations, measurement.real_time_ns, measurement.cpu_time_ns,
                            null_if_empty(measurement.error), measurement.aggregate, measurement.threads,
                            measurement.label));
    for (const auto& [name, value] : measurement.counters) {
      SIPPLAB_TRY(sqlite::run(connection,
                              "INSERT INTO measurement_counter (run_id, benchmark, repetition, "
                              "counter, value) VALUES (?, ?, ?, ?, ?)",
                              kWritingMeasurements, *run_id, measurement.benchmark, measurement.repetition,
                              name, value));
    }
  }
  SIPPLAB_TRY(transaction.commit());
  return MeasurementsRecorded{false};
}

}  // namespace sipplab::db
