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

/// The key of the new run; none where it is there already.
Result<std::optional<std::int64_t>> insert_run(Connection& connection, const MeasurementRun& run) {
  const auto keys = origin_keys(connection, run.info.commit, run.info.machine, run.info.build);
  if (!keys) return Unexpected{keys.error()};
  auto insert = Statement::prepare(
      connection,
      "INSERT INTO run (uuid, suite, started_utc, ended_utc, status, commit_id, machine_id, build_id, "
      "branch, "
      "command_line, options, seed, time_limit_s, writer) "
      "VALUES (?1, ?2, ?3, ?3, 'finished', ?4, ?5, ?6, ?7, ?8, '', 0, ?9, '') ON CONFLICT (uuid) DO NOTHING",
      kWritingMeasurements);
  if (!insert) return Unexpected{insert.error()};
  insert->bind(run.uuid, run.info.suite, run.started_utc, keys->commit, keys->machine, keys->build,
               run.info.branch, run.info.command_line, kNoTimeLimit);
  if (auto done = insert->run(); !done) return Unexpected{done.error()};
  if (connection.changes() == 0) return std::optional<std::int64_t>{};
  return std::optional<std::int64_t>{connection.last_insert_rowid()};
}

}  // namespace

Result<MeasurementsRecorded> record_measurements(Database& database, const MeasurementRun& run) {
  Connection& connection = database.connection();
  auto transaction = sqlite::Transaction::begin(connection);
  if (!transaction) return Unexpected{transaction.error()};
  const auto run_id = insert_run(connection, run);
  if (!run_id) return Unexpected{run_id.error()};
  if (!*run_id) return MeasurementsRecorded{true};
  auto insert = Statement::prepare(connection,
                                   "INSERT INTO measurement (run_id, benchmark, repetition, iterations, "
                                   "real_time_ns, cpu_time_ns, error) VALUES (?, ?, ?, ?, ?, ?, ?)",
                                   kWritingMeasurements);
  if (!insert) return Unexpected{insert.error()};
  auto insert_counter = Statement::prepare(connection,
                                           "INSERT INTO measurement_counter (run_id, benchmark, repetition, "
                                           "counter, value) VALUES (?, ?, ?, ?, ?)",
                                           kWritingMeasurements);
  if (!insert_counter) return Unexpected{insert_counter.error()};
  for (const Measurement& measurement : run.measurements) {
    std::optional<std::string> error;
    if (!measurement.error.empty()) error = measurement.error;
    insert->bind(**run_id, measurement.benchmark, measurement.repetition, measurement.iterations,
                 measurement.real_time_ns, measurement.cpu_time_ns, error);
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
