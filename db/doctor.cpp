// The checks of a history, one function each.
#include "db/doctor.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <map>

#include "db/identity.hpp"
#include "db/migrate.hpp"
#include "db/sqlite/statement.hpp"
#include "db/sqlite/transaction.hpp"
#include "db/summaries.hpp"

namespace sipplab::db {
namespace {

using sqlite::Connection;
using sqlite::Statement;

constexpr std::size_t kShortUuid = 8;
constexpr const char* kExamining = "examining it";

/// A check adds what it finds; an error of SQLite in it is a finding, too.
class Examination {
 public:
  Examination(Database& database, const DoctorOptions& options)
      : connection_(database.connection()), options_(options) {}

  DoctorReport run() {
    check("integrity", &Examination::integrity);
    check("schema", &Examination::schema);
    check("views", &Examination::views);
    check("foreign keys", &Examination::foreign_keys);
    check("results", &Examination::results);
    check("summaries", &Examination::summaries);
    check("planners", &Examination::planners);
    check("unfinished runs", &Examination::unfinished_runs);
    check("empty runs", &Examination::empty_runs);
    return std::move(report_);
  }

 private:
  void check(const std::string& name, Result<Done> (Examination::*body)()) {
    report_.checks.push_back(name);
    const Result<Done> done = (this->*body)();
    if (!done) add(done.error().message, "if the file is damaged: see integrity");
  }

  DoctorFinding& add(std::string what, std::string advice) {
    report_.findings.push_back({report_.checks.back(), std::move(what), std::move(advice), false, false});
    return report_.findings.back();
  }

  /// Where the user wants it fixed, `repair` does so.
  template <class Repair>
  Result<Done> add_fixable(std::string what, std::string advice, Repair repair) {
    DoctorFinding& finding = add(std::move(what), std::move(advice));
    finding.fixable = true;
    if (!options_.fix) return Done{};
    const std::size_t position = report_.findings.size() - 1;
    Result<Done> done = repair();
    report_.findings[position].fixed = done.has_value();
    return done;
  }

  /// The first column of every row.
  Result<std::vector<std::string>> texts(const std::string& sql) {
    return SIPPLAB_TRY(Statement::prepare(connection_, sql, kExamining)).collect([](const Statement& row) {
      return row.text(0);
    });
  }

  Result<Done> integrity() {
    const auto lines =
        SIPPLAB_TRY(texts(options_.quick ? "PRAGMA quick_check(5)" : "PRAGMA integrity_check(5)"));
    for (const std::string& line : lines) {
      if (line == "ok") continue;
      add(line.substr(0, line.find('\n')),
          "restore a copy, or save what can be read: sqlite3 FILE .recover | sqlite3 NEW-FILE");
    }
    return Done{};
  }

  /// Name and definition of everything in a schema.
  static Result<std::map<std::string, std::string>> definitions(Connection& connection) {
    auto select = SIPPLAB_TRY(Statement::prepare(
        connection,
        "SELECT type || ' ' || name, ifnull(sql, '') FROM sqlite_schema WHERE name NOT LIKE 'sqlite%'",
        kExamining));
    std::map<std::string, std::string> found;
    SIPPLAB_TRY(select.for_each([&] { found[select.text(0)] = select.text(1); }));
    return found;
  }

  Result<Done> schema() {
    auto fresh = SIPPLAB_TRY(Connection::open_in_memory());
    SIPPLAB_TRY(migrate(fresh, migrations()));
    const auto expected = SIPPLAB_TRY(definitions(fresh));
    const auto found = SIPPLAB_TRY(definitions(connection_));
    for (const auto& [name, sql] : expected) {
      const auto here = found.find(name);
      if (here != found.end() && here->second == sql) continue;
      add(fmt::format("{} {}", name,
                      here == found.end() ? "is missing" : "differs from what the migrations create"),
          "merge it into a new file, which has the right schema: sipplab merge FILE --db NEW-FILE");
    }
    return Done{};
  }

  Result<Done> views() {
    const auto names = SIPPLAB_TRY(texts("SELECT name FROM sqlite_schema WHERE type = 'view' ORDER BY name"));
    for (const std::string& name : names) {
      const auto answer = texts(fmt::format("SELECT 1 FROM (SELECT * FROM \"{}\" LIMIT 1)", name));
      if (!answer) add(fmt::format("{}: {}", name, answer.error().message), "see schema");
    }
    return Done{};
  }

  Result<Done> foreign_keys() {
    const auto rows = SIPPLAB_TRY(texts(
        "SELECT printf('%d rows of %s point to rows of %s that are not there', count(*), \"table\", parent) "
        "FROM pragma_foreign_key_check GROUP BY \"table\", parent"));
    for (const std::string& row : rows) {
      add(row,
          "another program wrote here without foreign keys; restore a copy, or delete those rows "
          "(PRAGMA foreign_key_check names them)");
    }
    return Done{};
  }

