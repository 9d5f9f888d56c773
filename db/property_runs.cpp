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
       {"DELETE FROM property_class WHERE property_run_id = (SELECT property_run.id FROM property_run "
        "JOIN run ON run.id = run_id WHERE uuid = ? AND outcome = 'crashed')",
        "DELETE FROM property_run WHERE run_id = (SELECT id FROM run WHERE uuid = ? AND outcome = 'crashed')",
        "DELETE FROM run WHERE uuid = ? AND outcome = 'crashed'"}) {
    SIPPLAB_TRY(sqlite::run(connection, sql, "replacing a property run", run.uuid));
  }
  return Done{};
}

}  // namespace

Result<PropertyRecorded> record_property_runs(Database& database, const RunOrigin& origin,
                                              const std::vector<PropertyRun>& runs,
                                              const std::string& mutant) {
  auto& connection = database.connection();
  auto transaction = SIPPLAB_TRY(sqlite::Transaction::begin(connection));

  PropertyRecorded recorded;
  for (const PropertyRun& run : runs) {
    SIPPLAB_TRY(forget_crash(connection, run));
    const auto run_id =
        SIPPLAB_TRY(insert_run(connection, origin, finished_run("property", run.room, run.status, run)));
    if (!run_id) {
      ++recorded.known;
      continue;
    }
    ++recorded.added;
    const auto id =
        SIPPLAB_TRY(insert_row(connection, "property_run", "writing a property run", [&](auto visit) {
          visit("run_id", run_id);
          visit("mutant", mutant);
          PropertyRun::columns(run, visit);
        }));
    for (const auto& [name, cases] : run.classes) {
      SIPPLAB_TRY(sqlite::run(connection,
                              "INSERT INTO property_class (property_run_id, class, cases) VALUES (?, ?, ?)",
                              "writing the classes of a property run", id, name, cases));
    }
  }
  SIPPLAB_TRY(transaction.commit());
  return recorded;
}

Result<Table> list_property_runs(Database& database, const PropertyFilter& filter) {
  // Seeds have 64 bits without a sign, as RC_PARAMS takes them.
  return rest_of(SIPPLAB_TRY(Statement::prepare(
      database.connection(),
      fmt::format("SELECT id, started_utc, room, title, mutant, status, cases, discards, shrinks, "
                  "wall_time_s, printf('%llu', seed) AS seed, case_robots, case_cells FROM {} "
                  "WHERE (?1 IS NULL OR room = ?1) AND (NOT ?2 OR status IN ('failed', 'crashed')) ORDER BY "
                  "{} LIMIT ?3",
                  filter.every_run ? "v_property_runs" : "v_property_latest",
                  filter.every_run ? "started_utc DESC, id DESC" : "room, title"),
      kReadingProperties, filter.room, filter.failed, sql_limit(filter.limit))));
}

Result<PropertyReport> show_property_run(Database& database, std::int64_t id) {
  auto select = SIPPLAB_TRY(Statement::prepare(
      database.connection(),
      "SELECT property_run.id AS id, suite AS room, outcome AS status, commit_.hash AS commit_hash, dirty, "
      "host, "
      "compiler || ' ' || compiler_version AS compiler, build_type, sanitizers, property_run.*, run.* "
      "FROM property_run JOIN run ON run.id = run_id JOIN machine ON machine.id = machine_id "
      "JOIN build ON build.id = build_id LEFT JOIN commit_ ON commit_.id = commit_id WHERE property_run.id = "
      "?",
      kReadingProperties, id));
  const auto row = SIPPLAB_TRY(select.step());
  if (!row) {
    return Unexpected{Error{ErrorKind::kNotFound,
                            fmt::format("{}: no property run {}, expected one that `sipplab property list "
                                        "--all` shows",
                                        database.path().string(), id)}};
  }
  PropertyReport report;
  read_row(select, [&report](auto visit) {
    PropertyReport::columns(report, visit);
    PropertyRun::origin_columns(report.run, visit);
    PropertyRun::columns(report.run, visit);
  });

  auto classes = SIPPLAB_TRY(Statement::prepare(
      database.connection(), "SELECT class, cases FROM property_class WHERE property_run_id = ?",
      kReadingProperties, id));
  SIPPLAB_TRY(classes.for_each([&] { report.run.classes[classes.text(0)] = classes.integer(1); }));
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
