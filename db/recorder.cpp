// One run, one transaction per case.
#include "db/recorder.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <optional>

#include "db/identity.hpp"
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

Result<std::optional<ResumableRun>> find_resumable_run(Database& database, const RunInfo& info) {
  auto select = SIPPLAB_TRY(Statement::prepare(
      database.connection(),
      "SELECT run.uuid, run.started_utc, run.status, run.writer, "
      "  (SELECT count(*) FROM cell WHERE cell.run_id = run.id) "
      "FROM run JOIN machine ON machine.id = run.machine_id JOIN build ON build.id = run.build_id "
      "WHERE run.kind = 'sweep' AND run.suite = ? AND run.options = ? "
      "  AND run.status <> 'finished' AND run.excluded_reason IS NULL "
      "  AND run.origin = '' AND machine.fingerprint = ? "
      "  AND build.binary_hash = ? AND build.compiler = ? AND build.compiler_version = ? AND build.flags = ? "
      "  AND build.build_type = ? AND build.assertions = ? AND build.sanitizers = ? AND build.dirty = ? "
      "ORDER BY run.started_utc DESC, run.id DESC",
      "looking for a run to resume"));
  const BuildInfo& build = info.build;
  select.bind(info.suite, info.options, fingerprint(info.machine), build.binary_hash, build.compiler,
              build.compiler_version, build.flags, build.build_type, build.assertions, build.sanitizers,
              build.dirty);
  for (;;) {
    const auto row = SIPPLAB_TRY(select.step());
    if (!row) return std::optional<ResumableRun>{};
    const bool running = select.text(2) == name(RunStatus::kRunning);
    if (running && is_alive(select.text(3))) continue;
    ResumableRun run;
    run.uuid = select.text(0);
    run.started_utc = select.text(1);
    run.status = running ? RunStatus::kRunning : RunStatus::kAborted;
    run.finished_cases = static_cast<std::size_t>(select.integer(4));
    return std::optional<ResumableRun>{run};
  }
}

Result<std::vector<CaseInfo>> finished_cases(Database& database, const std::string& run_uuid) {
  return SIPPLAB_TRY(Statement::prepare(database.connection(),
                                        "SELECT case_.* FROM run JOIN cell ON cell.run_id = run.id "
                                        "JOIN case_ ON case_.id = cell.case_id "
                                        "WHERE run.uuid = ? ORDER BY cell.id",
                                        "reading finished cases", run_uuid))
      .collect([](const Statement& row) { return read_case(row, 0); });
}

RunRecorder::RunRecorder(Database database, std::string run_uuid, std::int64_t run_id)
    : database_(std::move(database)), run_uuid_(std::move(run_uuid)), run_id_(run_id) {}

Result<RunRecorder> RunRecorder::begin(Database database, const RunInfo& info) {
  auto transaction = SIPPLAB_TRY(Transaction::begin(database.connection()));
  RunRow run;
  run.uuid = new_uuid();
  run.kind = "sweep";
  run.suite = info.suite;
  run.started_utc = utc_now();
  run.seed = info.seed;
  run.time_limit_s = info.time_limit_s;
  run.shard = info.shard;
  run.command_line = info.command_line;
  run.options = info.options;
  run.writer = this_process();
  const auto id = SIPPLAB_TRY(insert_run(database.connection(), info, run));
  SIPPLAB_TRY(transaction.commit());
  return RunRecorder{std::move(database), run.uuid, *id};
}

Result<RunRecorder> RunRecorder::resume(Database database, const std::string& run_uuid) {
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
    const std::string status = select.text(1);
    const std::string writer = select.text(2);
    if (status == name(RunStatus::kFinished) || !select.is_null(3)) {
      return Unexpected{
          bad_input(database, fmt::format("run {} is {}, expected one that ended early", run_uuid,
                                          select.is_null(3) ? "finished" : "excluded"))};
    }
    if (status == name(RunStatus::kRunning) && writer != this_process() && is_alive(writer)) {
      return Unexpected{bad_input(
          database, fmt::format("run {} is being written, expected its process to have ended", run_uuid))};
    }
    id = select.integer(0);
  }
  SIPPLAB_TRY(sqlite::run(database.connection(),
                          "UPDATE run SET status = 'running', ended_utc = NULL, writer = ? WHERE id = ?",
                          "taking up the run", this_process(), id));
  auto finished = SIPPLAB_TRY(finished_cases(database, run_uuid));
  SIPPLAB_TRY(transaction.commit());

  RunRecorder recorder{std::move(database), run_uuid, id};
  recorder.finished_ = std::move(finished);
  return recorder;
}

