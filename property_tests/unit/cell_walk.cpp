// The cells under a move: all of them, in order, each for as long as it lasts.
#include "planner/reservation/cell_walk.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <vector>

namespace sipplab {
namespace {

constexpr std::int32_t kSide = 13;

std::vector<CellVisit> visits_of(const Move& move) {
  const GridMap map(kSide, kSide);
  std::vector<CellVisit> visits;
  for (CellWalk walk(map, move); !walk.done();) visits.push_back(walk.next());
  return visits;
}

/// How far outside the cell's square a place is, in cells.
double outside(Vec2 place, Cell cell) {
  const Vec2 apart = place - centre(cell);
  return std::max(std::abs(apart.x), std::abs(apart.y)) - 0.5;
}

TEST(CellWalk, CoversEveryMoveWithoutGap) {
  constexpr double kRounding = 1e-12;
  constexpr double kSpeed = 0.75;
  const GridMap map(kSide, kSide);
  const Cell from{6, 6};
  for (std::size_t i = 0; i < map.cell_count(); ++i) {
    const Cell to = map.cell(i);
    if (to == from) continue;
    const Move move(Displacement(centre(from), centre(to)), kSpeed);
    const std::vector<CellVisit> visits = visits_of(move);
    ASSERT_FALSE(visits.empty());
    EXPECT_EQ(visits.front().cell, map.index(from));
    EXPECT_EQ(visits.front().enter_s, 0);
    EXPECT_EQ(visits.back().cell, map.index(to));
    EXPECT_EQ(visits.back().leave_s, move.duration);
    for (std::size_t v = 0; v < visits.size(); ++v) {
      const double enter_s = v > 0 ? visits[v - 1].leave_s : 0;
      EXPECT_EQ(visits[v].enter_s, enter_s);
      EXPECT_LE(visits[v].enter_s, visits[v].leave_s);
      for (const double time_s : {visits[v].enter_s, visits[v].leave_s}) {
        EXPECT_LE(outside(move.way.from + move.velocity * time_s, map.cell(visits[v].cell)), kRounding);
      }
    }
  }
}

TEST(CellWalk, CrossesACornerByWayOfOneCellBesideIt) {
  const std::vector<CellVisit> visits = visits_of({Displacement({0, 0}, {1, 1}), 1});
  ASSERT_EQ(visits.size(), 3u);
  EXPECT_EQ(visits[1].enter_s, visits[1].leave_s);
}

}  // namespace
}  // namespace sipplab
