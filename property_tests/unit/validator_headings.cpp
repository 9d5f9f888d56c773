// The validator on turns and delays: what keeps the rules, and planted mistakes.
#include <gtest/gtest.h>

#include <functional>
#include <string>
#include <vector>

#include "sipplab/validator.hpp"

namespace sipplab {
namespace {

/// One robot that faces left, turns to the right, goes there, turns up, goes there and
/// turns on to the left. A quarter turn takes half a second.
struct TurningRobot {
  Instance instance;
  Solution solution;
  ValidationOptions options;

  TurningRobot() {
    instance.map = GridMap(6, 6);
    Agent agent;
    agent.id = "7";
    agent.start = {0, 4};
    agent.goal = {2, 2};
    agent.start_heading_deg = 180;
    agent.goal_heading_deg = 180;
    instance.agents.push_back(agent);
    options.rules.turns = true;
    Trajectory trajectory{{0, 4}, {}};
    trajectory.motions = {{0, 1, {0, 4}, {0, 4}, 0.0},
                          {1, 3, {0, 4}, {2, 4}},
                          {3, 3.5, {2, 4}, {2, 4}, 90.0},
                          {3.5, 5.5, {2, 4}, {2, 2}},
                          {5.5, 6, {2, 2}, {2, 2}, 180.0}};
    solution.trajectories.push_back(trajectory);
  }
  std::vector<TimedMotion>& motions() { return solution.trajectories[0].motions; }
  /// Everything from motion `first` on happens `seconds` later.
  void delay(std::size_t first, double seconds) {
    for (std::size_t i = first; i < motions().size(); ++i) {
      motions()[i].begin_s += seconds;
      motions()[i].end_s += seconds;
    }
  }
  ValidationReport report() const { return validate(instance, solution, options); }
};

TEST(ValidatorHeadings, AcceptsARightOne) {
  TurningRobot robot;
  EXPECT_TRUE(robot.report().valid()) << robot.report().violations[0].message;
}

TEST(ValidatorHeadings, StandingLongEnoughIsAsGoodAsATurn) {
  TurningRobot robot;
  for (TimedMotion& motion : robot.motions()) motion.turn_to_deg.reset();
  EXPECT_TRUE(robot.report().valid()) << robot.report().violations[0].message;
}

TEST(ValidatorHeadings, TurnsMayTakeLongerAndStopOnTheWay) {
  TurningRobot robot;
  robot.motions()[2].end_s += 0.25;
  robot.delay(3, 0.25);
  // By way of up instead of straight on: the turn before the first move in two parts.
  robot.motions()[0].end_s = 0.5;
  robot.motions()[0].turn_to_deg = 90;
  robot.motions().insert(robot.motions().begin() + 1, {0.5, 1, {0, 4}, {0, 4}, 0.0});
  EXPECT_TRUE(robot.report().valid()) << robot.report().violations[0].message;
}

TEST(ValidatorHeadings, WithoutTheRuleHeadingsDoNotCount) {
  TurningRobot robot;
  robot.options.rules.turns = false;
  robot.motions()[0].turn_to_deg = 33;
  robot.motions().pop_back();
  EXPECT_TRUE(robot.report().valid());
}

TEST(ValidatorHeadings, FindsEachMistake) {
  using Plant = std::function<void(TurningRobot&)>;
  const struct {
    const char* name;
    Plant plant;
    ViolationKind kind;
    double time_s;
    double error;
  } kMistakes[] = {
      {"too fast a turn at the start",
       [](TurningRobot& robot) {
         robot.motions()[0].end_s = 0.75;
         robot.delay(1, -0.25);
       },
       ViolationKind::kStandingTime, 0, 0.25},
      {"too fast a turn, and then a wait",
       [](TurningRobot& robot) {
         robot.motions()[0].end_s = 0.75;
         robot.motions().insert(robot.motions().begin() + 1, {0.75, 1, {0, 4}, {0, 4}});
       },
       ViolationKind::kStandingTime, 0, 0.25},
      {"another start heading", [](TurningRobot& robot) { robot.instance.agents[0].start_heading_deg = 170; },
       ViolationKind::kHeading, -1, 0},
      {"a turn in the wrong direction", [](TurningRobot& robot) { robot.motions()[2].turn_to_deg = 270; },
       ViolationKind::kHeading, 3.5, 180},
      {"no time for the turn in between",
       [](TurningRobot& robot) {
         robot.motions().erase(robot.motions().begin() + 2);
         robot.delay(2, -0.5);
       },
       ViolationKind::kStandingTime, 3, 0.5},
      {"no turn to the goal heading", [](TurningRobot& robot) { robot.motions().pop_back(); },
       ViolationKind::kStandingTime, 5.5, 0.5},
      {"another goal heading", [](TurningRobot& robot) { robot.instance.agents[0].goal_heading_deg = 181; },
       ViolationKind::kHeading, 6, 1},
      {"a robot that turns more slowly",
       [](TurningRobot& robot) { robot.instance.agents[0].rotation_speed = 0.5; },
       ViolationKind::kStandingTime, 0, 1},
      {"no delay before a move", [](TurningRobot& robot) { robot.options.rules.wait_before_move_s = 0.125; },
       ViolationKind::kStandingTime, 0, 0.125},
  };
  for (const auto& mistake : kMistakes) {
    TurningRobot robot;
    mistake.plant(robot);
    const ValidationReport report = robot.report();
    if (mistake.time_s < 0) {  // harmless: less to turn than there is time for
      EXPECT_TRUE(report.valid()) << mistake.name;
      continue;
    }
    ASSERT_FALSE(report.valid()) << mistake.name;
    EXPECT_EQ(report.violations[0].kind, mistake.kind)
        << mistake.name << ": " << report.violations[0].message;
    EXPECT_EQ(report.violations[0].time_s, mistake.time_s) << mistake.name;
    EXPECT_NEAR(report.violations[0].depth_cells, mistake.error, 1e-9) << mistake.name;
  }
}

TEST(ValidatorHeadings, DelaysCountBesideTurns) {
  TurningRobot robot;
  robot.options.rules.wait_before_move_s = 0.125;
  robot.delay(1, 0.125);  // before the first move
  robot.delay(3, 0.125);  // before the second one
  robot.motions()[0].end_s = 1.125;
  robot.motions()[2].end_s += 0.125;
  EXPECT_TRUE(robot.report().valid()) << robot.report().violations[0].message;
  robot.options.rules.wait_before_move_s = 0.126;
  ASSERT_EQ(robot.report().violations.size(), 2u);
  EXPECT_NEAR(robot.report().violations[1].depth_cells, 0.001, 1e-9);
}

TEST(ValidatorHeadings, DelaysCountWithoutHeadings) {
  TurningRobot robot;
  robot.options.rules.turns = false;
  robot.options.rules.wait_before_move_s = 0.5;
  EXPECT_TRUE(robot.report().valid()) << robot.report().violations[0].message;
  robot.options.rules.wait_before_move_s = 0.75;
  ASSERT_EQ(robot.report().violations.size(), 1u);
  EXPECT_EQ(robot.report().violations[0].time_s, 3);
}

TEST(ValidatorHeadings, ARobotThatNeverMovesTurnsToItsGoalHeading) {
  TurningRobot robot;
  Agent& agent = robot.instance.agents[0];
  agent.goal = agent.start;
  agent.goal_heading_deg = 90;
  robot.motions().clear();
  ASSERT_EQ(robot.report().violations.size(), 1u);
  EXPECT_NEAR(robot.report().violations[0].depth_cells, 0.5, 1e-12);
  robot.motions() = {{0, 0.5, {0, 4}, {0, 4}, 90.0}};
  EXPECT_TRUE(robot.report().valid());
  agent.goal_heading_deg.reset();
  robot.motions().clear();
  EXPECT_TRUE(robot.report().valid());
}

}  // namespace
}  // namespace sipplab
