// Fuzzing runs: written whole, read from their views.
#include "db/fuzz_runs.hpp"

#include "db/rows.hpp"
#include "db/sqlite/statement.hpp"
#include "db/sqlite/transaction.hpp"

namespace sipplab::db {
namespace {

using sqlite::Statement;

Result<Done> insert_snapshots(sqlite::Connection& connection, std::int64_t id,
                              const std::vector<FuzzSnapshot>& snapshots) {
  for (const FuzzSnapshot& at : snapshots) {
    SIPPLAB_TRY(sqlite::run(connection,
                            "INSERT OR REPLACE INTO fuzz_snapshot (fuzz_run_id, executions, elapsed_ns, "
                            "edges, features, corpus_files, memory_bytes) VALUES (?, ?, ?, ?, ?, ?, ?)",
                            "writing snapshots of a fuzzing run", id, at.executions, at.elapsed_ns, at.edges,
                            at.features, at.corpus_files, at.memory_bytes));
  }
  return Done{};
}

Result<Done> insert_counts(sqlite::Connection& connection, std::int64_t id,
                           const std::vector<FuzzCount>& counts) {
  for (const FuzzCount& count : counts) {
    SIPPLAB_TRY(sqlite::run(connection,
                            "INSERT INTO fuzz_count (fuzz_run_id, kind, name, count) VALUES (?, ?, ?, ?)",
                            "writing counts of a fuzzing run", id, count.kind, count.name, count.count));
  }
  return Done{};
}

}  // namespace

Result<std::int64_t> record_fuzz_run(Database& database, const RunOrigin& origin, const FuzzRun& run) {
  auto& connection = database.connection();
  auto transaction = SIPPLAB_TRY(sqlite::Transaction::begin(connection));
  const auto run_id =
      SIPPLAB_TRY(insert_run(connection, origin, finished_run("fuzz", run.target, run.status, run)));
  const auto id = insert_row(connection, "fuzz_run", "writing a fuzzing run", [&](auto visit) {
    visit("run_id", run_id);
    visit("campaign", run.campaign);
    visit("mode", run.mode);
    visit("wall_time_ns", run.wall_time_ns);
    visit("cpu_time_ns", run.cpu_time_ns);
    visit("budget_executions", run.budget_executions);
    visit("budget_s", run.budget_s);
    visit("workers", run.workers);
    visit("target_hash", run.target_hash);
    visit("executions", run.executions);
    visit("edges", run.edges);
    visit("features", run.features);
    visit("corpus_files", run.corpus_files);
    visit("corpus_bytes", run.corpus_bytes);
    visit("peak_memory_bytes", run.peak_memory_bytes);
    visit("slowest_input_s", run.slowest_input_s);
    visit("crashes", run.crashes);
    visit("timeouts", run.timeouts);
    visit("ooms", run.ooms);
    visit("leaks", run.leaks);
  });
  if (!id) return id;
  SIPPLAB_TRY(insert_snapshots(connection, *id, run.snapshots));
  SIPPLAB_TRY(insert_counts(connection, *id, run.counts));
  SIPPLAB_TRY(transaction.commit());
  return id;
}

// An engine stops at the first input that seems slow: a run with one counts only if it used its budget.
Result<bool> is_fuzzed_clean(Database& database, const std::string& target, const std::string& target_hash) {
  return SIPPLAB_TRY(Statement::prepare(
                         database.connection(),
                         "WITH here AS (SELECT * FROM v_fuzz_runs WHERE target = ? AND target_hash = ? "
                         "AND excluded_reason IS NULL) "
                         "SELECT 1 FROM here WHERE status = 'clean' AND mode <> 'smoke' "
                         "AND (timeouts = 0 OR wall_time_s >= 0.9 * budget_s) "
                         "AND NOT EXISTS (SELECT 1 FROM here WHERE status = 'findings') LIMIT 1",
                         "reading fuzzing runs", target, target_hash))
      .step();
}

Result<Done> record_fuzz_coverage(Database& database, const std::string& campaign,
                                  const std::vector<FileCoverage>& files) {
  auto& connection = database.connection();
  auto transaction = SIPPLAB_TRY(sqlite::Transaction::begin(connection));
  for (const FileCoverage& file : files) {
    SIPPLAB_TRY(sqlite::run(
        connection,
        "INSERT OR REPLACE INTO fuzz_coverage (campaign, file, lines, covered_lines) VALUES (?, ?, ?, ?)",
        "writing coverage", campaign, file.file, file.lines, file.covered_lines));
  }
  return transaction.commit();
}

Result<std::string> latest_fuzz_campaign(Database& database) {
  auto select = SIPPLAB_TRY(Statement::prepare(database.connection(),
                                               "SELECT campaign FROM v_fuzz_runs WHERE excluded_reason IS "
                                               "NULL ORDER BY started_utc DESC, id DESC LIMIT 1",
                                               "reading fuzzing runs"));
  const auto row = SIPPLAB_TRY(select.step());
  if (row) return select.text(0);
  return Unexpected{Error{ErrorKind::kNotFound,
                          database.path().string() + ": no fuzzing run, expected one (`sipplab fuzz run`)"}};
}

Result<Table> list_fuzz_runs(Database& database, const FuzzRunFilter& filter) {
  return rest_of(SIPPLAB_TRY(Statement::prepare(
      database.connection(),
      "SELECT id, started_utc, target, mode, status, executions, round(executions_per_s, 1) AS "
      "executions_per_s, "
      "round(executions_per_cpu_s, 1) AS executions_per_cpu_s, edges, features, corpus_files, crashes, "
      "timeouts, "
      "ooms, leaks, round(wall_time_s, 1) AS wall_time_s, (SELECT round(per_input, 3) FROM v_fuzz_counts "
      "WHERE v_fuzz_counts.id = v_fuzz_runs.id AND kind = 'event' AND name = 'two robots') AS valid_share "
      "FROM v_fuzz_runs WHERE excluded_reason IS NULL AND (?1 IS NULL OR target = ?1) "
      "AND (?2 IS NULL OR campaign = ?2) "
      "ORDER BY started_utc DESC, id DESC LIMIT ?3",
      "reading fuzzing runs", filter.target, filter.campaign, sql_limit(filter.limit))));
}

Result<Table> list_fuzz_coverage(Database& database, const std::string& campaign) {
  return rest_of(SIPPLAB_TRY(Statement::prepare(
      database.connection(),
      "SELECT room, lines, covered_lines, round(share, 4) AS share FROM v_fuzz_coverage WHERE campaign = ?1 "
      "UNION ALL SELECT 'planner', sum(lines), sum(covered_lines), round(1.0 * sum(covered_lines) / "
      "sum(lines), 4) "
      "FROM v_fuzz_coverage WHERE campaign = ?1 HAVING sum(lines) > 0 ORDER BY 1",
      "reading coverage", campaign)));
}

}  // namespace sipplab::db
