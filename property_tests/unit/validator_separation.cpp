// The validator on pairs of bodies: planted overlaps of every depth, at every time
// of life, and touching, which is allowed.
#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "planner/core/tolerances.hpp"
#include "planner/validator/separation.hpp"
#include "sipplab/validator.hpp"

namespace sipplab {
namespace {

class Traffic {
 public:
  explicit Traffic(std::int32_t side = 20) { instance_.map = GridMap(side, side); }

  /// A robot that visits the places one after another at speed 1, after `wait_s`.
  Traffic& robot(std::vector<Cell> places, double wait_s = 0, double radius_cells = 0.5, double speed = 1) {
    Agent agent;
    agent.start = places.front();
    agent.goal = places.back();
    agent.radius_cells = radius_cells;
    agent.speed_cells_per_s = speed;
    instance_.agents.push_back(agent);
    solution_.trajectories.push_back(walk(places, wait_s, speed));
    return *this;
  }
  Traffic& obstacle(std::vector<Cell> places, double wait_s = 0) {
    instance_.obstacles.push_back({"", 0.5, walk(places, wait_s, 1)});
    return *this;
  }
  ValidationReport report() const { return validate(instance_, solution_); }
  /// The one violation there is.
  Violation violation() const {
    const ValidationReport found = report();
    EXPECT_EQ(found.violations.size(), 1u);
    return found.violations.empty() ? Violation{} : found.violations[0];
  }
  Instance& instance() { return instance_; }

 private:
  static Trajectory walk(const std::vector<Cell>& places, double wait_s, double speed) {
    Trajectory trajectory;
    trajectory.start = places.front();
    if (wait_s > 0) trajectory.motions.push_back({0, wait_s, places.front(), places.front()});
    for (std::size_t i = 1; i < places.size(); ++i) {
      const double begin_s = trajectory.end_s();
      trajectory.motions.push_back(
          {begin_s, begin_s + distance(places[i - 1], places[i]) / speed, places[i - 1], places[i]});
    }
    return trajectory;
  }

