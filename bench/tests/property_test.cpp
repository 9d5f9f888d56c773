// Logs of property runs, and counterexamples again: what `sipplab property` stands on.
#include <gtest/gtest.h>

#include <string>

#include "bench/campaigns/property_log.hpp"
#include "bench/campaigns/replay.hpp"
#include "planner/io/case_codec.hpp"

namespace sipplab::bench {
namespace {

const std::string kPassed =
    R"({"uuid":"00000000-0000-4000-8000-000000000001","started_utc":"2026-01-31T12:00:00.000Z","room":"grid",)"
    R"("title":"cells are square","seed":18446744073709551615,"max_success":100,"status":"passed","cases":100,)"
    R"("discards":3,"shrinks":0,"shrink_tries":0,"wall_time_ns":2000000000,"classes":{"dense":40,"empty":1},)"
    R"("message":"","reproduce":"","counterexample":"","plan_case":""})";
const std::string kFailed =
    R"({"uuid":"00000000-0000-4000-8000-000000000002","started_utc":"2026-01-31T12:00:01.000Z","room":"plan",)"
    R"("title":"robots are polite","seed":7,"max_success":100,"status":"failed","cases":5,"discards":0,)"
    R"("shrinks":4,"shrink_tries":9,"wall_time_ns":500000000,"classes":{},"message":"f.cpp:1: no",)"
    R"("reproduce":"reproduce=AbC","counterexample":"int:\n7\n","plan_case":"..\n","case_robots":1,"case_cells":2})";

std::string replaced(std::string line, const std::string& from, const std::string& to) {
  const std::size_t at = line.find(from);
  EXPECT_NE(at, std::string::npos) << from;
  return line.replace(at, from.size(), to);
}

void expect_refused(const std::string& text, const std::string& words) {
  const auto runs = parse_property_log(text, "x.log");
  ASSERT_FALSE(runs) << text;
  EXPECT_NE(runs.error().find(words), std::string::npos) << runs.error();
}

TEST(PropertyLog, EveryFieldIsRead) {
  const auto runs = parse_property_log(kPassed + "\n\n" + kFailed + "\n", "x.log");
  ASSERT_TRUE(runs) << runs.error();
  ASSERT_EQ(runs->size(), 2u);
  const db::PropertyRun& passed = runs->front();
  EXPECT_EQ(passed.uuid, "00000000-0000-4000-8000-000000000001");
  EXPECT_EQ(passed.started_utc, "2026-01-31T12:00:00.000Z");
  EXPECT_EQ(passed.room, "grid");
  EXPECT_EQ(passed.title, "cells are square");
  EXPECT_EQ(passed.seed, UINT64_MAX);
  EXPECT_EQ(passed.max_success, 100);
  EXPECT_EQ(passed.discards, 3);
  EXPECT_EQ(passed.classes, (std::map<std::string, std::int64_t>{{"dense", 40}, {"empty", 1}}));
  EXPECT_FALSE(passed.case_robots);
  const db::PropertyRun& failed = runs->back();
  EXPECT_EQ(failed.status, "failed");
  EXPECT_EQ(failed.shrinks, 4);
  EXPECT_EQ(failed.shrink_tries, 9);
  EXPECT_EQ(failed.message, "f.cpp:1: no");
  EXPECT_EQ(failed.reproduce, "reproduce=AbC");
  EXPECT_EQ(failed.counterexample, "int:\n7\n");
  EXPECT_EQ(failed.plan_case, "..\n");
  EXPECT_EQ(failed.case_robots, 1);
  EXPECT_EQ(failed.case_cells, 2);
}

TEST(PropertyLog, ABeginningWithoutAnEndIsACrash) {
  const std::string begun = replaced(kPassed, "\"status\":\"passed\"", "\"status\":\"started\"");
  const auto crashed = parse_property_log(begun + "\n" + kFailed, "x.log");
  ASSERT_TRUE(crashed) << crashed.error();
  ASSERT_EQ(crashed->size(), 2u);
  EXPECT_EQ(crashed->front().status, "crashed");
  EXPECT_NE(crashed->front().message.find("properties grid"), std::string::npos) << crashed->front().message;
  EXPECT_EQ(totals_of(*crashed).crashed, 1u);
  const auto ended = parse_property_log(begun + "\n" + kPassed, "x.log");
  ASSERT_TRUE(ended) << ended.error();
  ASSERT_EQ(ended->size(), 1u);
  EXPECT_EQ(ended->front().status, "passed");
}

TEST(PropertyLog, TotalsAreSums) {
  const auto runs = parse_property_log(kPassed + "\n" + kFailed, "x.log");
  ASSERT_TRUE(runs) << runs.error();
  const PropertyTotals totals = totals_of(*runs);
  EXPECT_EQ(totals.runs, 2u);
  EXPECT_EQ(totals.cases, 105);
  EXPECT_EQ(totals.discards, 3);
  EXPECT_EQ(totals.failed, 1u);
  EXPECT_EQ(totals.gave_up, 0u);
  EXPECT_DOUBLE_EQ(totals.wall_time_s, 2.5);
}

TEST(PropertyLog, WhatTheHistoryWouldRefuseIsRefusedWithItsLine) {
  expect_refused("", "x.log: no property run");
  expect_refused(kPassed + "\n" + kFailed.substr(0, 200), "x.log:2: not a property run");
  expect_refused("[]\n", "x.log:1: not a property run");
  expect_refused(replaced(kPassed, "\"cases\":100", "\"cases\":-1"), "x.log:1: \"cases\"");
  expect_refused(replaced(kPassed, "\"cases\":100", "\"cases\":1.5"), "\"cases\"");
  expect_refused(replaced(kPassed, "\"cases\":100,", ""), "\"cases\" is missing");
  expect_refused(replaced(kPassed, "\"seed\":18446744073709551615", "\"seed\":18446744073709551616"),
                 "\"seed\"");
  expect_refused(replaced(kPassed, "-0000-4000-", "-"), "\"uuid\"");
  expect_refused(replaced(kPassed, "cells are square", ""), "\"title\"");
  expect_refused(replaced(kPassed, "\"status\":\"passed\"", "\"status\":\"fine\""), "\"status\"");
  expect_refused(replaced(kPassed, "\"dense\":40", "\"dense\":0"), "\"classes\"");
  expect_refused(replaced(kFailed, "\"shrinks\":4", "\"shrinks\":10"), "\"shrinks\"");
  expect_refused(replaced(kFailed, "f.cpp:1: no", ""), "\"message\"");
  expect_refused(replaced(kFailed, "reproduce=AbC", ""), "\"reproduce\"");
}

PlanCase corridor_case() {
  auto plan_case = decode_case(
      ".....\n"
      "robot 0 0 to 2 0\n"
      "robot 3 0 to 4 0\n"
      "order fifo\n"
      "ssi 1\n");
  EXPECT_TRUE(plan_case.has_value());
  return *plan_case;
}

PlanResult right_plan(const Instance& instance, const PlannerOptions& options) {
  return plan(instance, options);
}

/// Leaves out the last motion of the first robot that moves.
PlanResult stops_short(const Instance& instance, const PlannerOptions& options) {
  PlanResult result = plan(instance, options);
  for (Trajectory& trajectory : result.solution.trajectories) {
    if (trajectory.motions.empty()) continue;
    trajectory.motions.pop_back();
    break;
  }
  return result;
}

/// Plans as if no start were protected.
PlanResult ignores_starts(const Instance& instance, const PlannerOptions& options) {
  PlannerOptions without = options;
  without.ssi_s = 0;
  return plan(instance, without);
}

TEST(ReplayCase, AValidPlanHolds) {
  const CaseVerdict verdict = replay_case(corridor_case(), right_plan);
  EXPECT_TRUE(verdict.holds) << verdict.text;
  EXPECT_EQ(verdict.text, "the plan is valid");
}

TEST(ReplayCase, AWrongPlanDoesNot) {
  const CaseVerdict verdict = replay_case(corridor_case(), stops_short);
  EXPECT_FALSE(verdict.holds);
  EXPECT_EQ(verdict.text.rfind("invalid: ", 0), 0u) << verdict.text;
}

TEST(ReplayCase, TheStartSafeIntervalIsChecked) {
  // Robot 0 crosses the start of robot 1, which leaves at once.
  auto plan_case = decode_case(
      ".....\n"
      "@@@.@\n"
      "robot 0 0 to 4 0\n"
      "robot 3 0 to 3 1\n"
      "order fifo\nreschedule none\nssi 20\n");
  ASSERT_TRUE(plan_case.has_value());
  EXPECT_TRUE(replay_case(*plan_case, right_plan).holds);
  const CaseVerdict verdict = replay_case(*plan_case, ignores_starts);
  ASSERT_EQ(verdict.result.status, PlanStatus::kSolved);
  EXPECT_FALSE(verdict.holds) << verdict.text;
}

TEST(ReplayCase, WithoutAPlanThereIsNothingToBeWrong) {
  PlanCase plan_case = corridor_case();
  plan_case.options.max_expansions = 0;
  plan_case.instance.agents[0].goal = {4, 0};
  plan_case.instance.agents[1].goal = {0, 0};
  const CaseVerdict verdict = replay_case(plan_case, right_plan);
  EXPECT_TRUE(verdict.holds) << verdict.text;
  EXPECT_EQ(verdict.text.rfind("no plan", 0), 0u) << verdict.text;
}

TEST(ReplayCase, ACaseAgainstTheRulesIsNotPlanned) {
  PlanCase plan_case = corridor_case();
  plan_case.instance.agents[1].start = plan_case.instance.agents[0].start;
  bool planned = false;
  const CaseVerdict verdict =
      replay_case(plan_case, [&](const Instance& instance, const PlannerOptions& options) {
        planned = true;
        return plan(instance, options);
      });
  EXPECT_FALSE(verdict.holds);
  EXPECT_FALSE(planned);
}

TEST(ReplayProgram, TheExitCodeIsTheVerdictAndTheParametersAreSet) {
  EXPECT_EQ(replay_program("/bin/true", "room", "reproduce=x"), ProgramVerdict::kHolds);
  EXPECT_EQ(replay_program("/bin/false", "room", "reproduce=x"), ProgramVerdict::kFails);
  EXPECT_EQ(replay_program("no/such/program", "room", "reproduce=x"), ProgramVerdict::kNotRun);
  EXPECT_EQ(replay_command("folder/program", "room", "reproduce=x"),
            "RC_PARAMS=\"reproduce=x\" folder/program room");
}

}  // namespace
}  // namespace sipplab::bench
