// The table of neighbours: complete, symmetric, nested.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <span>
#include <vector>

#include "planner/grid/neighbourhood.hpp"
#include "property_tests/support/exhaustive_search.hpp"

namespace sipplab {
namespace {

std::vector<Cell> sorted(std::span<const Cell> cells) {
  std::vector<Cell> copy(cells.begin(), cells.end());
  std::sort(copy.begin(), copy.end());
  return copy;
}

TEST(Neighbourhood, HasTwoToTheKMoves) {
  for (int k = kMinConnectedness; k <= kMaxConnectedness; ++k) {
    EXPECT_EQ(neighbourhood(k).size(), std::size_t{1} << k);
  }
}

TEST(Neighbourhood, IsWhatSplittingSectorsGives) {
  for (int k = kMinConnectedness; k <= kMaxConnectedness; ++k) {
    EXPECT_EQ(sorted(neighbourhood(k)), sorted(mediant_neighbourhood(k))) << "k = " << k;
  }
}

TEST(Neighbourhood, BeginsWithThatOfSmallerK) {
  for (int k = kMinConnectedness; k < kMaxConnectedness; ++k) {
    const auto coarse = neighbourhood(k);
    const auto fine = neighbourhood(k + 1);
    EXPECT_TRUE(std::equal(coarse.begin(), coarse.end(), fine.begin()));
  }
}

TEST(Neighbourhood, LooksTheSameAfterAQuarterTurnAndInAMirror) {
  for (int k = kMinConnectedness; k <= kMaxConnectedness; ++k) {
    std::vector<Cell> turned;
    std::vector<Cell> mirrored;
    for (const Cell step : neighbourhood(k)) {
      turned.push_back({-step.y, step.x});
      mirrored.push_back({-step.x, step.y});
    }
    EXPECT_EQ(sorted(turned), sorted(neighbourhood(k)));
    EXPECT_EQ(sorted(mirrored), sorted(neighbourhood(k)));
  }
}

TEST(NeighbourhoodDistance, IsManhattanThenOctile) {
  EXPECT_EQ(neighbourhood_distance({2, 3}, {5, -1}, 2), 7);
  EXPECT_DOUBLE_EQ(neighbourhood_distance({2, 3}, {5, -1}, 3), 1 + 3 * std::sqrt(2.0));
  EXPECT_DOUBLE_EQ(neighbourhood_distance({0, 0}, {4, 2}, 4), 2 * std::sqrt(5.0));
  EXPECT_DOUBLE_EQ(neighbourhood_distance({0, 0}, {-3, 9}, 5), 3 * std::sqrt(10.0));
}

}  // namespace
}  // namespace sipplab