  Instance instance_;
  Solution solution_;
};

TEST(ValidatorSeparation, AcceptsTouchingAllTheWay) {
  // A queue that moves on in contact, a robot next to it, and one that waits next to them.
  Traffic traffic;
  traffic.robot({{1, 1}, {9, 1}}).robot({{2, 1}, {10, 1}}).robot({{3, 1}, {11, 1}});
  traffic.robot({{1, 2}, {9, 2}}).robot({{5, 3}});
  const ValidationReport report = traffic.report();
  EXPECT_TRUE(report.valid()) << report.violations[0].message;
  EXPECT_NEAR(report.min_clearance_cells, 0, 1e-12);
}

TEST(ValidatorSeparation, AcceptsDiagonalNeighboursThatTouchExactly) {
  Traffic traffic;
  const double radius = std::sqrt(0.5);
  traffic.robot({{2, 2}, {9, 9}}, 0, radius).robot({{3, 1}, {10, 8}}, 0, radius);
  EXPECT_TRUE(traffic.report().valid());
}

TEST(ValidatorSeparation, SeesADeepMeetingHeadOn) {
  Traffic traffic;
  traffic.robot({{1, 1}, {9, 1}}).robot({{9, 1}, {1, 1}});
  const Violation violation = traffic.violation();
  EXPECT_EQ(violation.kind, ViolationKind::kAgentCollision);
  EXPECT_EQ(violation.agent, 0u);
  EXPECT_EQ(violation.other, std::size_t{1});
  EXPECT_DOUBLE_EQ(violation.depth_cells, 1);
  EXPECT_DOUBLE_EQ(violation.time_s, 4);
  EXPECT_EQ(violation.message, "agent 0 and agent 1 overlap by 1 cells at time 4");
}

TEST(ValidatorSeparation, SeesOverlapsOfEveryDepth) {
  for (const double depth : {1e-6, 1e-4, 0.01, 0.3}) {
    Traffic traffic;
    traffic.robot({{1, 1}, {9, 1}}).robot({{5, 2}}, 0, 0.5 + depth);
    const Violation violation = traffic.violation();
    EXPECT_NEAR(violation.depth_cells, depth, 1e-12);
    EXPECT_NEAR(violation.time_s, 4, 1e-9);
    EXPECT_NEAR(traffic.report().min_clearance_cells, -depth, 1e-12);
  }
}

TEST(ValidatorSeparation, LetsOverlapWithinTheTolerancePassAndRecordsIt) {
  Traffic traffic;
  traffic.robot({{1, 1}, {9, 1}}).robot({{5, 2}}, 0, 0.5 + kValidatorToleranceCells / 2);
  EXPECT_TRUE(traffic.report().valid());
  EXPECT_NEAR(traffic.report().min_clearance_cells, -kValidatorToleranceCells / 2, 1e-12);
}

TEST(ValidatorSeparation, SeesARobotThatFollowsTooSoon) {
  // Round a corner in contact: the follower cuts in while the leader goes off sideways.
  Traffic traffic;
  traffic.robot({{1, 1}, {5, 1}}).robot({{2, 1}, {2, 5}});
  const Violation violation = traffic.violation();
  EXPECT_NEAR(violation.depth_cells, 1 - std::sqrt(0.5), 1e-12);
  EXPECT_NEAR(violation.time_s, 0.5, 1e-12);
}

TEST(ValidatorSeparation, SeesARobotThatIsStillAtItsStart) {
  Traffic traffic;
  traffic.robot({{1, 1}, {9, 1}}).robot({{5, 1}, {5, 9}}, 6);
  EXPECT_DOUBLE_EQ(traffic.violation().depth_cells, 1);
  EXPECT_DOUBLE_EQ(traffic.violation().time_s, 4);
}

TEST(ValidatorSeparation, AcceptsARobotThatHasLeftInTime) {
  Traffic traffic;
  traffic.robot({{1, 1}, {9, 1}}).robot({{5, 1}, {5, 9}}, 2);
  EXPECT_TRUE(traffic.report().valid());
}

TEST(ValidatorSeparation, SeesARobotThatRestsAtItsGoalForEver) {
  Traffic traffic;
  traffic.robot({{5, 9}, {5, 1}}).robot({{1, 1}, {9, 1}}, 1000);
  const Violation violation = traffic.violation();
  EXPECT_DOUBLE_EQ(violation.time_s, 1004);
  EXPECT_DOUBLE_EQ(violation.depth_cells, 1);
}

TEST(ValidatorSeparation, SeesTwoThatRestOnOneGoalForEver) {
  Traffic traffic;
  traffic.robot({{1, 1}, {5, 1}}).robot({{9, 1}, {6, 1}}, 0, 0.75);
  const Violation violation = traffic.violation();
  EXPECT_DOUBLE_EQ(violation.depth_cells, 0.25);
  EXPECT_NEAR(violation.time_s, 4, 1e-9);
}

TEST(ValidatorSeparation, SeesTwoThatNeverMove) {
  Traffic traffic;
  traffic.robot({{5, 5}}).robot({{5, 6}}, 0, 0.625);
  EXPECT_DOUBLE_EQ(traffic.violation().depth_cells, 0.125);
  EXPECT_DOUBLE_EQ(traffic.violation().time_s, 0);
}

TEST(ValidatorSeparation, ReportsAPairOnceAtItsDeepest) {
  Traffic traffic;
  // Grazes at time 9; meets at times 29 and 47.
  traffic.robot({{0, 1}, {19, 1}, {0, 1}, {19, 1}}).robot({{9, 2}, {9, 1}}, 20, 0.75);
  EXPECT_DOUBLE_EQ(traffic.violation().depth_cells, 1.25);
  EXPECT_DOUBLE_EQ(traffic.violation().time_s, 29);
}

TEST(ValidatorSeparation, SeesObstaclesInMotionAndAtRestForEver) {
  Traffic moving;
  moving.robot({{1, 1}, {9, 1}}).obstacle({{9, 1}, {1, 1}});
  EXPECT_EQ(moving.violation().kind, ViolationKind::kObstacleCollision);
  EXPECT_EQ(moving.violation().other, std::size_t{0});
  EXPECT_EQ(moving.violation().message, "agent 0 and obstacle 0 overlap by 1 cells at time 4");
  Traffic resting;
  resting.robot({{1, 1}, {9, 1}}, 100).obstacle({{5, 9}, {5, 1}});
  EXPECT_DOUBLE_EQ(resting.violation().time_s, 104);
}

TEST(ValidatorSeparation, LeavesObstaclesToThemselves) {
  Traffic traffic;
  traffic.robot({{1, 9}}).obstacle({{1, 1}, {9, 1}}).obstacle({{9, 1}, {1, 1}});
  EXPECT_TRUE(traffic.report().valid());
  EXPECT_EQ(traffic.report().min_clearance_cells, kClearanceReachCells);
}

TEST(ValidatorSeparation, SeesAnObstacleThatComesFromBeyondTheGrid) {
  Traffic traffic;
  traffic.robot({{1, 1}}).obstacle({{-9, 1}, {9, 1}});
  EXPECT_DOUBLE_EQ(traffic.violation().time_s, 10);
  EXPECT_DOUBLE_EQ(traffic.violation().depth_cells, 1);
}

TEST(ValidatorSeparation, MeasuresClearanceBelowTheReachAndNotBeyond) {
  for (const double clearance : {0.0625, 0.25, 0.5, 0.875}) {
    Traffic traffic;
    traffic.robot({{1, 1}, {18, 1}}).robot({{9, 3}}, 0, 1.5 - clearance);
    EXPECT_NEAR(traffic.report().min_clearance_cells, clearance, 1e-12);
  }
  Traffic apart;
  apart.robot({{1, 1}}).robot({{9, 9}});
  EXPECT_EQ(apart.report().min_clearance_cells, kClearanceReachCells);
  Traffic alone;
  alone.robot({{1, 1}});
  EXPECT_EQ(alone.report().min_clearance_cells, std::numeric_limits<double>::infinity());
}

TEST(ValidatorSeparation, SeesASmallRobotUnderALargeOne) {
  Traffic traffic(200);
  for (std::int32_t i = 0; i < 30; ++i) traffic.robot({{2 * i, 199}}, 0, 0.25);
  traffic.robot({{100, 64}, {101, 64}}, 0, 60).robot({{40, 100}, {150, 100}}, 0, 0.25);
  const Violation violation = traffic.violation();
  EXPECT_EQ(violation.agent, 30u);
  EXPECT_NEAR(violation.depth_cells, 60.25 - 36, 1e-9);
}

TEST(ValidatorSeparation, SeesFastRobotsOnLongWays) {
  Traffic traffic(2000);
  traffic.robot({{0, 0}, {1999, 1998}}, 0, 0.5, 1000).robot({{1999, 0}, {0, 1998}}, 0, 0.5, 1000);
  EXPECT_EQ(traffic.violation().kind, ViolationKind::kAgentCollision);
  EXPECT_NEAR(traffic.violation().depth_cells, 1, 1e-6);
}

TEST(ValidatorSeparation, StopsAtTheGivenNumberOfPairs) {
  Traffic traffic;
  for (int i = 0; i < 40; ++i) traffic.robot({{5, 5}});
  EXPECT_EQ(traffic.report().violations.size(), 100u);
}

TEST(ValidatorSeparation, SurvivesTimesAndPlacesBeyondAllMeasure) {
  Traffic traffic;
  traffic.robot({{1, 1}, {2147483647, 2147483647}}, 1e300, 0.5, 1e-3)
      .robot({{-2147483647, 3}, {2147483647, 3}}, 0, 64, 1e3);
  traffic.robot({{3, 3}, {4, 4}}, 0, 0.5, 1e250).robot({{3, 4}, {4, 3}}, 0, 0.5, 1e-250);
  traffic.robot({{8, 8}, {9, 9}}, 0, std::numeric_limits<double>::quiet_NaN());
  traffic.robot({{8, 8}, {9, 9}}, 0, -1).robot({{8, 8}, {9, 9}}, 0, 1e300);
  traffic.obstacle({{-2147483647, 3}, {2147483647, 3}}, 1e300);
  EXPECT_FALSE(traffic.report().valid());
}

}  // namespace
}  // namespace sipplab
