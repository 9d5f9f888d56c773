// schema.md names everything that the schema has.
#include <algorithm>
#include <set>
#include <sstream>

#include "db/best_known.hpp"
#include "db/catalogue.hpp"
#include "db/findings.hpp"
#include "db/gate_runs.hpp"
#include "db/measurements.hpp"
#include "db/property_runs.hpp"
#include "db/queries.hpp"
#include "db/tests/support.hpp"

namespace sipplab::db {
namespace {

class SchemaDocument : public test::DatabaseTest {
 protected:
  /// One that failed, so that every view of property runs has a row.
  void record_a_property_run() {
    PropertyRun run;
    run.uuid = "00000000-0000-4000-8000-000000000001";
    run.room = "grid";
    run.title = "cells are square";
    run.status = "failed";
    run.message = "no";
    run.reproduce = "reproduce=AbC";
    run.cases = 2;
    run.classes = {{"dense", 1}};
    auto database = test::must(Database::open(file));
    test::must(record_property_runs(database, test::sample_run(), {run}));
  }

  /// A run, its coverage and what it found: every view of fuzzing has a row.
  void record_fuzzing() {
    const RunOrigin origin = test::sample_run();
    FuzzRun run;
    run.uuid = run.campaign = "00000000-0000-4000-8000-000000000002";
    run.target = "reads_back";
    run.mode = "for";
    run.status = "findings";
    run.counts = {{"event", "inputs", 1}};
    Finding finding;
    finding.target = run.target;
    finding.kind = "claim";
    auto database = test::must(Database::open(file));
    const std::int64_t id = test::must(record_fuzz_run(database, origin, run));
    test::must(record_fuzz_coverage(database, run.campaign, {{"planner/io/text.cpp", 8, 6}}));
    test::must(record_finding(database, origin, finding, id, "2026-01-31T12:00:00.000Z"));
  }

  void record_a_gate_run() {
    GateRun run;
    static_cast<RunOrigin&>(run) = test::sample_run();
    run.suite = "gate";
    run.base_build = run.build;
    run.pair_seconds = 1;
    run.tolerance = 0.05;
    run.started_utc = "2026-01-31T12:00:00.000Z";
    run.verdict = "regressed";
    run.compared = run.differing = 1;
    GateCellRow cell;
    cell.verdict = "equivalent";
    cell.pairs = {0.01};
    run.cells = {cell};
    run.differences = {{test::sample_case(64), test::sample_instance(0), "plan", "one", "another"}};
    auto database = test::must(Database::open(file));
    test::must(record_gate_run(database, run));
  }

  /// Two sweeps, whose UUIDs are returned, and one of each other kind.
  std::vector<std::string> record_runs_of_all_kinds() {
    std::vector<std::string> runs;
    for (const bool solved : {true, false}) {
      auto recorder = test::must(RunRecorder::begin(test::must(Database::open(file)), test::sample_run()));
      const CaseInfo parameters = test::sample_case(64);
      ResultRow row = solved ? test::sample_result(0) : test::failed_result();
      row.retiming = RetimingRow{};
      row.reported = {{"iterations", 7}};
      recorder.add(parameters, test::sample_instance(0), row);
      test::must(recorder.commit());
      runs.push_back(recorder.run_uuid());
    }
    record_a_property_run();
    import_a_report();
    record_a_gate_run();
    record_fuzzing();
    Database best = test::must(Database::open(file));
    test::must(record_best_known(best, {{"a_map", "random", 1, 10, 20, 30}}));
    return runs;
  }

