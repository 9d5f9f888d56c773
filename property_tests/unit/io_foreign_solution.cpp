// Solutions of other planners: logs of the published one, and lines of cells and times.
#include <gtest/gtest.h>

#include <cmath>
#include <optional>
#include <string>
#include <vector>

#include "sipplab/solution_io.hpp"

namespace sipplab {
namespace {

/// Known by id or, where no id says so, by position; the last one never moves.
Instance three_robots() {
  Instance instance;
  instance.map = GridMap(8, 4);
  instance.agents = {{"0", {0, 0}, {7, 2}, 0.5, 1, 0, std::nullopt, 1},
                     {"north", {0, 2}, {7, 0}, 0.5, 1, 0, std::nullopt, 1},
                     {"007", {4, 3}, {4, 3}, 0.5, 1, 0, std::nullopt, 1}};
  return instance;
}

std::string refusal_of(const std::string& text, const Instance& instance) {
  const Input<SolutionDocument> document = parse_solution(text, "s", instance);
  return document ? "no error" : document.error().message();
}

TEST(IoForeignSolution, TurnsOfThePublishedLogLoseTheirRounding) {
  Instance instance;
  instance.map = GridMap(4, 4);
  instance.agents = {{"0", {0, 3}, {1, 0}, 0.5, 1, 180, 0.1 + 0.2, 0.2}};
  const auto section = [](const char* from, const char* from_deg, const char* to, const char* to_deg,
                          const char* duration) {
    return std::string("<section ") + from + " start.heading=\"" + from_deg + "\" " + to +
           " goal.heading=\"" + to_deg + "\" duration=\"" + duration + "\"/>";
  };
  const char* const start_from = "start.x=\"0\" start.y=\"3\"";
  const char* const start_to = "goal.x=\"0\" goal.y=\"3\"";
  const char* const goal_from = "start.x=\"1\" start.y=\"0\"";
  const char* const goal_to = "goal.x=\"1\" goal.y=\"0\"";
  const Input<SolutionDocument> read =
      parse_solution("<root><log><agent id=\"0\" movespeed=\"1\"><path pathfound=\"true\">" +
                         section(start_from, "180", start_to, "71.565048", "3.0120819") +
                         section(start_from, "71.565048", goal_to, "71.565048", "3.1622777") +
                         section(goal_from, "71.565048", goal_to, "0.30000001", "1.9795848") +
                         "</path></agent></log></root>",
                     "s", instance);
  ASSERT_TRUE(read) << read.error().message();
  const std::vector<TimedMotion>& motions = read->solution.trajectories[0].motions;
  ASSERT_EQ(motions.size(), 3u);
  const double direction_deg = std::atan(3.0) * 180 / std::acos(-1.0);
  EXPECT_NEAR(*motions[0].turn_to_deg, direction_deg, 1e-12);
  EXPECT_NEAR(motions[0].end_s, (180 - direction_deg) / 36, 1e-12);
  EXPECT_FALSE(motions[1].is_turn());
  EXPECT_EQ(motions[2].turn_to_deg, 0.1 + 0.2);
  EXPECT_NEAR(motions[2].end_s - motions[2].begin_s, (direction_deg - (0.1 + 0.2)) / 36, 1e-12);
}

TEST(IoForeignSolution, PublishedLogsAreSummedUpAndStraightSectionsMadeExact) {
  Instance instance;
  instance.map = GridMap(8, 4);
  instance.agents = {{"0", {0, 0}, {1, 2}, 0.4, 0.1, 0, std::nullopt, 1}};
  const std::string text =
      "<root><log><summary runtime=\"0.5\" tries=\"2\" agentssolved=\"1 (100.000000%)\" flowtime=\"3\" "
      "makespan=\"4\"/>"
      "<path><row number=\"0\">0 *</row></path>"
      "<agent id=\"0\" size=\"0.40000001\" movespeed=\"0.1\"><path pathfound=\"true\" runtime=\"0.1\" "
      "duration=\"9\">\n"
      "<section id=\"0\" start.x=\"0\" start.y=\"0\" goal.x=\"1\" goal.y=\"1\" duration=\"14.142136\"/>\n"
      "<section id=\"1\" start.x=\"1\" start.y=\"1\" goal.x=\"1\" goal.y=\"1\" duration=\"0.76468909\"/>\n"
      "<section id=\"2\" start.x=\"1\" start.y=\"1\" goal.x=\"1\" goal.y=\"2\" duration=\"11\"/>\n"
      "</path></agent></log></root>";
  const Input<SolutionDocument> read = parse_solution(text, "s", instance);
  ASSERT_TRUE(read) << read.error().message();
  EXPECT_EQ(read->tries, 2u);
  EXPECT_EQ(read->makespan_s, 4);
  const std::vector<TimedMotion>& motions = read->solution.trajectories[0].motions;
  ASSERT_EQ(motions.size(), 3u);
  EXPECT_EQ(motions[0].end_s, std::sqrt(2.0) / 0.1);
  EXPECT_EQ(motions[1].end_s, std::sqrt(2.0) / 0.1 + 0.76468909);
  EXPECT_EQ(motions[2].end_s, motions[1].end_s + 11) << "too slow for rounding: kept as it stands";
}

TEST(IoForeignSolution, APublishedLogOfFewerRobotsIsAFailure) {
  const Instance instance = three_robots();
  const auto log = [](const char* solved) {
    return std::string("<root><log><summary runtime=\"0.5\" tries=\"4\" agentssolved=\"") + solved +
           "\" flowtime=\"3\"/></log></root>";
  };
  const Input<SolutionDocument> read = parse_solution(log("2 (66.666667%)"), "s", instance);
  ASSERT_TRUE(read) << read.error().message();
  EXPECT_EQ(read->status, "failed");
  EXPECT_EQ(read->tries, 4u);
  EXPECT_FALSE(parse_solution(log("3 (100.000000%)"), "s", instance)) << "a success without trajectories";
}

TEST(IoForeignSolution, PlainLinesAreRead) {
  const Instance instance = three_robots();
  const std::string text =
      "# found by another planner\n"
      "agent 007: (4,3,0)\r\n"
      "\n"
      "1: (0,2,0) -> ( 0, 2, 1.5 ) -> (7,0,25.75)\n"
      "robot 0: (0,0,0), (7,2,7.5),\n";
  const Input<SolutionDocument> read = parse_solution(text, "s", instance);
  ASSERT_TRUE(read) << read.error().message();
  const std::vector<Trajectory> wanted = {{{0, 0}, {{0, 7.5, {0, 0}, {7, 2}}}},
                                          {{0, 2}, {{0, 1.5, {0, 2}, {0, 2}}, {1.5, 25.75, {0, 2}, {7, 0}}}},
                                          {{4, 3}, {}}};
  EXPECT_EQ(read->solution.trajectories, wanted);
  EXPECT_EQ(read->status, "solved");
}

TEST(IoForeignSolution, BadPlainLinesNameTheLine) {
  const Instance instance = three_robots();
  const std::string expected =
      ", expected a robot, a colon and its cells and times, such as '0: (3,4,0) (5,4,2)'";
  EXPECT_EQ(refusal_of("0: (0,0,0)\nnothing more\n", instance), "s:2: 'nothing more'" + expected);
  EXPECT_EQ(refusal_of("0: (0,0,0) (1,0)\n", instance), "s:1: '(1,0)'" + expected);
  EXPECT_EQ(refusal_of("0: (0,0,0) (1,0.5,2)\n", instance), "s:1: '(1,0.5,2)'" + expected);
  EXPECT_EQ(refusal_of("0: (0,0,0) (1,0,nan)\n", instance), "s:1: '(1,0,nan)'" + expected);
  EXPECT_EQ(refusal_of("0: (0,0,0) to (1,0,1)\n", instance), "s:1: 'to'" + expected);
  EXPECT_EQ(refusal_of("0: (0,0,0) (1,0,1\n", instance), "s:1: '(1,0,1'" + expected);
  EXPECT_EQ(refusal_of("0: (0,0,0)\n7:\n", instance), "s:2: ''" + expected);
  EXPECT_EQ(
      refusal_of("0: (0,0,0)\n9: (0,0,0)\n", instance),
      "s:2: trajectory 9 for an instance of 3 robots, expected one line for each robot of the instance");
  EXPECT_EQ(refusal_of("0: (0,0,0)\n0: (0,0,0)\n", instance),
            "s:2: a second trajectory of robot '0', expected one line for each robot of the instance");
  EXPECT_EQ(refusal_of("0: (0,0,0)\n1: (0,2,0)\n", instance),
            "s:2: no line of robot '007', expected one for each robot of the instance");
}

}  // namespace
}  // namespace sipplab
