// One run, transaction by transaction.
#include "db/recorder.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <optional>
#include <string_view>
#include <tuple>
#include <utility>

#include "db/identity.hpp"
#include "db/queries.hpp"
#include "db/rows.hpp"
#include "db/sqlite/statement.hpp"
#include "db/sqlite/transaction.hpp"
#include "db/summaries.hpp"

namespace sipplab::db {
namespace {

using sqlite::Statement;
using sqlite::Transaction;

Error bad_input(const Database& database, std::string what) {
  return {ErrorKind::kBadInput, fmt::format("{}: {}", database.path().string(), what)};
}

// SQLite would store a NaN as NULL without a word.
bool has_nan(const ResultRow& row) {
  const auto is_nan = [](const std::optional<double>& value) { return value && std::isnan(*value); };
  return is_nan(row.makespan_s) || is_nan(row.flowtime_s) || is_nan(row.min_clearance_cells) ||
         is_nan(row.ssi_kept_s) || is_nan(row.flowtime_bound_s) || is_nan(row.makespan_bound_s);
}

}  // namespace

Result<std::optional<std::string>> find_other_command(Database& database, const std::string& planner,
                                                      const std::string& digest) {
  auto select = Statement::prepare(
      database.connection(),
      "SELECT uuid FROM run WHERE kind = 'sweep' AND excluded_reason IS NULL "
      "  AND options LIKE '% planner=%' AND instr(options, ' planner=' || ?2 || ' ') = 0 "
      "  AND EXISTS (SELECT 1 FROM cell JOIN case_ ON case_.id = cell.case_id "
      "              WHERE cell.run_id = run.id "
      "                AND (case_.planner = ?1 OR (substr(case_.planner, 1, length(?1) + 1) = ?1 || ' ' "
      "                     AND substr(case_.planner, length(?1) + 2) GLOB '[a-z]*:*'))) "
      "ORDER BY started_utc DESC, id DESC LIMIT 1",
      "looking for runs of another command");
  if (!select) return Unexpected{select.error()};
  const auto row = select->bind(planner, digest).step();
  if (!row) return Unexpected{row.error()};
  if (!row.value()) return std::optional<std::string>{};
  return std::optional<std::string>{select->text(0)};
}

Result<std::optional<EarlierRun>> find_earlier_run(Database& database, const RunInfo& info,
                                                   const std::optional<std::string>& run) {
  std::optional<std::string> uuid;
  if (run) {
    uuid = SIPPLAB_TRY(resolve_run(database, *run));
  } else if (!info.uuid.empty()) {
    uuid = info.uuid;
  }
  auto select = SIPPLAB_TRY(Statement::prepare(
      database.connection(),
      "SELECT run.uuid, run.started_utc, run.status, run.writer, "
      "  (SELECT ifnull(sum(result_count), 0) FROM cell WHERE cell.run_id = run.id), "
      "  EXISTS (SELECT 1 FROM attempt WHERE run_id = run.id AND attempt.shard = ?) "
      "FROM run JOIN build ON build.id = run.build_id "
      "WHERE run.kind = 'sweep' AND run.suite = ? AND run.options = ? AND (run.uuid = ? OR ? IS NULL "
      "  AND run.excluded_reason IS NULL AND run.origin = '') "
      "  AND build.binary_hash = ? AND build.compiler = ? AND build.compiler_version = ? AND build.flags = ? "
      "  AND build.build_type = ? AND build.assertions = ? AND build.sanitizers = ? AND build.dirty = ? "
      "ORDER BY run.status = 'finished', run.started_utc DESC, run.id DESC LIMIT 1",
      "looking for a run to resume"));
  const BuildInfo& build = info.build;
  select.bind(info.shard, info.suite, info.options, uuid, uuid, build.binary_hash, build.compiler,
              build.compiler_version, build.flags, build.build_type, build.assertions, build.sanitizers,
              build.dirty);
  const auto row = SIPPLAB_TRY(select.step());
  if (!row && run) {
    return Unexpected{bad_input(
        database, fmt::format("run {} is not of this sweep and build, expected the command and the program "
                              "that began it",
                              *uuid))};
  }
  if (!row) return std::optional<EarlierRun>{};
  EarlierRun earlier;
  earlier.uuid = select.text(0);
  earlier.started_utc = select.text(1);
  for (const RunStatus status : {RunStatus::kRunning, RunStatus::kFinished, RunStatus::kAborted}) {
    if (select.text(2) == name(status)) earlier.status = status;
  }
  const std::string writer = select.text(3);
  earlier.being_written =
      earlier.status == RunStatus::kRunning && writer != this_process() && is_alive(writer);
  earlier.results = select.integer(4);
  earlier.has_shard = select.integer(5) != 0;
  return std::optional<EarlierRun>{earlier};
}

Error run_is_there(const Database& database, const std::string& uuid) {
  return bad_input(database,
                   fmt::format("run {} of this sweep is there, expected --resume to go on with it, or "
                               "--sweep with a name for a repetition",
                               uuid));
}

Result<std::vector<RecordedCase>> recorded_cases(Database& database, const std::string& run_uuid) {
  auto results = SIPPLAB_TRY(
      Statement::prepare(database.connection(),
                         "SELECT position, repetition, status, planning_time_ns, makespan_s, flowtime_s, "
                         "tries, expansions FROM result WHERE cell_id = ?",
                         "reading recorded results"));
  auto cells = SIPPLAB_TRY(Statement::prepare(database.connection(),
                                              "SELECT cell.id, case_.* FROM run "
                                              "JOIN cell ON cell.run_id = run.id "
                                              "JOIN case_ ON case_.id = cell.case_id "
                                              "WHERE run.uuid = ? ORDER BY cell.id",
                                              "reading recorded cases", run_uuid));
  std::vector<RecordedCase> recorded;
  Result<Done> read = Done{};
  SIPPLAB_TRY(cells.for_each([&] {
    RecordedCase& one = recorded.emplace_back(RecordedCase{read_case(cells, 1), {}});
    results.reset();
    const auto done = results.bind(cells.integer(0)).for_each([&] {
      ResultRow& row = one.rows.emplace_back();
      row.position = results.integer(0);
      row.repetition = results.integer(1);
      row.status = static_cast<ResultStatus>(results.integer(2));
      row.planning_time_ns = results.integer(3);
      if (!results.is_null(4)) row.makespan_s = results.real(4);
      if (!results.is_null(5)) row.flowtime_s = results.real(5);
      row.tries = static_cast<std::uint64_t>(results.integer(6));
      row.expansions = static_cast<std::uint64_t>(results.integer(7));
    });
    if (read && !done) read = done;
  }));
  SIPPLAB_TRY(read);
  return recorded;
}

RunRecorder::RunRecorder(Database database, std::string run_uuid, std::int64_t run_id,
                         std::int64_t attempt_id)
    : database_(std::move(database)),
      run_uuid_(std::move(run_uuid)),
      run_id_(run_id),
      attempt_id_(attempt_id) {}

Result<std::int64_t> RunRecorder::insert_attempt(sqlite::Connection& connection, std::int64_t run_id,
                                                 const RunInfo& info) {
  const auto machine = SIPPLAB_TRY(machine_id(connection, info.machine));
  const AttemptInfo& attempt = info.attempt;
  // What a killed attempt ended with is what it said last.
  SIPPLAB_TRY(sqlite::run(connection,
                          "UPDATE attempt SET status = 'aborted' WHERE run_id = ? AND status = 'running'",
                          "closing attempts that were killed", run_id));
  SIPPLAB_TRY(sqlite::run(
      connection,
      "INSERT INTO attempt (uuid, run_id, machine_id, shard, started_utc, ended_utc, status, scheduler, job, "
      "task, restarts, queued_s, cores, memory_limit_bytes, cpu_time_ns, peak_memory_bytes) "
      "VALUES (?1, ?2, ?3, ?4, ?5, ?5, 'running', ?6, ?7, ?8, ?9, ?10, ?11, ?12, 0, 0)",
      "beginning an attempt", new_uuid(), run_id, machine, info.shard, utc_now(), attempt.scheduler,
      attempt.job, attempt.task, attempt.restarts, attempt.queued_s, attempt.cores,
      attempt.memory_limit_bytes));
  const std::int64_t id = connection.last_insert_rowid();
  SIPPLAB_TRY(settle_sweep(connection, run_id));
  return id;
}

Result<RunRecorder> RunRecorder::begin(Database database, const RunInfo& info) {
  auto transaction = SIPPLAB_TRY(Transaction::begin(database.connection()));
  RunRow run;
  run.uuid = info.uuid.empty() ? new_uuid() : info.uuid;
  run.kind = "sweep";
  run.suite = info.suite;
  run.started_utc = utc_now();
  run.seed = info.seed;
  run.time_limit_s = info.time_limit_s;
  run.shard = info.shard;
  run.command_line = info.command_line;
  run.options = info.options;
  run.writer = this_process();
  run.planned = info.planned;
  const auto id = SIPPLAB_TRY(insert_run(database.connection(), info, run));
  if (!id) return Unexpected{run_is_there(database, run.uuid)};
  const auto attempt = SIPPLAB_TRY(insert_attempt(database.connection(), *id, info));
  SIPPLAB_TRY(transaction.commit());
  return RunRecorder{std::move(database), run.uuid, *id, attempt};
}

Result<RunRecorder> RunRecorder::resume(Database database, const std::string& run_uuid, const RunInfo& info) {
  auto transaction = SIPPLAB_TRY(Transaction::begin(database.connection()));
  std::int64_t id = 0;
  {
    auto select = SIPPLAB_TRY(Statement::prepare(
        database.connection(), "SELECT id, status, writer, excluded_reason FROM run WHERE uuid = ?",
        "reading the run to resume", run_uuid));
    const auto row = SIPPLAB_TRY(select.step());
    if (!row) {
      return Unexpected{Error{ErrorKind::kNotFound, fmt::format("{}: no run {}, expected one to resume",
                                                                database.path().string(), run_uuid)}};
    }
    const std::string writer = select.text(2);
    if (!select.is_null(3)) {
      return Unexpected{
          bad_input(database, fmt::format("run {} is excluded, expected one that counts", run_uuid))};
    }
    if (select.text(1) == name(RunStatus::kRunning) && writer != this_process() && is_alive(writer)) {
      return Unexpected{bad_input(
          database, fmt::format("run {} is being written, expected its process to have ended", run_uuid))};
    }
    id = select.integer(0);
  }
  SIPPLAB_TRY(
      sqlite::run(database.connection(),
                  "UPDATE run SET status = 'running', ended_utc = NULL, origin = '', writer = ? WHERE id = ?",
                  "taking up the run", this_process(), id));
  const auto attempt = SIPPLAB_TRY(insert_attempt(database.connection(), id, info));
  SIPPLAB_TRY(transaction.commit());
  return RunRecorder{std::move(database), run_uuid, id, attempt};
}

void RunRecorder::add(const CaseInfo& parameters, const InstanceInfo& instance, const ResultRow& row) {
  auto found = std::find_if(buffered_.begin(), buffered_.end(),
                            [&](const BufferedCase& buffered) { return buffered.first == parameters; });
  if (found == buffered_.end()) found = buffered_.insert(found, BufferedCase{parameters, {}});
  found->second.push_back({instance, row});
}

Result<Done> RunRecorder::commit(const AttemptUsage& usage) {
  auto transaction = SIPPLAB_TRY(Transaction::begin(database_.connection()));
  SIPPLAB_TRY(check_writer());
  for (const auto& [parameters, results] : buffered_) SIPPLAB_TRY(write_case(parameters, results));
  SIPPLAB_TRY(write_attempt(RunStatus::kRunning, usage));
  SIPPLAB_TRY(transaction.commit());
  discard();
  return Done{};
}

Result<Done> RunRecorder::write_case(const CaseInfo& parameters, const std::vector<BufferedResult>& results) {
  const auto is_nan = [](const auto& option) {
    const double* real = std::get_if<double>(&option.second);
    return real != nullptr && std::isnan(*real);
  };
  if (std::any_of(parameters.options.begin(), parameters.options.end(), is_nan) ||
      std::any_of(results.begin(), results.end(), [](const auto& result) { return has_nan(result.row); })) {
    return Unexpected{bad_input(database_, "NaN in a result, expected a number")};
  }
  auto& connection = database_.connection();
  const auto case_key = SIPPLAB_TRY(case_id(connection, parameters));
  auto upsert = SIPPLAB_TRY(Statement::prepare(
      connection,
      "INSERT INTO cell (run_id, case_id, finished_utc, result_count, machine_load) VALUES (?, ?, ?, ?, ?) "
      "ON CONFLICT (run_id, case_id) DO UPDATE SET finished_utc = excluded.finished_utc, "
      "result_count = result_count + excluded.result_count, machine_load = excluded.machine_load RETURNING "
      "id",
      "writing a case", run_id_, case_key, utc_now(), static_cast<std::int64_t>(results.size()),
      machine_load()));
  SIPPLAB_TRY(upsert.step());
  const std::int64_t cell_id = upsert.integer(0);
  SIPPLAB_TRY(upsert.run());
  SIPPLAB_TRY(write_results(cell_id, results));
  SIPPLAB_TRY(write_bounds(case_key, results));
  auto summariser = SIPPLAB_TRY(CellSummariser::prepare(connection));
  return summariser.summarise(cell_id);
}

Result<Done> RunRecorder::write_results(std::int64_t cell_id, const std::vector<BufferedResult>& results) {
  auto insert = SIPPLAB_TRY(Statement::prepare(
      database_.connection(),
      "INSERT INTO result (cell_id, instance_id, position, repetition, status, planning_time_ns, makespan_s, "
      "flowtime_s, tries, expansions, generations, plan_hash, valid, violations, min_clearance_cells, "
      "peak_memory_bytes, "
      "limit_struck, message, made_by, ssi_kept_s, instructions, cpu_time_ns, attempt_id) "
      "VALUES (?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?)",
      "writing the results of a case"));
  auto keys = SIPPLAB_TRY(InstanceKeys::prepare(database_.connection()));
  for (const auto& [instance, row] : results) {
    const auto instance_key = SIPPLAB_TRY(keys.key(instance));
    std::optional<std::int64_t> plan_hash;
    if (row.plan_hash) plan_hash = to_bits(*row.plan_hash);
    SIPPLAB_TRY(insert
                    .bind(cell_id, instance_key, row.position, row.repetition, static_cast<int>(row.status),
                          row.planning_time_ns, row.makespan_s, row.flowtime_s, to_count(row.tries),
                          to_count(row.expansions), to_count(row.generations), plan_hash, row.valid,
                          row.violations, row.min_clearance_cells, row.peak_memory_bytes,
                          null_if_empty(row.limit), null_if_empty(row.message), null_if_empty(row.made_by),
                          row.ssi_kept_s, row.instructions, row.cpu_time_ns, attempt_id_)
                    .run());
    if (row.retiming) SIPPLAB_TRY(write_retiming(cell_id, instance_key, row));
    if (!row.reported.empty()) SIPPLAB_TRY(write_reported(cell_id, instance_key, row));
    if (row.progress.empty()) continue;
    SIPPLAB_TRY(write_progress(cell_id, instance_key, row));
  }
  return Done{};
}

Result<Done> RunRecorder::write_retiming(std::int64_t cell_id, std::int64_t instance_id,
                                         const ResultRow& row) {
  const RetimingRow& retiming = *row.retiming;
  return sqlite::run(
      database_.connection(),
      "INSERT INTO retiming (cell_id, instance_id, position, repetition, executable, given_valid, "
      "given_violations, given_makespan_s, given_flowtime_s, retime_ns, unit_step_cost) "
      "VALUES (?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?)",
      "writing a plan as it was given", cell_id, instance_id, row.position, row.repetition,
      retiming.executable, retiming.given_valid, retiming.given_violations, retiming.given_makespan_s,
      retiming.given_flowtime_s, retiming.retime_ns, retiming.unit_step_cost);
}

Result<Done> RunRecorder::write_reported(std::int64_t cell_id, std::int64_t instance_id,
                                         const ResultRow& row) {
  for (const auto& [name, value] : row.reported) {
    SIPPLAB_TRY(sqlite::run(database_.connection(),
                            "INSERT INTO reported (cell_id, instance_id, position, repetition, name, value) "
                            "VALUES (?, ?, ?, ?, ?, ?)",
                            "writing what a program says of its run", cell_id, instance_id, row.position,
                            row.repetition, name, value));
  }
  return Done{};
}

Result<Done> RunRecorder::write_bounds(std::int64_t case_id, const std::vector<BufferedResult>& results) {
  // Work on a bound is limited: a later one may be greater, and is as true.
  auto insert = SIPPLAB_TRY(Statement::prepare(
      database_.connection(),
      "INSERT INTO instance_bound (instance_id, any_angle, connectedness, flowtime_bound_s, "
      "makespan_bound_s) "
      "SELECT instance.id, any_angle, iif(any_angle, 0, connectedness), ?3, ?4 FROM case_, instance "
      "WHERE case_.id = ?1 AND content_hash = ?2 "
      "ON CONFLICT DO UPDATE SET flowtime_bound_s = max(flowtime_bound_s, excluded.flowtime_bound_s), "
      "makespan_bound_s = max(makespan_bound_s, excluded.makespan_bound_s)",
      "writing lower bounds"));
  using Bound = std::tuple<std::string_view, double, double>;
  Bound last;  // repetitions follow each other, mostly with the same bounds
  for (const auto& [instance, row] : results) {
    if (!row.flowtime_bound_s || !row.makespan_bound_s) continue;
    const Bound bound{instance.content_hash, *row.flowtime_bound_s, *row.makespan_bound_s};
    if (std::exchange(last, bound) == bound) continue;
    SIPPLAB_TRY(
        insert.bind(case_id, instance.content_hash, row.flowtime_bound_s, row.makespan_bound_s).run());
  }
  return Done{};
}

Result<Done> RunRecorder::write_progress(std::int64_t cell_id, std::int64_t instance_id,
                                         const ResultRow& row) {
  auto insert = SIPPLAB_TRY(Statement::prepare(
      database_.connection(),
      "INSERT INTO progress (cell_id, instance_id, position, repetition, step, iteration, elapsed_ns, "
      "flowtime_s, makespan_s, flowtime_bound_s, makespan_bound_s) VALUES (?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?)",
      "writing how a plan got better"));
  std::int64_t step = 0;
  for (const ProgressRow& point : row.progress) {
    SIPPLAB_TRY(insert
                    .bind(cell_id, instance_id, row.position, row.repetition, step++, point.iteration,
                          point.elapsed_ns, point.flowtime_s, point.makespan_s, point.flowtime_bound_s,
                          point.makespan_bound_s)
                    .run());
  }
  return Done{};
}

Result<Done> RunRecorder::check_writer() {
  auto select = SIPPLAB_TRY(Statement::prepare(database_.connection(),
                                               "SELECT writer FROM run WHERE id = ? AND uuid = ?",
                                               "checking that the run is still ours", run_id_, run_uuid_));
  const auto row = SIPPLAB_TRY(select.step());
  if (!row || select.text(0) != this_process()) {
    return Unexpected{bad_input(
        database_,
        fmt::format("run {} was taken over by another process, expected to be its writer", run_uuid_))};
  }
  return Done{};
}

Result<Done> RunRecorder::write_attempt(RunStatus status, const AttemptUsage& usage) {
  return sqlite::run(database_.connection(),
                     "UPDATE attempt SET status = ?, ended_utc = ?, cpu_time_ns = ?, peak_memory_bytes = ? "
                     "WHERE id = ?",
                     "writing what an attempt took", std::string{name(status)}, utc_now(), usage.cpu_time_ns,
                     usage.peak_memory_bytes, attempt_id_);
}

Result<Done> RunRecorder::finish(RunStatus status, const AttemptUsage& usage) {
  if (status == RunStatus::kRunning) {
    return Unexpected{bad_input(database_, "a run cannot end as running, expected finished or aborted")};
  }
  auto transaction = SIPPLAB_TRY(Transaction::begin(database_.connection()));
  SIPPLAB_TRY(check_writer());
  SIPPLAB_TRY(write_attempt(status, usage));
  SIPPLAB_TRY(sqlite::run(database_.connection(), "UPDATE run SET status = ?, ended_utc = ? WHERE id = ?",
                          "closing the run", std::string{name(status)}, utc_now(), run_id_));
  SIPPLAB_TRY(settle_sweep(database_.connection(), run_id_));
  buffered_.clear();
  return transaction.commit();
}

}  // namespace sipplab::db
