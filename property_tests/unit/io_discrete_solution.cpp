// Plans in discrete time, as other programs write them: one plan in all formats, and what disagrees with it.
#include <gtest/gtest.h>

#include <string>
#include <string_view>
#include <vector>

#include "planner/io/foreign_instance.hpp"
#include "planner/io/step_plan.hpp"
#include "planner/io/text_file.hpp"
#include "planner/io/tracker.hpp"
#include "planner/retime/retime.hpp"
#include "planner/retime/steps.hpp"
#include "sipplab/solution_io.hpp"
#include "sipplab/validator.hpp"

namespace sipplab {
namespace {

/// The one that the files in fuzz/corpus are for.
Instance corpus_instance() {
  Instance instance;
  instance.map = GridMap(6, 4);
  instance.map.set_blocked({2, 1}, true);
  instance.agents = {{"0", {0, 0}, {5, 0}, 0.5, 1, 0, std::nullopt, 1},
                     {"a,\"b\"", {0, 3}, {4, 2}, 0.5, 2, 0, std::nullopt, 1},
                     {"<&>", {5, 3}, {5, 3}, 0.25, 1, 0, std::nullopt, 1}};
  return instance;
}

std::string corpus_text(const std::string& name) {
  const auto text =
      read_text(std::string(SIPPLAB_SOURCE_DIR) + "/fuzz/corpus/parse_solution_never_crashes/" + name);
  EXPECT_TRUE(text) << name;
  return text ? *text : std::string();
}

SolutionDocument read(const std::string& text, std::string_view format = {}) {
  const auto document = parse_solution(text, "s", corpus_instance(), format);
  EXPECT_TRUE(document) << document.error().message();
  return document ? *document : SolutionDocument{};
}

std::string refusal(const std::string& text, std::string_view format = {}) {
  const auto document = parse_solution(text, "s", corpus_instance(), format);
  return document ? "no error" : document.error().message();
}

double reported(const SolutionDocument& document, std::string_view name) {
  for (const auto& [known, value] : document.reported) {
    if (known == name) return value;
  }
  return -1;
}

TEST(IoDiscreteSolution, OnePlanIsTheSameInAllFormats) {
  const Solution plan = read(corpus_text("lacam.txt")).solution;
  ASSERT_EQ(plan.trajectories.size(), 3U);
  EXPECT_EQ(plan.trajectories[0].motions.size(), 5U);
  EXPECT_EQ(plan.trajectories[1].motions[1], (TimedMotion{1, 2, {0, 2}, {1, 2}}));
  EXPECT_EQ(flowtime_s(plan), 10);
  EXPECT_EQ(makespan_s(plan), 5);
  for (const char* const name : {"eecbs.txt", "paths_xy.txt", "libmrp.yaml", "tracker.txt", "tracker.csv"}) {
    const Solution other = read(corpus_text(name)).solution;
    EXPECT_EQ(plan_hash(other), plan_hash(plan)) << name;
  }
}

TEST(IoDiscreteSolution, FormatsHaveNamesForWhereGuessingFails) {
  const Solution plan = read(corpus_text("lacam.txt"), "lacam").solution;
  const std::pair<const char*, const char*> formats[] = {
      {"eecbs.txt", "eecbs"},       {"eecbs.txt", "paths"},  {"paths_xy.txt", "paths"},
      {"paths_xy.txt", "paths-xy"}, {"libmrp.yaml", "yaml"}, {"tracker.txt", "tracker"},
      {"tracker.csv", "tracker"}};
  for (const auto& [file, format] : formats) {
    EXPECT_EQ(plan_hash(read(corpus_text(file), format).solution), plan_hash(plan)) << file << " " << format;
  }
  EXPECT_EQ(refusal(corpus_text("eecbs.txt"), "paths-xy"),
            "s:1: cells with the row first, expected the column first in this format");
  EXPECT_EQ(refusal(corpus_text("paths_xy.txt"), "eecbs"),
            "s:1: cells with the column first, expected the row first in this format");
}

TEST(IoDiscreteSolution, LogsOfContinuousCbsHaveRowsAndExactDurations) {
  const SolutionDocument log = read(corpus_text("ccbs_log.xml"));
  EXPECT_EQ(log.solution.trajectories[1].motions[0], (TimedMotion{0, 0.5, {0, 3}, {0, 2}}));
  EXPECT_EQ(log.solution.trajectories[1].motions[1], (TimedMotion{0.5, 2.5, {0, 2}, {4, 2}}));
  EXPECT_TRUE(log.solution.trajectories[2].motions.empty());
  EXPECT_EQ(reported(log, "time"), 0.001);
  EXPECT_TRUE(validate(corpus_instance(), log.solution).valid());
  // Without paths it says that there is none.
  EXPECT_EQ(read("<root><agent start_i=\"0\" start_j=\"0\" goal_i=\"0\" goal_j=\"5\"/>"
                 "<log><summary time=\"30\" flowtime=\"0\" makespan=\"0\"/></log></root>")
                .status,
            "failed");
}

TEST(IoDiscreteSolution, WhatAProgramSaysOfItsRunIsKeptApart) {
  const SolutionDocument lacam = read(corpus_text("lacam.txt"));
  EXPECT_EQ(reported(lacam, "soc_lb"), 10);
  EXPECT_EQ(reported(lacam, "comp_time"), 0.25);
  EXPECT_EQ(lacam.planning_seconds, 0);
  EXPECT_EQ(reported(read(corpus_text("libmrp.yaml")), "lowLevelExpanded"), 14);
  EXPECT_EQ(reported(read(corpus_text("tracker.csv")), "lower_cost"), 10);
  SolutionDocument document;
  add_report_table(document, "runtime,solution cost,solver name\n1,2,old\n0.5,12,PBS\n");
  EXPECT_EQ(reported(document, "runtime"), 0.5);
  EXPECT_EQ(reported(document, "solution cost"), 12);
  EXPECT_EQ(document.reported.size(), 2U);
}

TEST(IoDiscreteSolution, WhatDisagreesWithTheInstanceIsOneLine) {
  const std::pair<const char*, const char*> paths[] = {
      {"Agent 0: (0,1)->(0,2)->\n",
       "s:1: robot 0 begins at (1, 0), the instance has (0, 0), expected a plan for this instance"},
      {"Agent 0: (0,0)->(0,2)->\n",
       "s:1: robot 0 jumps from (0, 0) to (2, 0) at step 1, expected a plan for this instance"},
      {"Agent 0: (0,0)->\n", "s:1: nothing of robot 1, expected one line for each robot of the instance"},
      {"Agent 3: (0,0)->\n", "s:1: robot 3 for an instance of 3 robots, expected a plan for this instance"},
      {"Agent 0: (0,0)->\nAgent 0: (0,0)->\n", "s:2: a second line of robot 0, expected one for each robot"},
      {"Agent 0: (0,0)->(0,x)->\n", "s:1: '(0,x)->', expected a line such as 'Agent 0: (3,4)->(3,5)->'"},
  };
  for (const auto& [text, line] : paths) EXPECT_EQ(refusal(text), line);
  EXPECT_EQ(refusal("agents=2\nsolved=1\n"), "s:1: agents=2, expected the 3 robots of the instance");
  EXPECT_EQ(refusal("solved=1\nsolution=\n0:(0,0),(0,3),\n"),
            "s:3: step 0 of 2 robots, expected the 3 of the instance");
  EXPECT_EQ(refusal("solved=1\nsolution=\n1:(0,0),(0,3),(5,3),\n"),
            "s:3: '1:(0,0),(0,3),(5,3),', expected step 0, a colon and the cells of all robots");
  EXPECT_EQ(refusal("schedule:\n  agent0:\n    - x: 0\n      y: 0\n      t: zero\n"),
            "s:5: t: 'zero', expected a plan for this instance");
  EXPECT_EQ(refusal("schedule:\n  agent0: [{x: 0, y: 0, t: 0}]\n"),
            "s:3: nothing of robot 1, expected a list of x, y and t for each robot of the instance");
  EXPECT_EQ(refusal("schedule: [\n").substr(0, 4), "s:2:");
  EXPECT_EQ(refusal("rr\n"),
            "s:1: moves of 2 robots, expected a line of moves such as 3ru2l for each robot of the instance");
  EXPECT_EQ(refusal("999999r\nw\n\n").substr(0, 33), "s:1: robot 0 leaves the map, expe");
  EXPECT_EQ(refusal("map_name,solution_plan\n").substr(0, 24), "s:1: no row of 3 agents,");
}

TEST(IoDiscreteSolution, ARobotThatIsNotSeenForSomeStepsWaits) {
  const SolutionDocument document = read(
      "schedule:\n  agent0: [{x: 0, y: 0, t: 0}, {x: 1, y: 0, t: 4}]\n  agent1: [{x: 0, y: 3, t: 0}]\n"
      "  agent2: [{x: 5, y: 3, t: 0}]\n");
  const std::vector<TimedMotion>& motions = document.solution.trajectories[0].motions;
  ASSERT_EQ(motions.size(), 2U);
  EXPECT_EQ(motions[0], (TimedMotion{0, 3, {0, 0}, {0, 0}}));
  EXPECT_EQ(motions[1], (TimedMotion{3, 4, {0, 0}, {1, 0}}));
}

TEST(IoDiscreteSolution, TrackerTextsReadBackAsTheStepsThatTheyWereWrittenFrom) {
  const Instance instance = corpus_instance();
  const Solution plan = read(corpus_text("eecbs.txt")).solution;
  const auto retimed = retime(instance, plan);
  ASSERT_TRUE(retimed && retimed->is_executable());
  EXPECT_LT(flowtime_s(retimed->solution), flowtime_s(plan));  // one robot is twice as fast as its steps
  const auto steps = discrete_steps(instance, retimed->solution);
  ASSERT_TRUE(steps);
  EXPECT_EQ(tracker_lines(*steps), "5r\nd4r\n\n");
  const std::string table = tracker_csv(instance, tracker_scenario("maps/x-y-even-12.scen"), *steps);
  EXPECT_EQ(table,
            "map_name,scen_type,type_id,agents,lower_cost,solution_cost,solution_plan\n"
            "x-y,even,12,3,10,10,\"5r\nd4r\n\"\n");
  EXPECT_EQ(plan_hash(read(table).solution), plan_hash(plan));
  const auto rows = parse_tracker_rows(table, "t");
  ASSERT_TRUE(rows);
  ASSERT_EQ(rows->size(), 1U);
  EXPECT_EQ(rows->front().solution_cost, 10);
  const auto wrong =
      parse_tracker_rows("map_name,scen_type,type_id,agents,solution_cost\na,even,1,x,3\n", "t");
  ASSERT_FALSE(wrong);
  EXPECT_EQ(wrong.error().message(), "t:2: agents 'x', expected a whole number from 0");
}

TEST(IoDiscreteSolution, InstancesAreWrittenForOtherPlanners) {
  const Instance instance = corpus_instance();
  EXPECT_EQ(write_lmrp_yaml(instance),
            "map:\n  dimensions: [6, 4]\n  obstacles:\n  - [2, 1]\nagents:\n"
            "- name: agent0\n  start: [0, 0]\n  goal: [5, 0]\n"
            "- name: agent1\n  start: [0, 3]\n  goal: [4, 2]\n"
            "- name: agent2\n  start: [5, 3]\n  goal: [5, 3]\n");
  const std::string map = write_ccbs_map(instance.map);
  EXPECT_LT(map.find("<width>6</width>"), map.find("<row>0 0 1 0 0 0</row>"));
  EXPECT_NE(write_ccbs_task(instance).find("<agent start_i=\"3\" start_j=\"0\" goal_i=\"2\" goal_j=\"4\" />"),
            std::string::npos);
  PlannerOptions options;
  options.time_limit_s = 30;
  const std::string config = write_ccbs_config(instance, options);
  EXPECT_NE(config.find("<agent_size>0.5</agent_size>"), std::string::npos);
  EXPECT_NE(config.find("<timelimit>30</timelimit>"), std::string::npos);
}

TEST(Retiming, ARingOfRobotsThatFillTheirCellsIsNamed) {
  Instance instance;
  instance.map = GridMap(3, 3);
  Solution plan;
  const Cell ring[] = {{0, 0}, {1, 0}, {1, 1}, {0, 1}};
  for (std::size_t i = 0; i < 4; ++i) {
    Agent agent;
    agent.id = std::to_string(i);
    agent.start = ring[i];
    agent.goal = ring[(i + 1) % 4];
    instance.agents.push_back(agent);
    plan.trajectories.push_back({agent.start, {{0, 1, agent.start, agent.goal}}});
  }
  instance.agents.push_back({"4", {2, 2}, {2, 1}, 0.5, 1, 0, std::nullopt, 1});
  plan.trajectories.push_back({{2, 2}, {{0, 1, {2, 2}, {2, 1}}}});
  const auto result = retime(instance, plan);
  ASSERT_TRUE(result);
  ASSERT_EQ(result->ring.size(), 4U);
  EXPECT_EQ(ring_text(instance, result->ring).substr(0, 10), "robot 0 (0");
  for (Agent& agent : instance.agents) agent.radius_cells = 0.35;  // 4 lags of sqrt(2) * 0.7 are less than 4
  const auto small = retime(instance, plan);
  ASSERT_TRUE(small && small->is_executable());
  EXPECT_EQ(flowtime_s(small->solution), 5);
}

TEST(Retiming, ARobotThatStandsForEverCannotBePassed) {
  Instance instance;
  instance.map = GridMap(4, 1);
  instance.agents = {{"a", {0, 0}, {3, 0}, 0.5, 1, 0, std::nullopt, 1},
                     {"b", {2, 0}, {2, 0}, 0.5, 1, 0, std::nullopt, 1}};
  const auto result = retime(instance, {{{{0, 0}, {{0, 3, {0, 0}, {3, 0}}}}, {{2, 0}, {}}}});
  ASSERT_TRUE(result);
  EXPECT_EQ(ring_text(instance, result->ring),
            "robot a (2, 0), robot b (2, 0): each has to wait for the next one");
  const auto jump = retime(instance, {{{{0, 0}, {{0, 1, {1, 0}, {3, 0}}}}, {{2, 0}, {}}}});
  ASSERT_FALSE(jump);
  EXPECT_EQ(jump.error(), "robot a: a jump from (0, 0) to (1, 0) at 0 s");
}

}  // namespace
}  // namespace sipplab
