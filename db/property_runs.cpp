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

/// A log that is recorded while a property runs holds its beginning alone: a crash, until it has an end.
Result<Done> forget_crash(sqlite::Connection& connection, const PropertyRun& run) {
  if (run.status == "crashed") return Done{};
  for (const char* sql :
       {"DELETE FROM property_run WHERE run_id = (SELECT id FROM run WHERE uuid = ? AND outcome = 'crashed')",
        "DELETE FROM run WHERE uuid = ? AND outcome = 'crashed'"}) {
    auto forget = Statement::prepare(connection, sql, "replacing a property run");
    if (!forget) return Unexpected{forget.error()};
    if (auto done = forget->bind(run.uuid).run(); !done) return done;
  }
  return Done{};
}

}  // namespace

Result<PropertyRecorded> record_property_runs(Database& database, const RunOrigin& origin,
                                              const std::vector<PropertyRun>& runs,
                                              const std::string& mutant) {
  auto& connection = database.connection();
  auto transaction = sqlite::Transaction::begin(connection);
  if (!transaction) return Unexpected{transaction.error()};
  auto insert_class = Statement::prepare(
      connection, "INSERT INTO property_class (property_run_id, class, cases) VALUES (?, ?, ?)",
      "writing the classes of a property run");
  if (!insert_class) return Unexpected{insert_class.error()};

  PropertyRecorded recorded;
  for (const PropertyRun& run : runs) {
    if (auto done = forget_crash(connection, run); !done) return Unexpected{done.error()};
    const auto run_id = insert_run(connection, origin, finished_run("property", run.room, run.status, run));
    if (!run_id) return Unexpected{run_id.error()};
    if (!*run_id) {
      ++recorded.known;
      continue;
    }
    ++recorded.added;
    const auto id = insert_row(connection, "property_run", "writing a property run", [&](auto visit) {
      visit("run_id", *run_id);
      visit("mutant", mutant);
      PropertyRun::columns(run, visit);
    });
    if (!id) return Unexpected{id.error()};
    for (const auto& [name, cases] : run.classes) {
      if (auto done = insert_class->bind(*id, name, cases).run(); !done) return Unexpected{done.error()};
    }
  }
  if (auto done = transaction->commit(); !done) return Unexpected{done.error()};
  return recorded;
}

Result<Table> list_property_runs(Database& database, const PropertyFilter& filter) {
  // Seeds have 64 bits without a sign, as RC_PARAMS takes them.
  auto select = Statement::prepare(
      database.connection(),
      fmt::format("SELECT id, started_utc, room, title, mutant, status, cases, discards, shrinks, "
                  "wall_time_s, printf('%llu', seed) AS seed, case_robots, case_cells FROM {} "
                  "WHERE (?1 IS NULL OR room = ?1) AND (NOT ?2 OR status IN ('failed', 'crashed')) ORDER BY "
                  "{} LIMIT ?3",
                  filter.every_run ? "v_property_runs" : "v_property_latest",
                  filter.every_run ? "started_utc DESC, id DESC" : "room, title"),
      kReadingProperties);
  if (!select) return Unexpected{select.error()};
  select->bind(filter.room, filter.failed, sql_limit(filter.limit));
  return rest_of(*select);
}

Result<PropertyReport> show_property_run(Database& database, std::int64_t id) {
  auto select = Statement::prepare(
      database.connection(),
      "SELECT property_run.id AS id, suite AS room, outcome AS status, commit_.hash AS commit_hash, dirty, "
      "host, "
      "compiler || ' ' || compiler_version AS compiler, build_type, sanitizers, property_run.*, run.* "
      "FROM property_run JOIN run ON run.id = run_id JOIN machine ON machine.id = machine_id "
      "JOIN build ON build.id = build_id LEFT JOIN commit_ ON commit_.id = commit_id WHERE property_run.id = "
      "?",
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
  read_row(*select, [&report](auto visit) {
    PropertyReport::columns(report, visit);
    PropertyRun::origin_columns(report.run, visit);
    PropertyRun::columns(report.run, visit);
  });

  auto classes = Statement::prepare(database.connection(),
                                    "SELECT class, cases FROM property_class WHERE property_run_id = ?",
                                    kReadingProperties);
  if (!classes) return Unexpected{classes.error()};
  classes->bind(id);
  const auto done = classes->for_each([&] { report.run.classes[classes->text(0)] = classes->integer(1); });
  if (!done) return Unexpected{done.error()};
  return report;
}

Result<std::int64_t> latest_property_failure(Database& database) {
  auto id = database.connection().query_int(
      "SELECT id FROM v_property_runs WHERE status = 'failed' AND mutant = '' AND excluded_reason IS NULL "
      "ORDER BY started_utc DESC, id DESC LIMIT 1",
      kReadingProperties);
  if (!id && id.error().kind == ErrorKind::kNotFound) {
    return Unexpected{Error{ErrorKind::kNotFound, fmt::format("{}: no property run failed, expected one",
                                                              database.path().string())}};
  }
  return id;
}

}  // namespace sipplab::db
