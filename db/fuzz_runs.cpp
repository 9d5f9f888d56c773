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
  auto insert =
      Statement::prepare(connection,
                         "INSERT OR REPLACE INTO fuzz_snapshot (fuzz_run_id, executions, elapsed_ns, "
                         "edges, features, corpus_files, memory_bytes) VALUES (?, ?, ?, ?, ?, ?, ?)",
                         "writing snapshots of a fuzzing run");
  if (!insert) return Unexpected{insert.error()};
  for (const FuzzSnapshot& at : snapshots) {
    const auto done =
        insert
            ->bind(id, at.executions, at.elapsed_ns, at.edges, at.features, at.corpus_files, at.memory_bytes)
            .run();
    if (!done) return done;
  }
  return Done{};
}

Result<Done> insert_counts(sqlite::Connection& connection, std::int64_t id,
                           const std::vector<FuzzCount>& counts) {
  auto insert = Statement::prepare(
      connection, "INSERT INTO fuzz_count (fuzz_run_id, kind, name, count) VALUES (?, ?, ?, ?)",
      "writing counts of a fuzzing run");
  if (!insert) return Unexpected{insert.error()};
  for (const FuzzCount& count : counts) {
    if (auto done = insert->bind(id, count.kind, count.name, count.count).run(); !done) return done;
  }
  return Done{};
}

}  // namespace

Result<std::int64_t> record_fuzz_run(Database& database, const FuzzOrigin& origin, const FuzzRun& run) {
  auto& connection = database.connection();
  auto transaction = sqlite::Transaction::begin(connection);
  if (!transaction) return Unexpected{transaction.error()};
  const auto keys = origin_keys(connection, origin.commit, origin.machine, origin.build);
  if (!keys) return Unexpected{keys.error()};
  auto insert = Statement::prepare(
      connection,
      "INSERT INTO fuzz_run (uuid, campaign, target, mode, started_utc, wall_time_ns, cpu_time_ns, status, "
      "seed, "
      "budget_executions, budget_s, workers, target_hash, commit_id, machine_id, build_id, branch, "
      "executions, "
      "edges, features, corpus_files, corpus_bytes, peak_memory_bytes, slowest_input_s, crashes, timeouts, "
      "ooms, leaks) VALUES (?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?, "
      "?)",
      "writing a fuzzing run");
  if (!insert) return Unexpected{insert.error()};
  insert->bind(run.uuid, run.campaign, run.target, run.mode, run.started_utc, run.wall_time_ns,
               run.cpu_time_ns, run.status, to_bits(run.seed), run.budget_executions, run.budget_s,
               run.workers, run.target_hash, keys->commit, keys->machine, keys->build, origin.branch,
               run.executions, run.edges, run.features, run.corpus_files, run.corpus_bytes,
               run.peak_memory_bytes, run.slowest_input_s, run.crashes, run.timeouts, run.ooms, run.leaks);
  if (auto done = insert->run(); !done) return Unexpected{done.error()};
  const std::int64_t id = connection.last_insert_rowid();
  if (auto done = insert_snapshots(connection, id, run.snapshots); !done) return Unexpected{done.error()};
  if (auto done = insert_counts(connection, id, run.counts); !done) return Unexpected{done.error()};
  if (auto done = transaction->commit(); !done) return Unexpected{done.error()};
  return id;
}

// An engine ends at the first input that seems slow, so a run with one counts if it went on all the same.
Result<bool> is_fuzzed_clean(Database& database, const std::string& target, const std::string& target_hash) {
  auto select = Statement::prepare(database.connection(),
                                   "SELECT 1 FROM fuzz_run WHERE target = ?1 AND target_hash = ?2 "
                                   "AND status = 'clean' AND mode <> 'smoke' "
                                   "AND (timeouts = 0 OR wall_time_ns >= 9e8 * budget_s) "
                                   "AND NOT EXISTS "
                                   "(SELECT 1 FROM fuzz_run WHERE target = ?1 AND target_hash = ?2 "
                                   "AND status = 'findings') LIMIT 1",
                                   "reading fuzzing runs");
  if (!select) return Unexpected{select.error()};
  return select->bind(target, target_hash).step();
}

