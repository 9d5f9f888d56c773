// What questions get: one view for most of them, failures that are not fast, instances that are found.
#include <cmath>

#include "db/merge.hpp"
#include "db/queries.hpp"
#include "db/tests/history_support.hpp"

namespace sipplab::db {
namespace {

using test::ask;
using test::must;
using test::record_version;

class Asking : public test::DatabaseTest {
 protected:
  ~Asking() override {
    if (std::filesystem::exists(file)) test::expect_sound(file);
  }
  void record(const CaseInfo& parameters, const std::vector<ResultRow>& rows) {
    auto recorder = must(RunRecorder::begin(must(Database::open(file)), test::sample_run()));
    int index = 0;
    for (const ResultRow& row : rows) recorder.add(parameters, test::sample_instance(index++), row);
    must(recorder.commit_case(parameters));
    must(recorder.finish(RunStatus::kFinished));
  }
  static ResultRow solved_in(std::int64_t milliseconds) {
    ResultRow row = test::sample_result(0);
    row.planning_time_ns = milliseconds * 1'000'000;
    return row;
  }
  void expect_instances_are_counted() {
    EXPECT_EQ(ask(file,
                  "SELECT count(*) FROM (SELECT * FROM v_recomputed_instances EXCEPT "
                  "SELECT * FROM instance_summary)"),
              "0");
  }
};

TEST_F(Asking, every_column_of_a_case_but_its_number_is_in_its_key) {
  must(Database::open(file));
  const char* columns = "SELECT group_concat(name) FROM (SELECT name FROM pragma_table_info('case_') ";
  const std::string all = ask(file, std::string(columns) + "WHERE name <> 'id' ORDER BY name)");
  EXPECT_EQ(ask(file,
                "SELECT group_concat(name) FROM (SELECT i.name FROM pragma_index_list('case_') AS l, "
                "pragma_index_info(l.name) AS i WHERE l.origin = 'u' ORDER BY i.name)"),
            all);
  EXPECT_GT(all.size(), 200U);
}

TEST_F(Asking, cases_that_differ_in_one_option_are_two) {
  const CaseInfo plain = test::sample_case(64);
  std::vector<CaseInfo> cases{plain};
  for (const auto& [name, value] : plain.options) {
    CaseInfo other = plain;
    Value& changed = other.options[name];
    if (auto* whole = std::get_if<std::int64_t>(&changed)) {
      *whole = *whole == 0 ? 1 : *whole - 1;  // flags stay flags
    } else if (auto* real = std::get_if<double>(&changed)) {
      *real += 0.5;
    } else {
      changed = "another";
    }
    cases.push_back(other);
  }
  CaseInfo new_option = plain;
  new_option.options["of-tomorrow"] = std::int64_t{1};
  cases.push_back(new_option);
  ASSERT_GT(cases.size(), 18U);
  auto recorder = must(RunRecorder::begin(must(Database::open(file)), test::sample_run()));
  for (const CaseInfo& parameters : cases) must(recorder.commit_case(parameters));
  EXPECT_EQ(ask(file, "SELECT count(*) FROM case_"), std::to_string(cases.size()));
}

TEST_F(Asking, one_view_says_everything_of_a_result) {
  ResultRow row = test::sample_result(0);
  row.made_by = "complete";
  row.ssi_kept_s = 2.5;
  row.instructions = 123;
  row.cpu_time_ns = 5'000'000;
  row.flowtime_bound_s = 900;
  row.makespan_bound_s = 30;
  CaseInfo parameters = test::sample_case(64);
  parameters.options["weight"] = 1.5;
  record(parameters, {row});
  EXPECT_EQ(ask(file,
                "SELECT suite || '|' || (started_utc > '2020') || '|' || substr(commit_hash, 1, 4) || '|' || "
                "host || '|' || made_by || '|' || ssi_kept_s || '|' || instructions || '|' || cpu_time_s || "
                "'|' || flowtime_bound_s || '|' || round(flowtime_gap, 6) || '|' || makespan_gap || '|' || "
                "(sum_of_costs = flowtime_s) || '|' || weight FROM v_results"),
            "smoke|1|0123|host|complete|2.5|123|0.005|900.0|0.1|0.0|1|1.5");
  EXPECT_EQ(ask(file, "SELECT weight || '|' || host || '|' || (mean_sum_of_costs = 1000) FROM v_run_cells"),
            "1.5|host|1");
#ifdef __linux__
  EXPECT_EQ(ask(file, "SELECT machine_load >= 0 FROM v_results"), "1");
#endif
}

TEST_F(Asking, a_bound_is_of_the_instance_and_the_moves_and_the_greatest_stands) {
  ResultRow failed = test::failed_result();
  failed.flowtime_bound_s = 800;
  failed.makespan_bound_s = 31;
  record(test::sample_case(64), {failed});
  record(test::sample_case(64, 0), {test::sample_result(0)});  // has no bound of its own
  EXPECT_EQ(ask(file, "SELECT round(flowtime_gap, 6) FROM v_results WHERE status = 'solved'"), "0.2");
  EXPECT_EQ(ask(file, "SELECT count(*) FROM v_results WHERE status = 'failed' AND flowtime_gap IS NULL"),
            "1");
  ResultRow better = test::sample_result(0);
  better.flowtime_bound_s = 990;
  better.makespan_bound_s = 20;
  CaseInfo other_steps = test::sample_case(64);
  other_steps.options["connectedness"] = std::int64_t{5};
  record(other_steps, {better});
  EXPECT_EQ(ask(file,
                "SELECT count(*) || '|' || max(flowtime_bound_s) || '|' || max(makespan_bound_s) "
                "FROM instance_bound"),
            "1|990.0|31.0")
      << "any-angle moves do not depend on steps";
  better.flowtime_bound_s = 700;
  record(other_steps, {better});
  EXPECT_EQ(ask(file, "SELECT flowtime_bound_s FROM instance_bound"), "990.0") << "by less work, as true";
  CaseInfo on_grid = other_steps;
  on_grid.options["any_angle"] = std::int64_t{0};
  better.flowtime_bound_s = 995;
  record(on_grid, {better});
  EXPECT_EQ(ask(file, "SELECT flowtime_bound_s FROM v_results WHERE NOT any_angle"), "995.0");
  EXPECT_EQ(ask(file, "SELECT max(flowtime_bound_s) FROM v_results WHERE any_angle"), "990.0");
}

TEST_F(Asking, failures_are_never_fast) {
  const ResultRow failed = test::failed_result();  // within 7 ns
  const struct {
    std::vector<ResultRow> rows;
    const char* solved;
    const char* to_solve;
  } cases[] = {
      {{solved_in(4), solved_in(2), failed}, "0.003", "0.004"},
      {{solved_in(4), solved_in(2), solved_in(1), failed}, "0.002", "0.003"},
      {{solved_in(4), failed}, "0.004", "none"},
      {{solved_in(4), failed, failed}, "0.004", "none"},
      {{failed}, "none", "none"},
  };
  std::int64_t robots = 1;
  for (const auto& one : cases) {
    record(test::sample_case(robots), one.rows);
    EXPECT_EQ(
        ask(file,
            "SELECT ifnull(median_solved_time_s, 'none') || ' ' || ifnull(median_time_to_solve_s, 'none') "
            "FROM v_run_cells WHERE robots = " +
                std::to_string(robots)),
        one.solved + std::string(" ") + one.to_solve)
        << robots;
    ++robots;
  }
  EXPECT_EQ(
      ask(file,
          "SELECT count(*) FROM v_recomputed_cells AS made JOIN cell_summary AS kept USING (case_id, run_id) "
          "WHERE made.median_solved_time_s IS NOT kept.median_solved_time_s OR made.mean_solved_time_s IS "
          "NOT "
          "kept.mean_solved_time_s OR made.median_time_to_solve_s IS NOT kept.median_time_to_solve_s"),
      "0");
  auto database = must(Database::open(file));
  const std::string text = format_run_report(must(show_run(database, "latest")), OutputFormat::kTable);
  EXPECT_EQ(text.find("7.00 us"), std::string::npos) << text;
  EXPECT_EQ(ask(file, "SELECT count(value) FROM v_trends WHERE metric = 'runtime'"), "2");
}

TEST_F(Asking, instances_are_counted_whoever_writes) {
  record_version(file, {1, 1, 8});
  const std::string second = record_version(file, {2, 1, 6});
  EXPECT_EQ(
      ask(file,
          "SELECT group_concat(solved || '/' || results) FROM (SELECT * FROM v_instances ORDER BY instance)"),
      "2/2,2/2,2/2,2/2,2/2,2/2,1/2,1/2,0/2,0/2");
  expect_instances_are_counted();
  const auto set = [&](bool excluded) {
    auto database = must(Database::open(file));
    excluded ? must(exclude_run(database, second, "swapping")) : must(include_run(database, second));
    expect_instances_are_counted();
  };
  set(true);
  EXPECT_EQ(ask(file, "SELECT sum(solved) || '/' || sum(results) FROM v_instances"), "8/10");
  EXPECT_EQ(ask(file, "SELECT count(*) FROM v_all_results"), "20");
  const std::filesystem::path merged = folder / "merged.db";
  for (int i = 0; i < 2; ++i) {
    auto database = must(Database::open(merged));
    must(merge_into(database, file));
    EXPECT_EQ(ask(merged, "SELECT sum(solved) || '/' || sum(results) FROM v_instances"), "8/10");
  }
  set(false);
  EXPECT_EQ(ask(file, "SELECT sum(solved) || '/' || sum(results) FROM v_instances"), "14/20");
  {
    auto database = must(Database::open(merged));
    must(merge_into(database, file));
  }
  EXPECT_EQ(ask(merged, "SELECT sum(solved) || '/' || sum(results) FROM v_instances"), "14/20");
}

TEST_F(Asking, one_instance_is_found_without_reading_the_others) {
  record_version(file, {1, 1, 8});
  const Table plan = must(run_sql(file,
                                  "EXPLAIN QUERY PLAN SELECT started_utc, status, flowtime_s FROM v_results "
                                  "WHERE instance_hash = '0000000000000001'"));
  std::string text;
  for (const auto& row : plan.rows) text += std::get<std::string>(row[3]) + '\n';
  EXPECT_NE(text.find("SEARCH result USING PRIMARY KEY (cell_id=? AND instance_id=?"), std::string::npos)
      << text;
  EXPECT_EQ(text.find("SCAN"), std::string::npos) << text;
}

TEST_F(Asking, curves_hold_their_last_value) {
  ResultRow early = test::sample_result(0);
  early.progress = {{0, 1'000'000'000, 1000, 35, 900, 25}, {7, 2'000'000'000, 950, 35, 900, 25}};
  ResultRow late = test::sample_result(1);
  late.progress = {{0, 1'500'000'000, 2000, 35, 900, 25}, {7, 9'000'000'000, 1800, 35, 900, 25}};
  record(test::sample_case(64), {early, late});
  const auto at = [this](const std::string& seconds) {
    return ask(file, "SELECT count(*) || ' ' || avg(flowtime_s) FROM v_progress WHERE elapsed_s <= " +
                         seconds + " AND until_s > " + seconds);
  };
  EXPECT_EQ(at("1.2"), "1 1000.0");
  EXPECT_EQ(at("2"), "2 1475.0");
  EXPECT_EQ(at("5"), "2 1475.0") << "the first curve ended at 2 s";
  EXPECT_EQ(at("1000"), "2 1375.0");
}

}  // namespace
}  // namespace sipplab::db
