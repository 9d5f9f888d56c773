// Property runs: written whole, read from their views.
#include "db/property_runs.hpp"

#include <fmt/core.h>

#include "db/rows.hpp"
#include "db/sqlite/statement.hpp"
#include "db/sqlite/transaction.hpp"

namespace sipplab::db {
namespace {

using sqlite::Statement;

constexpr std::string_view kReadingProperties = "reading property runs";

}  // namespace

Result<PropertyRecorded> record_property_runs(Database& database, const PropertyOrigin& origin,
                                              const std::vector<PropertyRun>& runs) {
  auto& connection = database.connection();
  auto transaction = sqlite::Transaction::begin(connection);
  if (!transaction) return Unexpected{transaction.error()};
  const auto keys = origin_keys(connection, origin.commit, origin.machine, origin.build);
  if (!keys) return Unexpected{keys.error()};
  auto insert_run = Statement::prepare(
      connection,
      "INSERT INTO property_run (uuid, started_utc, room, title, mutant, commit_id, machine_id, build_id, "
      "branch, seed, max_success, status, cases, discards, shrinks, shrink_tries, wall_time_ns, message, "
      "reproduce, counterexample, plan_case, case_robots, case_cells) "
      "VALUES (?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?) "
      "ON CONFLICT (uuid) DO NOTHING",
      "writing a property run");
  if (!insert_run) return Unexpected{insert_run.error()};
  auto insert_class = Statement::prepare(
      connection, "INSERT INTO property_class (property_run_id, class, cases) VALUES (?, ?, ?)",
      "writing the classes of a property run");
  if (!insert_class) return Unexpected{insert_class.error()};

  // A log that is recorded while a property runs holds its beginning alone.
  auto forget_crash = Statement::prepare(
      connection, "DELETE FROM property_run WHERE uuid = ?1 AND status = 'crashed' AND ?2 <> 'crashed'",
      "replacing a property run");
  if (!forget_crash) return Unexpected{forget_crash.error()};

  PropertyRecorded recorded;
  for (const PropertyRun& run : runs) {
    if (auto done = forget_crash->bind(run.uuid, run.status).run(); !done) return Unexpected{done.error()};
    insert_run->bind(run.uuid, run.started_utc, run.room, run.title, origin.mutant, keys->commit,
                     keys->machine, keys->build, origin.branch, to_bits(run.seed), run.max_success,
                     run.status, run.cases, run.discards, run.shrinks, run.shrink_tries, run.wall_time_ns,
                     null_if_empty(run.message), null_if_empty(run.reproduce),
                     null_if_empty(run.counterexample), null_if_empty(run.plan_case), run.case_robots,
                     run.case_cells);
    if (auto done = insert_run->run(); !done) return Unexpected{done.error()};
    if (connection.changes() == 0) {
      ++recorded.known;
      continue;
    }
    ++recorded.added;
    const std::int64_t id = connection.last_insert_rowid();
    for (const auto& [name, cases] : run.classes) {
      if (auto done = insert_class->bind(id, name, cases).run(); !done) return Unexpected{done.error()};
    }
  }
  if (auto done = transaction->commit(); !done) return Unexpected{done.error()};
  return recorded;
}

Result<Table> list_property_runs(Database& database, const PropertyFilter& filter) {
  auto select = Statement::prepare(
      database.connection(),
      fmt::format("SELECT id, started_utc, room, title, mutant, status, cases, discards, shrinks, "
                  "wall_time_s, printf('%llu', seed), case_robots, case_cells FROM {} "
                  "WHERE (?1 IS NULL OR room = ?1) AND (NOT ?2 OR status IN ('failed', 'crashed')) ORDER BY "
                  "{} LIMIT ?3",
                  filter.every_run ? "v_property_runs" : "v_property_latest",
                  filter.every_run ? "started_utc DESC, id DESC" : "room, title"),
      kReadingProperties);
  if (!select) return Unexpected{select.error()};
  const std::int64_t no_limit = -1;
  select->bind(filter.room, filter.failed,
               filter.limit == 0 ? no_limit : static_cast<std::int64_t>(filter.limit));
  Table table{{"id", "started_utc", "room", "title", "mutant", "status", "cases", "discards", "shrinks",
               "wall_time_s", "seed", "case_robots", "case_cells"},
              {}};
  for (;;) {
    const auto row = select->step();
    if (!row) return Unexpected{row.error()};
    if (!row.value()) return table;
    std::vector<Value> values{select->integer(0)};
    for (int column = 1; column <= 5; ++column) values.emplace_back(select->text(column));
    for (int column = 6; column <= 12; ++column) {
      if (table.columns[static_cast<std::size_t>(column)] == "seed") {
        values.emplace_back(select->text(column));  // 64 bits without a sign, as RC_PARAMS takes it
        continue;
      }
      values.push_back(
          value_of(*select, column, table.columns[static_cast<std::size_t>(column)] == "wall_time_s"));
    }
    table.rows.push_back(std::move(values));
  }
}

Result<PropertyReport> show_property_run(Database& database, std::int64_t id) {
  auto select = Statement::prepare(
      database.connection(),
      "SELECT property_run, started_utc, room, title, seed, max_success, status, cases, discards, shrinks, "
      "shrink_tries, CAST(round(wall_time_s * 1e9) AS INTEGER), message, reproduce, counterexample, "
      "plan_case, "
      "case_robots, case_cells, mutant, commit_hash, branch, dirty, host, "
      "compiler || ' ' || compiler_version, build_type, sanitizers FROM v_property_runs WHERE id = ?",
      kReadingProperties);
  if (!select) return Unexpected{select.error()};
  const auto row = select->bind(id).step();
  if (!row) return Unexpected{row.error()};
  if (!row.value()) {
    return Unexpected{Error{ErrorKind::kNotFound,
                            fmt::format("{}: no property run {}, expected one that `sipplab property list "
                                        "--all` shows",
                                        database.path().string(), id)}};
  }
  PropertyReport report;
  PropertyRun& run = report.run;
  int column = 0;
  report.id = id;
  run.uuid = select->text(column++);
  run.started_utc = select->text(column++);
  run.room = select->text(column++);
  run.title = select->text(column++);
  run.seed = static_cast<std::uint64_t>(select->integer(column++));
  run.max_success = select->integer(column++);
  run.status = select->text(column++);
  run.cases = select->integer(column++);
  run.discards = select->integer(column++);
  run.shrinks = select->integer(column++);
  run.shrink_tries = select->integer(column++);
  run.wall_time_ns = select->integer(column++);
  run.message = select->optional_text(column++).value_or("");
  run.reproduce = select->optional_text(column++).value_or("");
  run.counterexample = select->optional_text(column++).value_or("");
  run.plan_case = select->optional_text(column++).value_or("");
  run.case_robots = select->optional_integer(column++);
  run.case_cells = select->optional_integer(column++);
  report.mutant = select->text(column++);
  report.commit_hash = select->optional_text(column++);
  report.branch = select->text(column++);
  report.dirty = select->integer(column++) != 0;
  report.host = select->text(column++);
  report.compiler = select->text(column++);
  report.build_type = select->text(column++);
  report.sanitizers = select->text(column);

  auto classes = Statement::prepare(database.connection(),
                                    "SELECT class, cases FROM property_class WHERE property_run_id = ?",
                                    kReadingProperties);
  if (!classes) return Unexpected{classes.error()};
  classes->bind(id);
  for (;;) {
    const auto next = classes->step();
    if (!next) return Unexpected{next.error()};
    if (!next.value()) return report;
    run.classes[classes->text(0)] = classes->integer(1);
  }
}

Result<std::int64_t> latest_property_failure(Database& database) {
  auto id = database.connection().query_int(
      "SELECT id FROM property_run WHERE status = 'failed' AND mutant = '' "
      "ORDER BY started_utc DESC, id DESC LIMIT 1",
      kReadingProperties);
  if (!id && id.error().kind == ErrorKind::kNotFound) {
    return Unexpected{Error{ErrorKind::kNotFound, fmt::format("{}: no property run failed, expected one",
                                                              database.path().string())}};
  }
  return id;
}

}  // namespace sipplab::db