bool RunRecorder::is_finished(const CaseInfo& parameters) const {
  return std::find(finished_.begin(), finished_.end(), parameters) != finished_.end();
}

void RunRecorder::add(const CaseInfo& parameters, const InstanceInfo& instance, const ResultRow& row) {
  auto found = std::find_if(buffered_.begin(), buffered_.end(),
                            [&](const BufferedCase& buffered) { return buffered.first == parameters; });
  if (found == buffered_.end()) found = buffered_.insert(found, BufferedCase{parameters, {}});
  found->second.push_back({instance, row});
}

void RunRecorder::discard_case(const CaseInfo& parameters) {
  std::erase_if(buffered_, [&](const BufferedCase& buffered) { return buffered.first == parameters; });
}

Result<Done> RunRecorder::commit_case(const CaseInfo& parameters) {
  const auto found = std::find_if(buffered_.begin(), buffered_.end(),
                                  [&](const BufferedCase& buffered) { return buffered.first == parameters; });
  const std::vector<BufferedResult> none;
  SIPPLAB_TRY(write_case(parameters, found == buffered_.end() ? none : found->second));
  discard_case(parameters);
  finished_.push_back(parameters);
  return Done{};
}

Result<Done> RunRecorder::write_case(const CaseInfo& parameters, const std::vector<BufferedResult>& results) {
  if (is_finished(parameters)) {
    return Unexpected{bad_input(database_, fmt::format("run {} holds this case already", run_uuid_))};
  }
  const auto is_nan = [](const auto& option) {
    const double* real = std::get_if<double>(&option.second);
    return real != nullptr && std::isnan(*real);
  };
  if (std::any_of(parameters.options.begin(), parameters.options.end(), is_nan) ||
      std::any_of(results.begin(), results.end(), [](const auto& result) { return has_nan(result.row); })) {
    return Unexpected{bad_input(database_, "NaN in a result, expected a number")};
  }
  auto& connection = database_.connection();
  auto transaction = SIPPLAB_TRY(Transaction::begin(connection));
  SIPPLAB_TRY(check_writer());
  const auto case_key = SIPPLAB_TRY(case_id(connection, parameters));
  SIPPLAB_TRY(sqlite::run(
      connection,
      "INSERT INTO cell (run_id, case_id, finished_utc, result_count, machine_load) VALUES (?, ?, ?, ?, ?)",
      "writing a finished case", run_id_, case_key, utc_now(), static_cast<std::int64_t>(results.size()),
      machine_load()));
  const std::int64_t cell_id = connection.last_insert_rowid();
  SIPPLAB_TRY(write_results(cell_id, results));
  SIPPLAB_TRY(write_bounds(case_key, results));
  auto summariser = SIPPLAB_TRY(CellSummariser::prepare(connection));
  std::vector<const ResultRow*> rows;
  for (const BufferedResult& result : results) rows.push_back(&result.row);
  SIPPLAB_TRY(summariser.summarise(cell_id, medians_of(rows)));
  return transaction.commit();
}

Result<Done> RunRecorder::write_results(std::int64_t cell_id, const std::vector<BufferedResult>& results) {
  auto insert = SIPPLAB_TRY(Statement::prepare(
      database_.connection(),
      "INSERT INTO result (cell_id, instance_id, position, repetition, status, planning_time_ns, makespan_s, "
      "flowtime_s, tries, expansions, generations, plan_hash, valid, violations, min_clearance_cells, "
      "peak_memory_bytes, "
      "limit_struck, message, made_by, ssi_kept_s, instructions, cpu_time_ns) "
      "VALUES (?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?)",
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
                          row.ssi_kept_s, row.instructions, row.cpu_time_ns)
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
  std::string last;  // repetitions follow each other
  for (const auto& [instance, row] : results) {
    if (!row.flowtime_bound_s || !row.makespan_bound_s || instance.content_hash == last) continue;
    last = instance.content_hash;
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

Result<Done> RunRecorder::finish(RunStatus status) {
  if (status == RunStatus::kRunning) {
    return Unexpected{bad_input(database_, "a run cannot end as running, expected finished or aborted")};
  }
  auto transaction = SIPPLAB_TRY(Transaction::begin(database_.connection()));
  SIPPLAB_TRY(check_writer());
  SIPPLAB_TRY(sqlite::run(database_.connection(), "UPDATE run SET status = ?, ended_utc = ? WHERE id = ?",
                          "closing the run", std::string{name(status)}, utc_now(), run_id_));
  buffered_.clear();
  return transaction.commit();
}

}  // namespace sipplab::db
