// Directions between cells and turns between directions.
#include "planner/grid/heading.hpp"

#include <gtest/gtest.h>

namespace sipplab {
namespace {

TEST(Heading, CountsCounterClockwiseFromGrowingX) {
  const struct {
    Cell to;
    double heading_deg;
  } kTable[] = {{{7, 5}, 0},   {{7, 3}, 45},  {{5, 3}, 90},  {{3, 3}, 135},
                {{3, 5}, 180}, {{3, 7}, 225}, {{5, 7}, 270}, {{7, 7}, 315}};
  for (const auto& row : kTable) EXPECT_EQ(heading_deg({5, 5}, row.to), row.heading_deg);
  EXPECT_NEAR(heading_deg({0, 0}, {2, -1}), 26.565051177077990, 1e-12);
  EXPECT_NEAR(heading_deg({53, 9}, {36, 12}), 190.007979801441, 1e-11);  // down and to the left
  EXPECT_NEAR(heading_deg({0, 0}, {2, 1}), 333.43494882292202, 1e-12);
}

TEST(Heading, OneDirectionIsOneNumber) {
  for (std::int32_t x = -5; x <= 5; ++x) {
    for (std::int32_t y = -5; y <= 5; ++y) {
      if (x == 0 && y == 0) continue;
      const double once = heading_deg({0, 0}, {x, y});
      EXPECT_GE(once, 0);
      EXPECT_LT(once, 360);
      for (const std::int32_t times : {2, 3, 7, 1000}) {
        EXPECT_EQ(heading_deg({1, 2}, {1 + x * times, 2 + y * times}), once) << x << " " << y;
      }
    }
  }
}

TEST(Heading, AnyTwoCellsWillDo) {
  constexpr std::int32_t kMost = 2147483647;
  EXPECT_EQ(heading_deg({-kMost, -kMost}, {kMost, kMost}), 315);
  EXPECT_EQ(heading_deg({kMost, 0}, {-kMost, 0}), 180);
}

TEST(Heading, IsTheSameWhenRemembered) {
  const Headings headings;
  constexpr std::int32_t kMost = 40;  // more displacements than are remembered
  for (int time = 0; time < 2; ++time) {
    for (std::int32_t x = -kMost; x <= kMost; ++x) {
      for (std::int32_t y = -kMost; y <= kMost; ++y) {
        if (x == 0 && y == 0) continue;
        const double once = heading_deg({0, 0}, {x, y});
        ASSERT_EQ(headings.deg({0, 0}, {x, y}), once) << x << " " << y;
        ASSERT_EQ(headings.deg({50, 60}, {50 + x, 60 + y}), once) << x << " " << y;
      }
    }
  }
}

TEST(Heading, TurnsTheShorterWay) {
  EXPECT_EQ(turn_deg(10, 350), 20);
  EXPECT_EQ(turn_deg(350, 10), 20);
  EXPECT_EQ(turn_deg(0, 180), 180);
  EXPECT_EQ(turn_deg(90, 315), 135);
  EXPECT_EQ(turn_deg(45, 45), 0);
}

}  // namespace
}  // namespace sipplab