  void import_a_report() {
    MeasurementRun run;
    run.uuid = "00000000-0000-8000-8000-000000000001";
    run.started_utc = "2026-01-31T12:00:00.000Z";
    run.info.suite = "other";
    run.measurements.push_back({"sort/1024", 0, 100, 12.5, 12.0, "", {}});
    auto database = test::must(Database::open(file));
    test::must(record_measurements(database, run));
  }
};

/// The part of the text under a heading, up to the next one.
std::string section(const std::string& text, const std::string& heading) {
  const std::size_t begin = text.find("\n" + heading + "\n");
  if (begin == std::string::npos) return {};
  const std::size_t end = text.find("\n#", begin + 1);
  return text.substr(begin, end - begin);
}

/// The lines of a section that are indented by four blanks.
std::string example(const std::string& section_text) {
  std::istringstream lines{section_text};
  std::string sql;
  for (std::string line; std::getline(lines, line);) {
    if (line.rfind("    ", 0) == 0) sql += line + ' ';
  }
  return sql;
}

void replace_all(std::string& text, const std::string& from, const std::string& to) {
  for (std::size_t at = 0; (at = text.find(from, at)) != std::string::npos; at += to.size()) {
    text.replace(at, from.size(), to);
  }
}

std::string document() { return test::bytes_of(std::filesystem::path{SIPPLAB_DB_FOLDER} / "schema.md"); }

TEST_F(SchemaDocument, names_every_table_view_and_column) {
  const std::string text = document();
  ASSERT_FALSE(text.empty());
  test::must(Database::open(file));
  const Table columns = test::must(
      run_sql(file,
              "SELECT t.name, c.name FROM pragma_table_list AS t JOIN pragma_table_xinfo(t.name) AS c "
              "WHERE t.schema = 'main' AND t.name NOT LIKE 'sqlite%' ORDER BY t.name, c.cid"));
  ASSERT_GT(columns.rows.size(), 50U);
  for (const auto& row : columns.rows) {
    const auto& table = std::get<std::string>(row[0]);
    const auto& column = std::get<std::string>(row[1]);
    std::string description = section(text, "### `" + table + "`");
    EXPECT_FALSE(description.empty()) << "no section for " << table;
    if (table.rfind("v_all_", 0) == 0) description += section(text, "### `v_" + table.substr(6) + "`");
    EXPECT_NE(description.find("`" + column + "`"), std::string::npos) << table << '.' << column;
  }
}

TEST_F(SchemaDocument, has_examples_that_answer) {
  std::vector<std::string> runs = record_runs_of_all_kinds();
  const auto expect_answer = [&](std::string sql) {
    replace_all(sql, ":run", "'" + runs[0] + "'");
    replace_all(sql, ":other", "'" + runs[1] + "'");
    const auto answer = run_sql(file, sql);
    ASSERT_TRUE(answer) << answer.error().message;
    EXPECT_GT(answer->rows.size(), 0U) << sql;
  };
  const Table views = test::must(run_sql(file, "SELECT name FROM sqlite_schema WHERE type = 'view'"));
  ASSERT_FALSE(views.rows.empty());
  for (const auto& row : views.rows) {
    const auto& view = std::get<std::string>(row[0]);
    const std::string sql = example(section(document(), "### `" + view + "`"));
    EXPECT_NE(sql.find(view), std::string::npos) << view << " has no example";
    expect_answer(sql);
  }
  expect_answer(example(section(document(), "## Functions")));
}

// Those that list runs, with the reason; those that are of no run; definitions of caches.
const std::set<std::string> kWithExcludedRuns = {
    "v_runs",           "v_sweeps",        "v_attempts",    "v_property_runs",    "v_gate_runs",
    "v_fuzz_runs",      "v_all_run_cells", "v_all_results", "v_commits",          "v_all_measurements",
    "v_all_gate_cells", "v_cases",         "v_findings",    "v_recomputed_cells", "v_recomputed_instances"};

TEST_F(SchemaDocument, says_which_views_have_excluded_runs_and_no_other_has) {
  record_runs_of_all_kinds();
  const auto rows_of = [this](const std::string& view) {
    return std::stoi(test::ask(file, "SELECT count(*) FROM " + view));
  };
  const Table views = test::must(run_sql(file, "SELECT name FROM sqlite_schema WHERE type = 'view'"));
  for (const auto& row : views.rows) EXPECT_GT(rows_of(std::get<std::string>(row[0])), 0);
  {
    auto database = test::must(Database::open(file));
    const Table runs = test::must(run_sql(file, "SELECT run FROM v_runs"));
    ASSERT_GE(runs.rows.size(), 6U);
    for (const auto& row : runs.rows) {
      test::must(exclude_run(database, std::get<std::string>(row[0]), "the machine was busy"));
    }
  }
  for (const auto& row : views.rows) {
    const auto& view = std::get<std::string>(row[0]);
    if (view == "v_best_known") continue;  // costs of others stay, with none of ours beside them
    EXPECT_EQ(rows_of(view) > 0, kWithExcludedRuns.contains(view)) << view;
    const bool tells = test::ask(file, "SELECT count(*) FROM pragma_table_info('" + view +
                                           "') WHERE name = 'excluded_reason'") == "1";
    if (tells) {
      EXPECT_EQ(rows_of(view + " WHERE excluded_reason IS NULL"), 0) << view;
    }
  }
  EXPECT_EQ(test::ask(file, "SELECT sum(runs + property_runs) FROM v_commits"), "0");
  EXPECT_EQ(test::ask(file, "SELECT sum(results) + sum(solved) FROM v_recomputed_instances"), "0");
  EXPECT_EQ(test::ask(file, "SELECT sum(results) + sum(solved) FROM instance_summary"), "0");
}

TEST_F(SchemaDocument, is_the_catalogue_of_all_views) {
  test::must(Database::open(file));
  const Table views =
      test::must(run_sql(file, "SELECT name FROM sqlite_schema WHERE type = 'view' ORDER BY name"));
  std::vector<std::string> expected;
  for (const auto& row : views.rows) expected.push_back(std::get<std::string>(row[0]));
  std::vector<std::string> listed;
  for (const ViewDescription& view : view_catalogue()) {
    listed.push_back(view.name);
    EXPECT_EQ(view.since.rfind("Since version ", 0), 0U) << view.name << ": " << view.since;
    EXPECT_GT(view.purpose.size(), 10U) << view.name;
    EXPECT_EQ(view.example.rfind("SELECT", 0), 0U) << view.name << ": " << view.example;
  }
  std::sort(listed.begin(), listed.end());
  EXPECT_EQ(listed, expected);
}

}  // namespace
}  // namespace sipplab::db
