// Runs of other benchmark programs, in one transaction each.
#include "db/measurements.hpp"

#include "db/rows.hpp"
#include "db/sqlite/statement.hpp"
#include "db/sqlite/transaction.hpp"

namespace sipplab::db {
namespace {

using sqlite::Connection;
using sqlite::Statement;

constexpr const char* kWritingMeasurements = "writing measurements";

}  // namespace

Result<MeasurementsRecorded> record_measurements(Database& database, const MeasurementRun& run) {
  Connection& connection = database.connection();
  auto transaction = sqlite::Transaction::begin(connection);
  if (!transaction) return Unexpected{transaction.error()};
  RunRow listed;
  listed.uuid = run.uuid;
  listed.kind = "report";
  listed.suite = run.info.suite;
  listed.started_utc = run.started_utc;
  listed.wall_time_ns = 0;  // reports say when they began, not for how long they ran
  listed.command_line = run.info.command_line;
  listed.options = run.info.options;
  const auto run_id = insert_run(connection, run.info, listed);
  if (!run_id) return Unexpected{run_id.error()};
  if (!*run_id) return MeasurementsRecorded{true};
  auto insert = Statement::prepare(connection,
                                   "INSERT INTO measurement (run_id, benchmark, repetition, iterations, "
                                   "real_time_ns, cpu_time_ns, error, aggregate, threads, label) "
                                   "VALUES (?, ?, ?, ?, ?, ?, ?, ?, ?, ?)",
                                   kWritingMeasurements);
  if (!insert) return Unexpected{insert.error()};
  auto insert_counter = Statement::prepare(connection,
                                           "INSERT INTO measurement_counter (run_id, benchmark, repetition, "
                                           "counter, value) VALUES (?, ?, ?, ?, ?)",
                                           kWritingMeasurements);
  if (!insert_counter) return Unexpected{insert_counter.error()};
  for (const Measurement& measurement : run.measurements) {
    insert->bind(**run_id, measurement.benchmark, measurement.repetition, measurement.iterations,
                 measurement.real_time_ns, measurement.cpu_time_ns, null_if_empty(measurement.error),
                 measurement.aggregate, measurement.threads, measurement.label);
    if (auto done = insert->run(); !done) return Unexpected{done.error()};
    for (const auto& [name, value] : measurement.counters) {
      insert_counter->bind(**run_id, measurement.benchmark, measurement.repetition, name, value);
      if (auto done = insert_counter->run(); !done) return Unexpected{done.error()};
    }
  }
  if (auto done = transaction->commit(); !done) return Unexpected{done.error()};
  return MeasurementsRecorded{false};
}

}  // namespace sipplab::db