Result<Done> record_fuzz_coverage(Database& database, const std::string& campaign,
                                  const std::vector<FileCoverage>& files) {
  auto& connection = database.connection();
  auto transaction = sqlite::Transaction::begin(connection);
  if (!transaction) return Unexpected{transaction.error()};
  auto insert = Statement::prepare(
      connection,
      "INSERT OR REPLACE INTO fuzz_coverage (campaign, file, lines, covered_lines) VALUES (?, ?, ?, ?)",
      "writing coverage");
  if (!insert) return Unexpected{insert.error()};
  for (const FileCoverage& file : files) {
    const auto done = insert->bind(campaign, file.file, file.lines, file.covered_lines).run();
    if (!done) return done;
  }
  return transaction->commit();
}

Result<std::string> latest_fuzz_campaign(Database& database) {
  auto select = Statement::prepare(database.connection(),
                                   "SELECT campaign FROM fuzz_run ORDER BY started_utc DESC, id DESC LIMIT 1",
                                   "reading fuzzing runs");
  if (!select) return Unexpected{select.error()};
  const auto row = select->step();
  if (!row) return Unexpected{row.error()};
  if (row.value()) return select->text(0);
  return Unexpected{Error{ErrorKind::kNotFound,
                          database.path().string() + ": no fuzzing run, expected one (`sipplab fuzz run`)"}};
}

Result<Table> list_fuzz_runs(Database& database, const FuzzRunFilter& filter) {
  auto select = Statement::prepare(
      database.connection(),
      "SELECT id, started_utc, target, mode, status, executions, round(executions_per_s, 1), "
      "round(executions_per_cpu_s, 1), edges, "
      "features, "
      "corpus_files, crashes, timeouts, ooms, leaks, round(wall_time_s, 1), (SELECT round(per_input, 3) "
      "FROM v_fuzz_counts WHERE v_fuzz_counts.id = v_fuzz_runs.id AND kind = 'event' AND name = 'two "
      "robots') "
      "FROM v_fuzz_runs WHERE (?1 IS NULL OR target = ?1) AND (?2 IS NULL OR campaign = ?2) "
      "ORDER BY started_utc DESC, id DESC LIMIT ?3",
      "reading fuzzing runs");
  if (!select) return Unexpected{select.error()};
  const std::int64_t no_limit = -1;
  select->bind(filter.target, filter.campaign,
               filter.limit == 0 ? no_limit : static_cast<std::int64_t>(filter.limit));
  Table table{{"id", "started_utc", "target", "mode", "status", "executions", "executions_per_s",
               "executions_per_cpu_s", "edges", "features", "corpus_files", "crashes", "timeouts", "ooms",
               "leaks", "wall_time_s", "valid_share"},
              {}};
  constexpr int kRate = 6;
  constexpr int kCpuRate = 7;
  constexpr int kWallTime = 15;
  for (;;) {
    const auto row = select->step();
    if (!row) return Unexpected{row.error()};
    if (!row.value()) return table;
    std::vector<Value> values{select->integer(0)};
    for (int column = 1; column <= 4; ++column) values.emplace_back(select->text(column));
    for (int column = 5; column < static_cast<int>(table.columns.size()); ++column) {
      values.push_back(
          value_of(*select, column, column == kRate || column == kCpuRate || column >= kWallTime));
    }
    table.rows.push_back(std::move(values));
  }
}

Result<Table> list_fuzz_coverage(Database& database, const std::string& campaign) {
  auto select = Statement::prepare(
      database.connection(),
      "SELECT room, lines, covered_lines, round(share, 4) FROM v_fuzz_coverage WHERE campaign = ?1 "
      "UNION ALL SELECT 'planner', sum(lines), sum(covered_lines), round(1.0 * sum(covered_lines) / "
      "sum(lines), 4) "
      "FROM v_fuzz_coverage WHERE campaign = ?1 HAVING sum(lines) > 0 ORDER BY 1",
      "reading coverage");
  if (!select) return Unexpected{select.error()};
  select->bind(campaign);
  Table table{{"room", "lines", "covered_lines", "share"}, {}};
  for (;;) {
    const auto row = select->step();
    if (!row) return Unexpected{row.error()};
    if (!row.value()) return table;
    table.rows.push_back(
        {select->text(0), select->integer(1), select->integer(2), value_of(*select, 3, true)});
  }
}

}  // namespace sipplab::db
