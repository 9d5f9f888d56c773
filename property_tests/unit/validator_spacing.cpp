// Inflated distances and times, by hand: what is kept, and by how much it is missed.
#include "planner/validator/spacing_check.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "property_tests/support/extremes.hpp"
#include "sipplab/validator.hpp"

namespace sipplab {
namespace {

/// Robot 0 goes along the upper row. Robot 1 waits below (2, 0) and goes there at `begin_s`.
struct Follower {
  Instance instance;
  Solution solution;
  ValidationOptions options;

  explicit Follower(double begin_s) {
    instance.map = GridMap(9, 3);
    for (const auto& [start, goal] : {std::pair{Cell{0, 0}, Cell{8, 0}}, std::pair{Cell{2, 1}, Cell{2, 0}}}) {
      Agent agent;
      agent.start = start;
      agent.goal = goal;
      instance.agents.push_back(agent);
    }
    solution.trajectories = {
        {{0, 0}, {{0, 8, {0, 0}, {8, 0}}}},
        {{2, 1}, {{0, begin_s, {2, 1}, {2, 1}}, {begin_s, begin_s + 1, {2, 1}, {2, 0}}}}};
    options.order = {0, 1};
  }
  ValidationReport report() const { return validate(instance, solution, options); }
};

TEST(ValidatorSpacing, DistanceCountsWhileTheLowerRobotMoves) {
  Follower scene(4);  // the other is at 4 then, two columns on, and moves away
  scene.options.rules.inflate_distance_cells = std::sqrt(5.0) - 1 - 1e-9;
  EXPECT_TRUE(scene.report().valid()) << scene.report().violations[0].message;
  scene.options.rules.inflate_distance_cells = std::sqrt(5.0) - 1 + 0.125;
  const ValidationReport report = scene.report();
  ASSERT_EQ(report.violations.size(), 1u);
  EXPECT_EQ(report.violations[0].kind, ViolationKind::kSpacing);
  EXPECT_EQ(report.violations[0].agent, 1u);
  EXPECT_EQ(report.violations[0].other, 0u);
  EXPECT_NEAR(report.violations[0].depth_cells, 0.125, 1e-9);
  EXPECT_EQ(report.violations[0].time_s, 4);

  // The robot that stands does not count, although the other one passes it in contact.
  scene.options.order = {1, 0};
  scene.options.rules.inflate_distance_cells = 0.25;
  EXPECT_FALSE(scene.report().valid());
  scene.options.order = {};
  EXPECT_TRUE(scene.report().valid());
}

TEST(ValidatorSpacing, DistanceToObstaclesNeedsNoOrder) {
  Follower scene(4);
  DynamicObstacle obstacle;
  obstacle.radius_cells = 0.5;
  obstacle.trajectory.start = {4, 2};
  scene.instance.obstacles.push_back(obstacle);
  scene.options.order = {};
  scene.options.rules.inflate_distance_cells = 1;
  EXPECT_TRUE(scene.report().valid());
  scene.options.rules.inflate_distance_cells = 1.5;  // more than sqrt(2^2 + 1^2) - 1
  ASSERT_EQ(scene.report().violations.size(), 2u);
  EXPECT_NEAR(scene.report().violations[0].depth_cells, 0.5, 1e-12);
  EXPECT_NEAR(scene.report().violations[1].depth_cells, 2.5 - std::sqrt(5.0), 1e-12);
}

TEST(ValidatorSpacing, TimeIsKeptBeforeAndAfter) {
  // Robot 1 comes to (2, 0) at 5 s; robot 0 has left the reach of that place at 3 s.
  Follower scene(4);
  scene.options.order = {};
  scene.options.rules.inflate_time_s = 1;
  EXPECT_TRUE(scene.report().valid()) << scene.report().violations[0].message;
  scene.options.rules.inflate_time_s = 2.5;
  const ValidationReport report = scene.report();
  ASSERT_EQ(report.violations.size(), 1u);
  EXPECT_EQ(report.violations[0].kind, ViolationKind::kSpacing);
  EXPECT_GT(report.violations[0].depth_cells, 0.1);
  // The rule is the same for either order.
  std::swap(scene.instance.agents[0], scene.instance.agents[1]);
  std::swap(scene.solution.trajectories[0], scene.solution.trajectories[1]);
  ASSERT_EQ(scene.report().violations.size(), 1u);
  EXPECT_NEAR(scene.report().violations[0].depth_cells, report.violations[0].depth_cells, 1e-12);
}

TEST(ValidatorSpacing, ClosestOfTwoTimesIsFoundInsideAndAtTheBorder) {
  const LinearMotion right{0, 10, {0, 0}, {1, 0}};
  const LinearMotion up{0, 10, {5, 5}, {0, -1}};
  EXPECT_EQ(closest_within(right, up, 0).distance_cells, 0);  // both at (5, 0) after 5 s
  const LinearMotion later{3, 13, {5, 5}, {0, -1}};           // there after 8 s
  EXPECT_NEAR(closest_within(right, later, 3).distance_cells, 0, 1e-12);
  EXPECT_NEAR(closest_within(right, later, 1).distance_cells, std::sqrt(2.0), 1e-12);
  EXPECT_NEAR(closest_within(right, later, 0).distance_cells, 3 / std::sqrt(2.0), 1e-12);
  const LinearMotion rest{20, kInfinity, {10, 2}, {}};
  EXPECT_EQ(closest_within(right, rest, 9.5).distance_cells, kInfinity);
  EXPECT_EQ(closest_within(right, rest, 10).distance_cells, 2);
  EXPECT_EQ(closest_within(rest, rest, 1).distance_cells, 0);
}

/// Against many pairs of times.
TEST(ValidatorSpacing, ClosestOfTwoTimesIsThatOfManySamples) {
  const LinearMotion motions[] = {{0, 4, {0, 0}, {1, 0.5}}, {1, 3, {3, -1}, {-0.5, 2}},
                                  {2, 5, {4, 2}, {}},       {0.5, 6, {-1, 2}, {1, -1}},
                                  {0, 2, {2, 2}, {-2, -2}}, {3, 7, {1, 1}, {0.25, 0}}};
  constexpr int kSteps = 60;
  for (const LinearMotion& a : motions) {
    for (const LinearMotion& b : motions) {
      for (const double apart_s : {0.0, 0.5, 1.75, 6.0}) {
        double sampled = kInfinity;
        for (int i = 0; i <= kSteps; ++i) {
          for (int k = 0; k <= kSteps; ++k) {
            const double a_s = a.begin_s + (a.end_s - a.begin_s) * i / kSteps;
            const double b_s = b.begin_s + (b.end_s - b.begin_s) * k / kSteps;
            if (std::abs(a_s - b_s) <= apart_s) sampled = std::min(sampled, norm(a.at(a_s) - b.at(b_s)));
          }
        }
        const double found = closest_within(a, b, apart_s).distance_cells;
        EXPECT_LE(found, sampled + 1e-12);
        if (apart_s > 0 && sampled < kInfinity) {
          EXPECT_GE(found, sampled - 0.3);
        }
      }
    }
  }
}

}  // namespace
}  // namespace sipplab
