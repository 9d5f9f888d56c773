// The validator on the guarantee of start-safe intervals.
#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "sipplab/options.hpp"
#include "sipplab/validator.hpp"

namespace sipplab {
namespace {

Agent agent_of(Cell start, Cell goal, double radius_cells = 0.5) {
  Agent agent;
  agent.start = start;
  agent.goal = goal;
  agent.radius_cells = radius_cells;
  return agent;
}

/// Robot 0 goes along row 1 from x = 0 to x = 9; robot 1 starts on that row at x = 5
/// and has left it downwards before robot 0 comes.
struct Crossing {
  Instance instance;
  Solution solution;
  ValidationOptions options;

  explicit Crossing(double ssi_s) {
    instance.map = GridMap(12, 12);
    instance.agents.push_back(agent_of({0, 1}, {9, 1}));
    instance.agents.push_back(agent_of({5, 1}, {5, 9}));
    solution.trajectories.push_back({{0, 1}, {{0, 9, {0, 1}, {9, 1}}}});
    solution.trajectories.push_back({{5, 1}, {{0, 8, {5, 1}, {5, 9}}}});
    options.ssi_s = ssi_s;
    options.order = {0, 1};
  }
  ValidationReport report() const { return validate(instance, solution, options); }
};

TEST(ValidatorStartSafe, HoldsUntilTheIntervalEnds) {
  // Robot 0 touches robot 1's start at time 4, that is at distance 1.
  EXPECT_TRUE(Crossing(0).report().valid());
  EXPECT_TRUE(Crossing(3.5).report().valid());
  EXPECT_TRUE(Crossing(4).report().valid());
}

TEST(ValidatorStartSafe, IsBrokenByComingTooEarly) {
  const ValidationReport report = Crossing(4.25).report();
  ASSERT_EQ(report.violations.size(), 1u);
  const Violation& violation = report.violations[0];
  EXPECT_EQ(violation.kind, ViolationKind::kStartSafeInterval);
  EXPECT_EQ(violation.agent, 0u);
  EXPECT_EQ(violation.other, std::size_t{1});
  EXPECT_DOUBLE_EQ(violation.time_s, 4.25);
  EXPECT_DOUBLE_EQ(violation.depth_cells, 0.25);
  EXPECT_EQ(violation.message, "agent 0 overlaps the protected start of agent 1 by 0.25 cells at time 4.25");
  EXPECT_DOUBLE_EQ(Crossing(100).report().violations.at(0).depth_cells, 1);
}

TEST(ValidatorStartSafe, ProtectsLowerPriorityOnly) {
  Crossing crossing(100);
  crossing.options.order = {1, 0};
  EXPECT_TRUE(crossing.report().valid());
}

TEST(ValidatorStartSafe, InfiniteIsBrokenByCrossingAStartAtAnyTime) {
  EXPECT_DOUBLE_EQ(Crossing(kInfiniteSsi).report().violations.at(0).depth_cells, 1);
}

TEST(ValidatorStartSafe, InfiniteLetsARobotIntoItsOwnGoalThatIsAStart) {
  Crossing crossing(kInfiniteSsi);
  crossing.instance.agents[0].goal = {5, 1};
  crossing.solution.trajectories[0] = {{0, 1}, {{0, 5, {0, 1}, {5, 1}}}};
  EXPECT_TRUE(crossing.report().valid());
  // With a finite interval there is no such exception.
  crossing.options.ssi_s = 1000;
  EXPECT_FALSE(crossing.report().valid());
}

TEST(ValidatorStartSafe, InfiniteLetsARobotRunThroughItsOwnGoalAndComeBack) {
  Crossing crossing(kInfiniteSsi);
  crossing.instance.agents[0].goal = {5, 1};
  crossing.solution.trajectories[0] = {{0, 1}, {{0, 9, {0, 1}, {9, 1}}, {9, 13, {9, 1}, {5, 1}}}};
  EXPECT_TRUE(crossing.report().valid());
}

TEST(ValidatorStartSafe, InfiniteSeesAStartBeyondTheOwnGoal) {
  // Through the goal at (5, 1), over the start at (8, 1), and back another way.
  Crossing crossing(kInfiniteSsi);
  crossing.instance.agents[0].goal = {5, 1};
  crossing.instance.agents[1].start = {8, 1};
  crossing.instance.agents[1].goal = {8, 9};
  crossing.solution.trajectories[0] = {
      {0, 1},
      {{0, 9, {0, 1}, {9, 1}}, {9, 12, {9, 1}, {9, 4}}, {12, 16, {9, 4}, {5, 4}}, {16, 19, {5, 4}, {5, 1}}}};
  crossing.solution.trajectories[1] = {{8, 1}, {{0, 8, {8, 1}, {8, 9}}}};
  const ValidationReport report = crossing.report();
  ASSERT_EQ(report.violations.size(), 1u);
  EXPECT_DOUBLE_EQ(report.violations[0].depth_cells, 1);
  EXPECT_DOUBLE_EQ(report.violations[0].time_s, 8);
}

TEST(ValidatorStartSafe, InfiniteFindsTheDeepestPlaceOutsideTheOwnGoal) {
  // Contact at 2: the goal is at (8, 3), the protected start at (6, 3). On the way from
  // (2, 3) the robot enters its goal's disk at (6, 3), on top of that start.
  Crossing crossing(kInfiniteSsi);
  crossing.instance.agents[0] = agent_of({2, 3}, {8, 3}, 1);
  crossing.instance.agents[1] = agent_of({6, 3}, {6, 10}, 1);
  crossing.solution.trajectories[0] = {{2, 3}, {{0, 9, {2, 3}, {2, 3}}, {9, 15, {2, 3}, {8, 3}}}};
  crossing.solution.trajectories[1] = {{6, 3}, {{0, 7, {6, 3}, {6, 10}}}};
  const ValidationReport report = crossing.report();
  ASSERT_EQ(report.violations.size(), 1u);
  EXPECT_EQ(report.violations[0].kind, ViolationKind::kStartSafeInterval);
  EXPECT_NEAR(report.violations[0].depth_cells, 2, 1e-9);
  EXPECT_NEAR(report.violations[0].time_s, 13, 1e-9);
}

TEST(ValidatorStartSafe, IsBrokenByRestingOnAStart) {
  Crossing crossing(20);
  crossing.instance.agents[0].goal = {5, 1};
  crossing.solution.trajectories[0] = {{0, 1}, {{0, 5, {0, 1}, {5, 1}}}};
  EXPECT_DOUBLE_EQ(crossing.report().violations.at(0).depth_cells, 1);
}

TEST(ValidatorStartSafe, WantsAnOrderOfAllAgentsAndANumber) {
  const double kNan = std::numeric_limits<double>::quiet_NaN();
  EXPECT_FALSE(Crossing(kNan).report().valid());
  for (const std::vector<AgentIndex>& order : {std::vector<AgentIndex>{0}, {0, 0}, {0, 2}, {0, 1, 1}}) {
    Crossing crossing(1);
    crossing.options.order = order;
    ASSERT_EQ(crossing.report().violations.size(), 1u);
    EXPECT_EQ(crossing.report().violations[0].kind, ViolationKind::kStartSafeInterval);
  }
  Crossing nothing_guaranteed(1000);
  nothing_guaranteed.options.order.clear();
  EXPECT_TRUE(nothing_guaranteed.report().valid());
}

}  // namespace
}  // namespace sipplab
