// Trends: one point per version, in the order of history, and the changes between them.
#include "db/trends.hpp"

#include <set>

#include "db/queries.hpp"
#include "db/tests/history_support.hpp"

namespace sipplab::db {
namespace {

using test::must;
using test::record_version;

class Trends : public test::DatabaseTest {
 protected:
  std::vector<TrendSeries> trend(const std::string& metric, CaseFilter cases = {}) {
    auto database = must(Database::open_read_only(file));
    TrendQuery query;
    query.metric = find_trend_metric(metric);
    query.cases = std::move(cases);
    auto series = must(read_trend(database, query));
    mark_changes(series, *query.metric);
    return series;
  }
};

TEST_F(Trends, points_are_in_the_order_of_commits_not_of_runs) {
  for (const int number : {3, 1, 5, 2, 4}) record_version(file, {number, 1.0 * number, 8});
  // One was committed on a machine whose clock was wrong.
  test::ask(file,
            "UPDATE commit_ SET committed_utc = '2019-01-01T00:00:00Z' WHERE ancestor_count = 4 RETURNING 1");
  const auto series = trend("flowtime");
  ASSERT_EQ(series.size(), 1U);
  ASSERT_EQ(series[0].points.size(), 5U);
  for (int i = 0; i < 5; ++i) {
    const TrendPoint& point = series[0].points[static_cast<std::size_t>(i)];
    EXPECT_EQ(point.commit, test::hash_of(i + 1));
    EXPECT_DOUBLE_EQ(point.value, 1000.0 * (i + 1));
  }
}

TEST_F(Trends, runs_of_one_commit_are_one_point_and_builds_with_changes_another) {
  for (const double factor : {1.0, 3.0, 2.0}) record_version(file, {1, factor, 8});
  record_version(file, {1, 7, 8, true});
  const auto series = trend("flowtime");
  ASSERT_EQ(series[0].points.size(), 2U);
  EXPECT_EQ(series[0].points[0].runs, 3);
  EXPECT_DOUBLE_EQ(series[0].points[0].value, 2000) << "the median";
  EXPECT_TRUE(series[0].points[1].dirty);
  EXPECT_DOUBLE_EQ(series[0].points[1].value, 7000);
}

TEST_F(Trends, a_build_with_changes_that_ran_again_is_still_one_version) {
  for (const double factor : {1.0, 5.0, 3.0}) {
    const std::string uuid = record_version(file, {1, factor, 8, true});
    if (factor != 5) continue;
    // Between two runs of the first build, one of another.
    test::ask(file,
              "INSERT INTO build SELECT (SELECT max(id) + 1 FROM build), compiler, compiler_version, flags, "
              "build_type, assertions, sanitizers, 'another', dirty FROM build LIMIT 1 RETURNING 1");
    test::ask(file, "UPDATE run SET build_id = (SELECT max(id) FROM build) WHERE uuid = '" + uuid +
                        "' RETURNING 1");
  }
  const auto series = trend("flowtime");
  ASSERT_EQ(series[0].points.size(), 2U);
  EXPECT_EQ(series[0].points[0].runs, 2);
  EXPECT_DOUBLE_EQ(series[0].points[0].value, 2000);
}

TEST_F(Trends, a_commit_of_a_shallow_clone_is_placed_by_its_date) {
  for (const int number : {1, 2, 3, 4}) record_version(file, {number, 1, 8});
  test::ask(file,
            "UPDATE commit_ SET ancestor_count = 0 WHERE hash = '" + test::hash_of(3) + "' RETURNING 1");
  const auto series = trend("success");
  ASSERT_EQ(series[0].points.size(), 4U);
  EXPECT_EQ(series[0].points[2].commit, test::hash_of(3));
}

TEST_F(Trends, a_merge_keeps_all_its_parents) {
  RunInfo info = test::sample_run();
  info.commit->later_parents = {test::hash_of(8), test::hash_of(9)};
  for (int i = 0; i < 2; ++i) must(RunRecorder::begin(must(Database::open(file)), info));
  EXPECT_EQ(test::ask(file, "SELECT parents FROM v_commits"),
            info.commit->first_parent + ' ' + test::hash_of(8) + ' ' + test::hash_of(9));
}

TEST_F(Trends, excluded_runs_are_left_out_until_they_are_included) {
  record_version(file, {1, 1, 8});
  const std::string uuid = record_version(file, {2, 1, 3});
  auto database = must(Database::open(file));
  must(exclude_run(database, uuid, "noisy neighbour"));
  EXPECT_EQ(trend("success")[0].points.size(), 1U);
  must(include_run(database, uuid));
  EXPECT_EQ(trend("success")[0].points.size(), 2U);
  EXPECT_EQ(test::ask(file, "SELECT count(*) FROM run WHERE included_utc IS NOT NULL"), "1");
}

TEST_F(Trends, a_change_is_marked_with_its_size) {
  for (int number = 1; number <= 12; ++number) record_version(file, {number, 1, number <= 6 ? 8 : 5});
  const auto series = trend("success");
  ASSERT_EQ(series[0].changes.size(), 1U);
  const TrendChange& change = series[0].changes[0];
  EXPECT_EQ(series[0].points[change.position].commit, test::hash_of(7));
  EXPECT_DOUBLE_EQ(change.before, 0.8);
  EXPECT_DOUBLE_EQ(change.after, 0.5);
  EXPECT_NEAR(effect_of(change, *find_trend_metric("success")), -0.3, 1e-12);
}

TEST_F(Trends, a_change_that_is_too_small_is_not_marked) {
  for (int number = 1; number <= 16; ++number) record_version(file, {number, number <= 8 ? 1 : 1.03, 8});
  EXPECT_TRUE(trend("runtime")[0].changes.empty()) << "3 % of a wall clock";
  EXPECT_EQ(trend("flowtime")[0].changes.size(), 1U) << "3 % of what has no noise";
}

TEST_F(Trends, times_of_two_machines_are_two_series_and_costs_are_one) {
  record_version(file, {1, 1, 8});
  record_version(file, {2, 9, 8, false, "slow"});
  EXPECT_EQ(trend("runtime").size(), 2U);
  EXPECT_EQ(trend("success").size(), 1U);
}

TEST_F(Trends, sets_of_instances_are_not_compared_with_each_other) {
  for (int number = 1; number <= 6; ++number) record_version(file, {number, 1, 8});
  for (int number = 7; number <= 12; ++number) record_version(file, {number, 2, 12, false, "host", 30});
  const auto series = trend("flowtime");
  ASSERT_EQ(series.size(), 2U);
  EXPECT_EQ(series[0].instances, "10 instances");
  EXPECT_EQ(series[1].instances, "30 instances");
  EXPECT_EQ(series[1].points.size(), 6U);
  for (const TrendSeries& one : series) EXPECT_TRUE(one.changes.empty());
  EXPECT_EQ(series[0].case_id, series[1].case_id);
}

TEST_F(Trends, plans_are_compared_where_all_versions_solve) {
  // Flowtimes rise from instance to instance, and the second half of the versions fails on the last two.
  for (int number = 1; number <= 12; ++number) {
    const std::string uuid = record_version(file, {number, 1, number <= 6 ? 8 : 6});
    test::ask(
        file,
        "UPDATE result SET flowtime_s = 100 * instance_id WHERE status = 0 AND cell_id = (SELECT cell.id "
        "FROM cell JOIN run ON run.id = run_id WHERE uuid = '" +
            uuid + "') RETURNING 1");
  }
  auto series = trend("flowtime");
  ASSERT_EQ(series.size(), 1U);
  ASSERT_EQ(series[0].points.size(), 12U);
  for (const TrendPoint& point : series[0].points) EXPECT_DOUBLE_EQ(point.value, 350) << point.subject;
  EXPECT_TRUE(series[0].changes.empty()) << "to fail on what is hard is no shorter plan";
  EXPECT_EQ(series[0].plannings, 10);
  EXPECT_EQ(series[0].solved_by_all, 6);
  EXPECT_DOUBLE_EQ(series[0].points.front().solved_share.value_or(0), 0.8);
  EXPECT_DOUBLE_EQ(series[0].points.back().solved_share.value_or(0), 0.6);
  EXPECT_FALSE(trend("success")[0].points[0].solved_share);
  EXPECT_EQ(trend("success")[0].changes.size(), 1U);
}

TEST_F(Trends, a_version_that_solved_next_to_nothing_is_left_out) {
  for (int number = 1; number <= 8; ++number) record_version(file, {number, 1, number == 5 ? 3 : 8});
  const auto series = trend("flowtime");
  ASSERT_EQ(series.size(), 1U);
  EXPECT_EQ(series[0].points.size(), 7U);
  EXPECT_EQ(series[0].solved_by_all, 8);
  EXPECT_EQ(trend("success")[0].points.size(), 8U);
}

TEST_F(Trends, versions_that_solved_other_plannings_are_not_compared) {
  for (int number = 1; number <= 12; ++number) {
    const std::string uuid = record_version(file, {number, number <= 6 ? 1.0 : 0.5, 4});
    if (number <= 6) continue;
    // The others of the same instances.
    test::ask(
        file,
        "UPDATE result SET instance_id = 11 - instance_id, position = 100 + position WHERE cell_id = (SELECT "
        "cell.id FROM cell JOIN run ON run.id = run_id WHERE uuid = '" +
            uuid + "') RETURNING 1");
  }
  const auto series = trend("flowtime");
  ASSERT_EQ(series.size(), 1U);
  EXPECT_EQ(series[0].solved_by_all, 0);
  EXPECT_FALSE(series[0].is_comparable());
  EXPECT_DOUBLE_EQ(series[0].points.back().value, 500) << "of what it solved";
  EXPECT_TRUE(series[0].changes.empty());
}

TEST_F(Trends, of_one_set_nothing_is_said) {
  record_version(file, {1, 1, 8});
  EXPECT_EQ(trend("success")[0].instances, "");
}

TEST_F(Trends, planners_are_told_apart) {
  record_version(file, {1, 1, 8, false, "host", 10, "sipplab weight:1.5"});
  record_version(file, {1, 1, 8, false, "host", 10, "cmd:mine"});
  record_version(file, {1, 1, 8, false, "host", 10, "sipplab method:complete"});
  const auto series = trend("success");
  ASSERT_EQ(series.size(), 3U);
  std::string labels;
  for (const TrendSeries& one : series) labels += one.label + "\n";
  for (const char* ending : {", sipplab weight:1.5\n", ", cmd:mine\n", ", sipplab method:complete\n"}) {
    EXPECT_NE(labels.find(ending), std::string::npos) << labels;
  }
  CaseFilter filter;
  filter.planner = "cmd:mine";
  EXPECT_EQ(trend("success", filter).size(), 1U);
}

TEST_F(Trends, cases_that_differ_in_limits_alone_are_named_apart) {
  for (const double limit_s : {300.0, 60.0, kNoTimeLimit}) {
    record_version(file, {1, 1, 8, false, "host", 10, "sipplab", limit_s}, 64);
  }
  record_version(file, {1, 1, 8}, 128);
  const auto series = trend("success");
  ASSERT_EQ(series.size(), 4U);
  std::string labels;
  for (const TrendSeries& one : series) labels += one.label + "\n";
  for (const char* ending :
       {"sipplab, at most 300 s\n", ", at most 60 s\n", ", no time limit\n", "128 robots, "}) {
    EXPECT_NE(labels.find(ending), std::string::npos) << labels;
  }
  EXPECT_EQ(series.back().label.find("300 s"), std::string::npos) << "one of its kind: " << labels;
}

TEST_F(Trends, cases_are_filtered_by_what_they_are) {
  record_version(file, {1, 1, 8}, 64);
  record_version(file, {1, 1, 8}, 128);
  EXPECT_EQ(trend("success").size(), 2U);
  CaseFilter filter;
  filter.robots = 128;
  filter.environment = "warehouse";
  filter.options["ssi_s"] = 5.0;
  const auto series = trend("success", filter);
  ASSERT_EQ(series.size(), 1U);
  EXPECT_NE(series[0].label.find("128 robots, ssi 5"), std::string::npos) << series[0].label;
  filter.options["reschedule"] = "none";
  EXPECT_TRUE(trend("success", filter).empty());
}

TEST_F(Trends, every_metric_can_be_asked) {
  record_version(file, {1, 1, 8});
  for (const TrendMetric& metric : trend_metrics()) {
    EXPECT_LE(trend(std::string(metric.name)).size(), 1U) << metric.name;
  }
}

// The view is what users of SQL ask, the table is what `sipplab trend` asks.
TEST_F(Trends, the_view_has_the_metrics_of_cases_and_their_values) {
  record_version(file, {1, 1, 8});
  std::set<std::string> names;
  for (const TrendMetric& metric : trend_metrics()) {
    if (!metric.of_case) continue;
    const std::string name(metric.name);
    names.insert(name);
    EXPECT_EQ(test::ask(file, "SELECT (SELECT value FROM v_trends WHERE metric = '" + name +
                                  "') IS (SELECT " + metric.sql + " FROM cell_summary)"),
              "1")
        << name;
  }
  std::string expected;
  for (const std::string& name : names) expected += expected.empty() ? name : ' ' + name;
  EXPECT_EQ(
      test::ask(file, "SELECT group_concat(metric, ' ') FROM (SELECT metric FROM v_trends ORDER BY metric)"),
      expected);
}

}  // namespace
}  // namespace sipplab::db
