// The validator on one trajectory: planted mistakes of every kind.
#include <gtest/gtest.h>

#include <cmath>
#include <functional>

#include "planner/core/tolerances.hpp"
#include "planner/io/case_codec.hpp"
#include "property_tests/support/extremes.hpp"
#include "sipplab/validator.hpp"

namespace sipplab {
namespace {

/// One robot that goes right, waits and goes down; everything about it is right.
struct OneRobot {
  Instance instance;
  Solution solution;

  OneRobot() {
    instance.map = GridMap(6, 6);
    Agent agent;
    agent.id = "7";
    agent.goal = {2, 2};
    instance.agents.push_back(agent);
    Trajectory trajectory;
    trajectory.motions = {{0, 2, {0, 0}, {2, 0}}, {2, 2.5, {2, 0}, {2, 0}}, {2.5, 4.5, {2, 0}, {2, 2}}};
    solution.trajectories.push_back(trajectory);
  }
  TimedMotion& motion(std::size_t i) { return solution.trajectories[0].motions[i]; }
};

bool has(const ValidationReport& report, ViolationKind kind) {
  for (const Violation& violation : report.violations) {
    if (violation.kind == kind) return true;
  }
  return false;
}

TEST(ValidatorTrajectory, AcceptsARightOne) {
  OneRobot scene;
  const ValidationReport report = validate(scene.instance, scene.solution);
  EXPECT_TRUE(report.valid()) << report.violations[0].message;
  EXPECT_EQ(report.min_clearance_cells, kInfinity);
}

TEST(ValidatorTrajectory, AcceptsNoRobots) { EXPECT_TRUE(validate(Instance{}, Solution{}).valid()); }

TEST(ValidatorTrajectory, AcceptsARobotThatIsThereAlready) {
  OneRobot scene;
  scene.solution.trajectories[0].motions.clear();
  scene.instance.agents[0].goal = {0, 0};
  EXPECT_TRUE(validate(scene.instance, scene.solution).valid());
}

TEST(ValidatorTrajectory, CountsTrajectories) {
  OneRobot scene;
  scene.solution.trajectories.clear();
  const ValidationReport report = validate(scene.instance, scene.solution);
  ASSERT_EQ(report.violations.size(), 1u);
  EXPECT_EQ(report.violations[0].kind, ViolationKind::kAgentCount);
  EXPECT_EQ(report.violations[0].message, "0 trajectories for 1 agents");
}

TEST(ValidatorTrajectory, NamesEachMistake) {
  struct Mistake {
    const char* name;
    std::function<void(OneRobot&)> make;
    ViolationKind kind;
  };
  const Mistake mistakes[] = {
      {"NaN begin", [](OneRobot& it) { it.motion(1).begin_s = kNan; }, ViolationKind::kNotFinite},
      {"infinite end", [](OneRobot& it) { it.motion(2).end_s = kInfinity; }, ViolationKind::kNotFinite},
      {"negative begin", [](OneRobot& it) { it.motion(0).begin_s = -1; }, ViolationKind::kNotFinite},
      {"other start",
       [](OneRobot& it) {
         it.instance.agents[0].start = {0, 1};
       },
       ViolationKind::kEndpoint},
      {"other goal",
       [](OneRobot& it) {
         it.instance.agents[0].goal = {2, 3};
       },
       ViolationKind::kEndpoint},
      {"goal never reached", [](OneRobot& it) { it.solution.trajectories[0].motions.pop_back(); },
       ViolationKind::kEndpoint},
      {"jump in place",
       [](OneRobot& it) {
         it.motion(1).from = it.motion(1).to = {3, 0};
       },
       ViolationKind::kDiscontinuity},
      {"first motion elsewhere",
       [](OneRobot& it) {
         it.solution.trajectories[0].start = {1, 0};
       },
       ViolationKind::kDiscontinuity},
      {"gap in time",
       [](OneRobot& it) { it.motion(2).begin_s = 2.5 + 1e-6, it.motion(2).end_s = 4.5 + 1e-6; },
       ViolationKind::kDiscontinuity},
      {"late first motion",
       [](OneRobot& it) {
         it.solution.trajectories[0].motions.erase(it.solution.trajectories[0].motions.begin());
       },
       ViolationKind::kDiscontinuity},
      {"wait backwards", [](OneRobot& it) { it.motion(1).end_s = 1.5; }, ViolationKind::kDiscontinuity},
      {"too slow", [](OneRobot& it) { it.motion(2).end_s = 4.5 + 1e-6; }, ViolationKind::kSpeed},
      {"too fast", [](OneRobot& it) { it.motion(2).end_s = 4.5 - 1e-6; }, ViolationKind::kSpeed},
      {"in no time", [](OneRobot& it) { it.motion(2).end_s = 2.5; }, ViolationKind::kSpeed},
      {"backwards in time", [](OneRobot& it) { it.motion(2).end_s = 0.5; }, ViolationKind::kSpeed},
      {"speed of another robot", [](OneRobot& it) { it.instance.agents[0].speed_cells_per_s = 2; },
       ViolationKind::kSpeed},
      {"through a blocked cell",
       [](OneRobot& it) {
         it.instance.map.set_blocked({1, 0}, true);
       },
       ViolationKind::kStaticObstacle},
      {"start on a blocked cell",
       [](OneRobot& it) {
         it.instance.map.set_blocked({0, 0}, true);
       },
       ViolationKind::kStaticObstacle},
      {"goal on a blocked cell",
       [](OneRobot& it) {
         it.instance.map.set_blocked({2, 2}, true);
       },
       ViolationKind::kStaticObstacle},
      {"too wide for the border", [](OneRobot& it) { it.instance.agents[0].radius_cells = 0.5 + 1e-6; },
       ViolationKind::kStaticObstacle},
      {"far outside",
       [](OneRobot& it) {
         it.motion(2).to = {2147483647, -2147483647};
       },
       ViolationKind::kStaticObstacle},
  };
  for (const Mistake& mistake : mistakes) {
    OneRobot scene;
    mistake.make(scene);
    EXPECT_TRUE(has(validate(scene.instance, scene.solution), mistake.kind)) << mistake.name;
  }
}

TEST(ValidatorTrajectory, LetsRoundingPass) {
  OneRobot scene;
  scene.motion(2).end_s += 1e-12;
  scene.motion(1).end_s += 1e-12;
  scene.instance.agents[0].radius_cells = 0.5 + kValidatorToleranceCells / 2;
  EXPECT_TRUE(validate(scene.instance, scene.solution).valid());
}

TEST(ValidatorTrajectory, SeesAJumpHoweverLateItIs) {
  // At 2e6 s the tolerance of times is 2e-3 s, which is all that two cells take at this speed.
  constexpr double kLateS = 2e6;
  OneRobot scene;
  scene.instance.agents[0].speed_cells_per_s = 1000;
  scene.instance.agents[0].goal = {2, 0};
  scene.solution.trajectories[0].motions = {{0, kLateS, {0, 0}, {0, 0}}, {kLateS, kLateS, {0, 0}, {2, 0}}};
  EXPECT_TRUE(has(validate(scene.instance, scene.solution), ViolationKind::kSpeed));
  scene.motion(1).end_s = kLateS + 0.002;
  EXPECT_TRUE(validate(scene.instance, scene.solution).valid());
}

TEST(ValidatorTrajectory, MeasuresSweptBodiesAgainstCorners) {
  // The move from (1, 1) to (3, 2) passes the upper right corner of cell (1, 2).
  OneRobot scene;
  scene.instance.map.set_blocked({1, 2}, true);
  scene.instance.agents[0].start = {1, 1};
  scene.instance.agents[0].goal = {3, 2};
  scene.solution.trajectories[0] = {{1, 1}, {{0, std::sqrt(5.0), {1, 1}, {3, 2}}}};
  const double to_corner = 0.5 / std::sqrt(5.0);
  scene.instance.agents[0].radius_cells = to_corner;
  EXPECT_TRUE(validate(scene.instance, scene.solution).valid());
  scene.instance.agents[0].radius_cells = to_corner + 1e-6;
  const ValidationReport report = validate(scene.instance, scene.solution);
  ASSERT_EQ(report.violations.size(), 1u);
  EXPECT_EQ(report.violations[0].kind, ViolationKind::kStaticObstacle);
  EXPECT_NEAR(report.violations[0].depth_cells, 1e-6, 1e-12);
}

TEST(ValidatorTrajectory, StopsAtTheGivenNumberOfViolations) {
  OneRobot scene;
  for (int i = 0; i < 50; ++i) {
    scene.solution.trajectories[0].motions.push_back({9.0 * i, 9.0 * i, {i % 6, 0}, {i % 6, 5}});
  }
  ValidationOptions options;
  EXPECT_EQ(validate(scene.instance, scene.solution, options).violations.size(), 100u);
  options.max_violations = 7;
  EXPECT_EQ(validate(scene.instance, scene.solution, options).violations.size(), 7u);
  options.max_violations = 0;
  EXPECT_EQ(validate(scene.instance, scene.solution, options).violations.size(), 1u);
}

TEST(ValidatorTrajectory, MessagesNameAgentAndPlace) {
  OneRobot scene;
  scene.instance.map.set_blocked({1, 0}, true);
  const ValidationReport report = validate(scene.instance, scene.solution);
  ASSERT_EQ(report.violations.size(), 1u);
  EXPECT_EQ(report.violations[0].message,
            "agent 7: overlaps blocked cell (1, 0) by 0.5 cells between (0, 0) and (2, 0)");
  EXPECT_EQ(name(report.violations[0].kind), "static-obstacle");
  EXPECT_DOUBLE_EQ(report.violations[0].time_s, 1);
}

}  // namespace
}  // namespace sipplab
