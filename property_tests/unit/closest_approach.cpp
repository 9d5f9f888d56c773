// Two moving points, and a moving disk against unit squares.
#include "planner/validator/closest_approach.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "planner/validator/static_clearance.hpp"

namespace sipplab {
namespace {

TEST(ClosestApproach, OfPointsThatCross) {
  const LinearMotion east{0, 4, {0, 0}, {1, 0}};
  const LinearMotion south{0, 4, {2, -2}, {0, 1}};
  const auto approach = closest_approach(east, south);
  ASSERT_TRUE(approach);
  EXPECT_DOUBLE_EQ(approach->time_s, 2);
  EXPECT_DOUBLE_EQ(approach->distance_cells, 0);
}

TEST(ClosestApproach, IsClampedToTheTimeThatBothShare) {
  const LinearMotion east{0, 1, {0, 0}, {1, 0}};
  const LinearMotion rest{0.5, 8, {4, 0}, {}};
  const auto approach = closest_approach(east, rest);
  ASSERT_TRUE(approach);
  EXPECT_DOUBLE_EQ(approach->time_s, 1);
  EXPECT_DOUBLE_EQ(approach->distance_cells, 3);
  EXPECT_FALSE(closest_approach(east, LinearMotion{1.5, 2, {0, 0}, {}}));
}

TEST(ClosestApproach, OfTouchingSpansIsTheSharedMoment) {
  const auto approach =
      closest_approach(LinearMotion{0, 1, {0, 0}, {1, 0}}, LinearMotion{1, 2, {3, 0}, {1, 0}});
  ASSERT_TRUE(approach);
  EXPECT_DOUBLE_EQ(approach->time_s, 1);
  EXPECT_DOUBLE_EQ(approach->distance_cells, 2);
}

TEST(ClosestApproach, OfParallelMotionIsTakenAtTheBegin) {
  const auto approach =
      closest_approach(LinearMotion{0, 9, {0, 0}, {1, 0}}, LinearMotion{3, 9, {3, 1}, {1, 0}});
  ASSERT_TRUE(approach);
  EXPECT_DOUBLE_EQ(approach->time_s, 3);
  EXPECT_DOUBLE_EQ(approach->distance_cells, 1);
}

TEST(ClosestApproach, OfBodiesAtRestForEver) {
  const auto approach =
      closest_approach(LinearMotion{2, std::numeric_limits<double>::infinity(), {0, 0}, {}},
                       LinearMotion{5, std::numeric_limits<double>::infinity(), {3, 4}, {}});
  ASSERT_TRUE(approach);
  EXPECT_DOUBLE_EQ(approach->time_s, 5);
  EXPECT_DOUBLE_EQ(approach->distance_cells, 5);
}

TEST(DistanceToSquare, FromEachSide) {
  EXPECT_DOUBLE_EQ(distance_to_square({-3, 0}, {-2, 0}, {0, 0}).distance_cells, 1.5);
  EXPECT_DOUBLE_EQ(distance_to_square({-3, 0}, {-2, 0}, {0, 0}).at, 1);
  // A corner is nearest, in the middle of the segment.
  const SegmentDistance corner = distance_to_square({0, -1.5}, {1.5, 0}, {0, 0});
  EXPECT_NEAR(corner.distance_cells, 0.5 * std::sqrt(0.5), 1e-15);
  EXPECT_NEAR(corner.at, 0.5, 1e-15);
}

TEST(DistanceToSquare, IsZeroWhereTheSegmentRunsThrough) {
  const SegmentDistance through = distance_to_square({-2, 0}, {2, 0}, {0, 0});
  EXPECT_EQ(through.distance_cells, 0);
  EXPECT_DOUBLE_EQ(through.at, 0.5);
  EXPECT_EQ(distance_to_square({0, 0}, {0, 0}, {0, 0}).distance_cells, 0);
}

TEST(StaticOverlap, OfASweptDiskIsTheDeepestOnItsWay) {
  GridMap map(7, 7);
  map.set_blocked({3, 4}, true);
  // Passes the blocked cell's upper side at distance 0.5.
  EXPECT_LE(deepest_static_overlap(map, {1, 3}, {5, 3}, 0.5).depth_cells, 0);
  const StaticOverlap overlap = deepest_static_overlap(map, {1, 3}, {5, 3}, 0.75);
  EXPECT_DOUBLE_EQ(overlap.depth_cells, 0.25);
  EXPECT_FALSE(overlap.outside);
  EXPECT_EQ(overlap.blocked, (Cell{3, 4}));
}

TEST(StaticOverlap, SeesTheBorderOfTheGrid) {
  const GridMap map(5, 5);
  EXPECT_LE(deepest_static_overlap(map, {0, 0}, {4, 4}, 0.5).depth_cells, 0);
  const StaticOverlap wide = deepest_static_overlap(map, {2, 2}, {2, 4}, 0.75);
  EXPECT_TRUE(wide.outside);
  EXPECT_DOUBLE_EQ(wide.depth_cells, 0.25);
  EXPECT_DOUBLE_EQ(wide.at, 1);
  EXPECT_TRUE(deepest_static_overlap(map, {2, 2}, {-9, 2}, 0.5).outside);
}

}  // namespace
}  // namespace sipplab
