// Property runs: what is written is what is read; the newest counts.
#include "db/property_runs.hpp"

#include <nlohmann/json.hpp>

#include "db/queries.hpp"
#include "db/tests/support.hpp"

namespace sipplab::db {
namespace {

using test::ask;
using test::must;

PropertyRun passed_run(int number, const std::string& title = "cells are square") {
  PropertyRun run;
  run.uuid = "00000000-0000-4000-8000-" + std::to_string(100000000000 + number);
  run.started_utc = "2026-01-31T12:00:0" + std::to_string(number) + ".000Z";
  run.room = "grid";
  run.title = title;
  run.seed = UINT64_MAX;
  run.max_success = 100;
  run.status = "passed";
  run.cases = 100;
  run.discards = 3;
  run.wall_time_ns = 1'234'567'891;
  run.classes = {{"dense", 40}, {"mixed", 100}};
  return run;
}

PropertyRun failed_run(int number, const std::string& title = "cells are square") {
  PropertyRun run = passed_run(number, title);
  run.status = "failed";
  run.shrinks = 4;
  run.shrink_tries = 9;
  run.message = "grid.cpp:7: no";
  run.reproduce = "reproduce=AbC";
  run.counterexample = "int:\n7\n";
  run.plan_case = "..\nrobot 0 0 to 1 0\n";
  run.case_robots = 1;
  run.case_cells = 2;
  return run;
}

class PropertyRuns : public test::DatabaseTest {
 protected:
  PropertyRecorded record(const std::vector<PropertyRun>& runs, const std::string& mutant = "") {
    auto database = must(Database::open(file));
    return must(record_property_runs(database, test::sample_run(), runs, mutant));
  }
  Table list(const PropertyFilter& filter) {
    auto database = must(Database::open_read_only(file));
    return must(list_property_runs(database, filter));
  }
};

TEST_F(PropertyRuns, what_is_written_is_what_is_read) {
  const PropertyRun run = failed_run(1);
  EXPECT_EQ(record({run}, "gap_closed").added, 1U);
  auto database = must(Database::open_read_only(file));
  EXPECT_EQ(std::get<std::string>(list({std::nullopt, false, true, 0}).rows.at(0)[10]),
            std::to_string(run.seed))
      << "without a sign";
  const PropertyReport report = must(show_property_run(database, 1));
  const PropertyRun& read = report.run;
  EXPECT_EQ(read.uuid, run.uuid);
  EXPECT_EQ(read.started_utc, run.started_utc);
  EXPECT_EQ(read.room, run.room);
  EXPECT_EQ(read.title, run.title);
  EXPECT_EQ(read.seed, run.seed);
  EXPECT_EQ(read.max_success, run.max_success);
  EXPECT_EQ(read.status, run.status);
  EXPECT_EQ(read.cases, run.cases);
  EXPECT_EQ(read.discards, run.discards);
  EXPECT_EQ(read.shrinks, run.shrinks);
  EXPECT_EQ(read.shrink_tries, run.shrink_tries);
  EXPECT_EQ(read.wall_time_ns, run.wall_time_ns);
  EXPECT_EQ(read.classes, run.classes);
  EXPECT_EQ(read.message, run.message);
  EXPECT_EQ(read.reproduce, run.reproduce);
  EXPECT_EQ(read.counterexample, run.counterexample);
  EXPECT_EQ(read.plan_case, run.plan_case);
  EXPECT_EQ(read.case_robots, run.case_robots);
  EXPECT_EQ(read.case_cells, run.case_cells);
  EXPECT_EQ(report.mutant, "gap_closed");
  EXPECT_EQ(report.commit_hash, test::sample_run().commit->hash);
  EXPECT_EQ(report.compiler, "gcc 12.2.0");
  test::expect_sound(file);
}

TEST_F(PropertyRuns, a_log_that_is_recorded_twice_is_stored_once) {
  record({passed_run(1), passed_run(2)});
  const PropertyRecorded again = record({passed_run(2), passed_run(3)});
  EXPECT_EQ(again.added, 1U);
  EXPECT_EQ(again.known, 1U);
  EXPECT_EQ(ask(file, "SELECT count(*) FROM property_run"), "3");
  EXPECT_EQ(ask(file, "SELECT count(*) FROM property_class"), "6");
}

TEST_F(PropertyRuns, what_seemed_to_have_crashed_is_replaced_by_its_end) {
  PropertyRun crashed = passed_run(1);
  crashed.status = "crashed";
  crashed.message = "ended early";
  crashed.cases = 0;
  crashed.classes.clear();
  record({crashed});
  EXPECT_EQ(record({crashed}).known, 1U);
  EXPECT_EQ(record({passed_run(1)}).added, 1U);
  EXPECT_EQ(record({crashed}).known, 1U);
  EXPECT_EQ(ask(file, "SELECT status || cases FROM v_property_runs"), "passed100");
  EXPECT_EQ(ask(file, "SELECT count(*) FROM property_class"), "2");
  test::expect_sound(file);
}

TEST_F(PropertyRuns, a_log_with_one_wrong_run_changes_nothing) {
  PropertyRun wrong = passed_run(2);
  wrong.status = "fine";
  auto database = must(Database::open(file));
  EXPECT_FALSE(record_property_runs(database, test::sample_run(), {passed_run(1), wrong}));
  EXPECT_EQ(ask(file, "SELECT count(*) FROM property_run"), "0");
  EXPECT_EQ(ask(file, "SELECT count(*) FROM machine"), "0");
}

TEST_F(PropertyRuns, the_newest_run_stands_for_its_property) {
  record({failed_run(1), passed_run(3), passed_run(2, "discs are round")});
  record({failed_run(5)}, "gap_closed");
  const Table newest = list({});
  ASSERT_EQ(newest.rows.size(), 2U);
  EXPECT_EQ(newest.rows[0][3], Value{std::string{"cells are square"}});
  EXPECT_EQ(newest.rows[0][5], Value{std::string{"passed"}});
  EXPECT_EQ(newest.rows[1][3], Value{std::string{"discs are round"}});
  PropertyFilter all;
  all.every_run = true;
  EXPECT_EQ(list(all).rows.size(), 4U);
  EXPECT_EQ(list(all).rows[0][4], Value{std::string{"gap_closed"}});
  all.failed = true;
  EXPECT_EQ(list(all).rows.size(), 2U);
  all.limit = 1;
  EXPECT_EQ(list(all).rows.size(), 1U);
  PropertyFilter elsewhere;
  elsewhere.room = "attic";
  EXPECT_TRUE(list(elsewhere).rows.empty());
}

TEST_F(PropertyRuns, the_latest_failure_is_none_of_a_planted_bug) {
  record({passed_run(1)});
  auto database = must(Database::open(file));
  EXPECT_FALSE(latest_property_failure(database));
  record({failed_run(2)});
  record({failed_run(3)}, "gap_closed");
  EXPECT_EQ(must(latest_property_failure(database)), 2);
  const auto missing = show_property_run(database, 77);
  ASSERT_FALSE(missing);
  EXPECT_NE(missing.error().message.find("no property run 77"), std::string::npos);
}

TEST_F(PropertyRuns, an_excluded_run_counts_nowhere) {
  record({passed_run(1), failed_run(2)});
  auto database = must(Database::open(file));
  must(exclude_run(database, failed_run(2).uuid, "the disk was full"));
  EXPECT_EQ(list({}).rows.at(0)[5], Value{std::string{"passed"}});
  EXPECT_FALSE(latest_property_failure(database));
  EXPECT_EQ(ask(file, "SELECT runs || failed FROM v_property_totals"), "10");
}

TEST_F(PropertyRuns, classes_and_totals_are_views) {
  record({passed_run(1), failed_run(2)});
  EXPECT_EQ(ask(file, "SELECT share FROM v_property_classes WHERE id = 1 AND class = 'dense'"), "0.4");
  EXPECT_EQ(ask(file, "SELECT runs || ' ' || cases || ' ' || failed FROM v_property_totals"), "2 200 1");
}

TEST_F(PropertyRuns, a_report_is_text_or_json) {
  record({failed_run(1)});
  auto database = must(Database::open_read_only(file));
  const PropertyReport report = must(show_property_run(database, 1));
  const std::string text = format_property_report(report, OutputFormat::kTable);
  for (const char* words : {"cells are square", "failed, 100 cases of 100", "40.0 %  dense", "grid.cpp:7: no",
                            "4 steps of 9", "  robot 0 0 to 1 0", "1 robots, 2 cells"}) {
    EXPECT_NE(text.find(words), std::string::npos) << words << " in\n" << text;
  }
  const auto json = nlohmann::json::parse(format_property_report(report, OutputFormat::kJson));
  EXPECT_EQ(json["plan_case"], "..\nrobot 0 0 to 1 0\n");
  EXPECT_EQ(json["classes"]["dense"], 40);
  EXPECT_EQ(json["seed"], UINT64_MAX);
}

}  // namespace
}  // namespace sipplab::db