  Result<Done> results() {
    const auto rows = SIPPLAB_TRY(
        texts("SELECT printf('run %.8s, case %d: %d results, expected %d', run.uuid, cell.case_id, found, "
              "cell.result_count) FROM (SELECT cell.id AS id, "
              "(SELECT count(*) FROM result WHERE cell_id = cell.id) AS found FROM cell) AS counted "
              "JOIN cell ON cell.id = counted.id JOIN run ON run.id = cell.run_id "
              "WHERE found <> cell.result_count LIMIT 10"));
    for (const std::string& row : rows) {
      add(row,
          "another program changed results: exclude the run with "
          "`sipplab runs --exclude RUN --reason ...`");
    }
    return Done{};
  }

  Result<Done> summaries() {
    const auto stale = SIPPLAB_TRY(
        options_.quick ? connection_.query_int(
                             "SELECT count(*) FROM cell LEFT JOIN cell_summary USING (case_id, run_id) "
                             "WHERE cell_summary.results IS NOT cell.result_count",
                             kExamining)
                       : count_stale_summaries(connection_));
    if (stale == 0) return Done{};
    return add_fixable(fmt::format("{} cells whose summary is missing or differs from their results", stale),
                       "sipplab doctor --fix makes them anew from the results",
                       [this] { return rebuild_summaries(connection_); });
  }

  Result<Done> planners() {
    const auto rows = texts(
        "WITH command AS (SELECT DISTINCT case_.planner, substr(run.options, instr(run.options, ' "
        "planner='), "
        "    instr(run.options, ' memory_limit=') - instr(run.options, ' planner=')) AS digest "
        "  FROM run JOIN cell ON cell.run_id = run.id JOIN case_ ON case_.id = cell.case_id "
        "  WHERE run.excluded_reason IS NULL AND run.options LIKE '% planner=%') "
        "SELECT printf('\"%w\" stands for %d commands', planner, count(*)) FROM command "
        "GROUP BY planner HAVING count(*) > 1");
    if (!rows) return Unexpected{rows.error()};
    for (const std::string& row : *rows) {
      add(row,
          "exclude the runs of all but one (sipplab runs --exclude), or record them again with "
          "--planner-name");
    }
    return Done{};
  }

  Result<Done> unfinished_runs() {
    auto select = SIPPLAB_TRY(Statement::prepare(
        connection_,
        "SELECT uuid, writer, suite FROM run WHERE kind = 'sweep' AND status = 'running' AND origin = ''",
        kExamining));
    std::vector<std::pair<std::string, std::string>> dead;
    const auto read = select.for_each([&] {
      if (!is_alive(select.text(1))) dead.emplace_back(select.text(0), select.text(2));
    });
    if (!read) return read;
    for (const auto& [uuid, suite] : dead) {
      SIPPLAB_TRY(add_fixable(fmt::format("run {} of suite {} was killed", uuid.substr(0, kShortUuid), suite),
                              "its command with --resume plans the remaining cases; sipplab doctor --fix "
                              "closes it as aborted, which can "
                              "still be resumed",
                              [this, run = uuid] { return close_run(run); }));
    }
    return Done{};
  }

  Result<Done> empty_runs() {
    const auto empty = SIPPLAB_TRY(texts(
        "SELECT uuid FROM run WHERE kind IN ('sweep', 'report') AND status <> 'running' AND excluded_reason "
        "IS NULL "
        "AND NOT EXISTS (SELECT 1 FROM cell WHERE cell.run_id = run.id) "
        "AND NOT EXISTS (SELECT 1 FROM measurement WHERE measurement.run_id = run.id)"));
    for (const std::string& uuid : empty) {
      SIPPLAB_TRY(
          add_fixable(fmt::format("run {} ended without a finished case", uuid.substr(0, kShortUuid)),
                      "sipplab doctor --fix excludes it; its command with --resume would start it again",
                      [this, run = uuid] { return exclude(run); }));
    }
    return Done{};
  }

  Result<Done> close_run(const std::string& uuid) {
    return update("UPDATE run SET status = 'aborted', ended_utc = ?2 WHERE uuid = ?1 AND status = 'running'",
                  uuid);
  }
  Result<Done> exclude(const std::string& uuid) {
    return update("UPDATE run SET excluded_reason = 'no finished case', excluded_utc = ?2 WHERE uuid = ?1",
                  uuid);
  }
  Result<Done> update(const std::string& sql, const std::string& uuid) {
    auto transaction = SIPPLAB_TRY(sqlite::Transaction::begin(connection_));
    SIPPLAB_TRY(sqlite::run(connection_, sql, "setting a run right", uuid, utc_now()));
    return transaction.commit();
  }

  Connection& connection_;
  DoctorOptions options_;
  DoctorReport report_;
};

}  // namespace

bool DoctorReport::sound() const {
  return std::all_of(findings.begin(), findings.end(),
                     [](const DoctorFinding& finding) { return finding.fixed; });
}

DoctorReport examine(Database& database, const DoctorOptions& options) {
  return Examination(database, options).run();
}

}  // namespace sipplab::db
