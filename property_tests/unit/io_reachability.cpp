// Which goals can be reached: exact for small disks, careful for large ones.
#include "planner/instance/reachability.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "planner/core/random.hpp"

namespace sipplab {
namespace {

/// '#' is blocked.
GridMap map_of(const std::vector<std::string>& rows) {
  GridMap map(static_cast<std::int32_t>(rows[0].size()), static_cast<std::int32_t>(rows.size()));
  for (std::size_t i = 0; i < map.cell_count(); ++i) {
    const Cell cell = map.cell(i);
    const char c = rows[static_cast<std::size_t>(cell.y)][static_cast<std::size_t>(cell.x)];
    map.set_blocked(cell, c == '#');
  }
  return map;
}

bool is_reachable(const GridMap& map, double radius_cells, Cell start, Cell goal) {
  Instance instance;
  instance.map = map;
  instance.agents = {{"0", start, goal, radius_cells, 1, 0, std::nullopt, 1}};
  return !find_unreachable_goal(instance);
}

TEST(IoReachability, CornersThatTouchLeaveNoGap) {
  const GridMap map = map_of({".#", "#."});
  for (const double radius_cells : {0.01, 0.3, 0.5}) {
    EXPECT_FALSE(is_reachable(map, radius_cells, {0, 0}, {1, 1})) << radius_cells;
  }
}

TEST(IoReachability, ACorridorMustBeAsWideAsTheDisk) {
  const GridMap map = map_of({".....", ".....", ".....", "##.##", ".....", ".....", "....."});
  EXPECT_TRUE(is_reachable(map, 0.5, {1, 1}, {1, 5}));
  EXPECT_FALSE(is_reachable(map, 0.75, {1, 1}, {1, 5}));
  EXPECT_FALSE(is_reachable(map, 1.5, {1, 1}, {1, 5}));
  EXPECT_TRUE(is_reachable(map, 1.5, {1, 1}, {3, 1}));
}

TEST(IoReachability, TouchingIsAllowedAtWallsAndCorners) {
  // Radius 1.5 fits exactly into a corridor of three cells.
  const GridMap map = map_of({"#####", ".....", ".....", ".....", "#####"});
  const std::vector<std::uint32_t> labels = standing_components(map, 1.5);
  for (std::int32_t y = 0; y < 5; ++y) {
    for (std::int32_t x = 0; x < 5; ++x) {
      EXPECT_EQ(labels[map.index({x, y})] != 0, y == 2 && x >= 1 && x <= 3) << x << ", " << y;
    }
  }
}

TEST(IoReachability, DiagonalMovesOfLargeDisksAreNotCalledImpossible) {
  // Radius 0.6 gets from (1, 1) to (2, 2) in a straight line and over no cell between.
  const GridMap map = map_of({"....", "...#", "#...", "...."});
  const std::vector<std::uint32_t> labels = standing_components(map, 0.6);
  ASSERT_NE(labels[map.index({1, 1})], 0u);
  ASSERT_NE(labels[map.index({2, 2})], 0u);
  ASSERT_NE(labels[map.index({1, 1})], labels[map.index({2, 2})]);
  EXPECT_TRUE(is_reachable(map, 0.6, {1, 1}, {2, 2}));
}

TEST(IoReachability, ComponentsAreNumberedInRowMajorOrder) {
  const GridMap map = map_of({".#.", ".#.", "#.#"});
  EXPECT_EQ(standing_components(map, 0.5), (std::vector<std::uint32_t>{1, 0, 2, 1, 0, 2, 0, 3, 0}));
}

/// Distance from the centre of one cell to the unit square around another's.
double square_distance(Cell cell, Cell square) {
  const double dx = std::max(0.0, std::abs(square.x - cell.x) - 0.5);
  const double dy = std::max(0.0, std::abs(square.y - cell.y) - 0.5);
  return std::sqrt(dx * dx + dy * dy);
}

TEST(IoReachability, StandingAgreesWithAskingEveryCell) {
  Random random(7);
  for (int round = 0; round < 60; ++round) {
    GridMap map(static_cast<std::int32_t>(3 + random.below(9)),
                static_cast<std::int32_t>(3 + random.below(9)));
    for (std::size_t i = 0; i < map.cell_count(); ++i) map.set_blocked(map.cell(i), random.below(12) == 0);
    const double radius_cells = static_cast<double>(1 + random.below(16)) / 8;
    const std::vector<std::uint32_t> labels = standing_components(map, radius_cells);
    for (std::size_t i = 0; i < map.cell_count(); ++i) {
      const Cell cell = map.cell(i);
      bool may_stand = true;
      for (std::int32_t y = -3; y < map.height() + 3; ++y) {
        for (std::int32_t x = -3; x < map.width() + 3; ++x) {
          const bool blocked = !map.contains({x, y}) || map.is_blocked({x, y});
          if (blocked && square_distance(cell, {x, y}) < radius_cells - 1e-9) may_stand = false;
        }
      }
      EXPECT_EQ(labels[i] != 0, may_stand) << "radius " << radius_cells << " at " << cell.x << ", " << cell.y;
    }
  }
}

TEST(IoReachability, NamesTheFirstAgentInInputOrder) {
  Instance instance;
  instance.map = map_of({"..#..", "..#.."});
  instance.agents = {{"a", {0, 0}, {1, 0}, 0.5, 1, 0, std::nullopt, 1},
                     {"b", {0, 1}, {3, 0}, 0.25, 1, 0, std::nullopt, 1},
                     {"c", {3, 1}, {1, 1}, 0.5, 1, 0, std::nullopt, 1}};
  const auto error = find_unreachable_goal(instance);
  ASSERT_TRUE(error);
  EXPECT_EQ(error->agent, 1u);
  EXPECT_EQ(error->what, "agent b: goal (3, 0) cannot be reached from start (0, 1)");
}

}  // namespace
}  // namespace sipplab
