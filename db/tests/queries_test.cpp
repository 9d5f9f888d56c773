// Views and reports, against numbers worked out by hand.
#include "db/queries.hpp"

#include <nlohmann/json.hpp>

#include "db/tests/support.hpp"

namespace sipplab::db {
namespace {

using test::ask;
using test::must;
using test::sample_case;
using test::sample_instance;

class Queries : public test::DatabaseTest {
 protected:
  /// One case; instance i has makespan `makespans[i]`, or failed if it is 0.
  std::string record(const std::vector<double>& makespans, const std::string& suite = "smoke") {
    auto recorder = must(RunRecorder::begin(must(Database::open(file)), test::sample_run(suite)));
    for (std::size_t i = 0; i < makespans.size(); ++i) {
      const int index = static_cast<int>(i);
      ResultRow row = makespans[i] > 0 ? test::sample_result(index) : test::failed_result();
      if (makespans[i] > 0) {
        row.makespan_s = makespans[i];
        row.flowtime_s = 10 * makespans[i];
        row.planning_time_ns = static_cast<std::int64_t>(makespans[i] * 1e9);
      }
      recorder.add(sample_case(64), sample_instance(index), row);
    }
    must(recorder.commit());
    must(recorder.finish(RunStatus::kFinished));
    return recorder.run_uuid();
  }
  CellSummary only_cell(const std::string& uuid) {
    auto database = must(Database::open_read_only(file));
    const RunReport report = must(show_run(database, uuid));
    EXPECT_EQ(report.cells.size(), 1U);
    return report.cells.front();
  }
};

TEST_F(Queries, means_and_medians_of_a_cell) {
  const CellSummary odd = only_cell(record({3, 0, 1, 8}));
  EXPECT_EQ(odd.results, 4);
  EXPECT_EQ(odd.solved, 3);
  EXPECT_EQ(odd.success_rate, 0.75);
  EXPECT_EQ(odd.mean_makespan_s, 4);
  EXPECT_EQ(odd.median_makespan_s, 3);
  EXPECT_EQ(odd.mean_flowtime_s, 40);
  EXPECT_EQ(odd.median_flowtime_s, 30);
  // Failed instances took time, too: 7 ns, 1, 3 and 8 s.
  EXPECT_EQ(odd.median_planning_time_s, 2);
  EXPECT_DOUBLE_EQ(*odd.mean_planning_time_s, (12 + 7e-9) / 4);
  EXPECT_EQ(odd.mean_tries, (2 + 1 + 2 + 2) / 4.0);
  const CellSummary even = only_cell(record({3, 1, 8, 6}));
  EXPECT_EQ(even.median_makespan_s, 4.5);
  const CellSummary single = only_cell(record({3}));
  EXPECT_EQ(single.median_makespan_s, 3);
}

TEST_F(Queries, nothing_solved_has_no_makespan) {
  const CellSummary none = only_cell(record({0, 0}));
  EXPECT_EQ(none.success_rate, 0);
  EXPECT_FALSE(none.mean_makespan_s);
  EXPECT_FALSE(none.median_makespan_s);
  auto database = must(Database::open_read_only(file));
  EXPECT_TRUE(must(show_run(database, record({}))).cells.empty());
}

TEST_F(Queries, slowest_results_come_first) {
  record({3, 1, 8, 6});
  EXPECT_EQ(ask(file, "SELECT group_concat(planning_time_s) FROM (SELECT * FROM v_slowest LIMIT 3)"),
            "8.0,6.0,3.0");
}

TEST_F(Queries, flips_between_two_runs) {
  const std::string base = record({3, 0, 1, 0});
  const std::string head = record({3, 5, 0, 0});
  const std::string where = " FROM v_flips WHERE base_run = '" + base + "' AND head_run = '" + head + "'";
  EXPECT_EQ(ask(file,
                "SELECT group_concat(direction || ' ' || instance_hash || ' ' || base_status || ' ' || "
                "head_status)" +
                    where),
            "gained 0000000000000002 failed solved,lost 0000000000000003 solved failed");
  EXPECT_EQ(ask(file, "SELECT count(*) FROM v_flips WHERE base_run = head_run"), "0");
}

TEST_F(Queries, views_for_one_run_or_case_use_indexes) {
  const std::string uuid = record({3, 0, 1, 8});
  for (const std::string view : {"v_runs", "v_run_cells", "v_results", "v_slowest"}) {
    const Table plan =
        must(run_sql(file, "EXPLAIN QUERY PLAN SELECT * FROM " + view + " WHERE run = '" + uuid + "'"));
    for (const auto& row : plan.rows) {
      const auto& detail = std::get<std::string>(row.back());
      EXPECT_EQ(detail.find("SCAN result"), std::string::npos) << view << ": " << detail;
      EXPECT_EQ(detail.find("SCAN cell"), std::string::npos) << view << ": " << detail;
    }
  }
  for (const std::string& sql :
       {std::string{"SELECT mean_makespan_s FROM v_run_cells WHERE case_id = 1"},
        std::string{"SELECT count(*) FROM v_results WHERE case_id = 1"},
        "SELECT * FROM v_flips WHERE base_run = '" + uuid + "' AND head_run = '" + uuid + "'"}) {
    const Table plan = must(run_sql(file, "EXPLAIN QUERY PLAN " + sql));
    for (const auto& row : plan.rows) {
      const auto& detail = std::get<std::string>(row.back());
      EXPECT_EQ(detail.find("SCAN result"), std::string::npos) << sql << ": " << detail;
      EXPECT_EQ(detail.find("SCAN cell"), std::string::npos) << sql << ": " << detail;
    }
  }
}

TEST_F(Queries, runs_are_listed_newest_first) {
  const std::string first = record({3}, "smoke");
  const std::string second = record({0, 1}, "density");
  auto database = must(Database::open(file));
  const auto runs = must(list_runs(database));
  ASSERT_EQ(runs.size(), 2U);
  EXPECT_EQ(runs[0].uuid, second);
  EXPECT_EQ(runs[0].cases, 1);
  EXPECT_EQ(runs[0].results, 2);
  EXPECT_EQ(runs[0].solved, 1);
  EXPECT_EQ(runs[0].compiler, "gcc 12.2.0");
  EXPECT_EQ(runs[1].uuid, first);
  RunFilter filter;
  filter.limit = 1;
  EXPECT_EQ(must(list_runs(database, filter)).size(), 1U);
  filter.limit = 0;
  filter.suite = "smoke";
  EXPECT_EQ(must(list_runs(database, filter)).at(0).uuid, first);
}

TEST_F(Queries, excluded_runs_are_kept_and_not_listed) {
  const std::string uuid = record({3});
  auto database = must(Database::open(file));
  EXPECT_FALSE(exclude_run(database, uuid, ""));
  must(exclude_run(database, uuid, "machine was busy"));
  EXPECT_TRUE(must(list_runs(database)).empty());
  EXPECT_FALSE(resolve_run(database, "latest"));
  RunFilter all;
  all.include_excluded = true;
  EXPECT_EQ(must(list_runs(database, all)).at(0).excluded_reason, "machine was busy");
  must(include_run(database, uuid));
  EXPECT_EQ(must(list_runs(database)).size(), 1U);
}

TEST_F(Queries, a_run_is_named_by_latest_or_by_the_beginning_of_its_uuid) {
  const std::string first = record({3});
  const std::string second = record({3});
  auto database = must(Database::open(file));
  EXPECT_EQ(must(resolve_run(database, "latest")), second);
  EXPECT_EQ(must(resolve_run(database, first)), first);
  EXPECT_EQ(must(resolve_run(database, first.substr(0, 8))), first);
  const auto kind = [&](const char* text) { return resolve_run(database, text).error().kind; };
  EXPECT_EQ(kind("abc"), ErrorKind::kBadInput);
  EXPECT_EQ(kind("%%%%"), ErrorKind::kBadInput);
  EXPECT_EQ(kind("________"), ErrorKind::kBadInput);
  EXPECT_EQ(kind("00000000-0000"), ErrorKind::kNotFound);
  ask(file, "UPDATE run SET uuid = 'aaaa' || substr(uuid, 5) RETURNING 1");
  EXPECT_EQ(kind("aaaa"), ErrorKind::kBadInput);
}

TEST_F(Queries, an_empty_history_has_no_latest_run) {
  auto database = must(Database::open(file));
  EXPECT_TRUE(must(list_runs(database)).empty());
  const auto result = show_run(database, "latest");
  ASSERT_FALSE(result);
  EXPECT_NE(result.error().message.find("no run yet"), std::string::npos);
}

TEST_F(Queries, reports_as_text) {
  const std::string uuid = record({3, 0, 1, 8});
  auto database = must(Database::open(file));
  const RunReport report = must(show_run(database, "latest"));
  const std::string text = format_run_report(report, OutputFormat::kTable);
  EXPECT_NE(text.find("run       " + uuid), std::string::npos) << text;
  EXPECT_NE(text.find("commit    0123456789abcdef0123456789abcdef01234567 Close the interval (main)"),
            std::string::npos)
      << text;
  EXPECT_NE(text.find("64     3/4     0.75       5.50 s  153.00 s      4.00     40.00    1.8        3750\n"),
            std::string::npos)
      << text;

  EXPECT_NE(text.find("makespan, flowtime: means over what this run solved"), std::string::npos) << text;
  const auto json = nlohmann::json::parse(format_run_report(report, OutputFormat::kJson));
  EXPECT_EQ(json["run"]["run"], uuid);
  EXPECT_EQ(json["cells"][0]["median_makespan_s"], 3.0);
  const std::string csv = format_run_report(report, OutputFormat::kCsv);
  EXPECT_EQ(csv.find("environment,robots,ssi_s,"), 0U);

  const std::string list = format_runs(must(list_runs(database)), OutputFormat::kTable);
  EXPECT_NE(list.find(uuid.substr(0, 8) + "  20"), std::string::npos) << list;
  EXPECT_EQ(format_runs({}, OutputFormat::kTable), "no runs\n");
  EXPECT_EQ(format_runs({}, OutputFormat::kJson), "[]\n");
}

}  // namespace
}  // namespace sipplab::db
