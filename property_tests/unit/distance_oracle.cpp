// The model itself: cases that can be worked out by hand, and sampling.
#include "property_tests/support/distance_oracle.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "planner/core/random.hpp"

namespace sipplab {
namespace {

TEST(ClosestApproach, OfTwoThatPassAtRightAngles) {
  const Leg right{{-2, 0}, {2, 0}, 0, 4};
  const Leg down{{0, -3}, {0, 1}, 0, 4};
  // Both pass the origin, one second apart.
  EXPECT_NEAR(closest_approach(right, down), std::sqrt(0.5), 1e-12);
  EXPECT_NEAR(closest_approach(down, right), std::sqrt(0.5), 1e-12);
}

TEST(ClosestApproach, CountsOnlyTheTimeThatBothLast) {
  const Leg early{{0, 0}, {4, 0}, 0, 4};
  EXPECT_EQ(closest_approach(early, {{3, 0}, {3, 0}, 0, 1}), 2);
  EXPECT_EQ(closest_approach(early, {{0, 0}, {0, 0}, 4, 5}), 4);
  EXPECT_EQ(closest_approach(early, {{0, 0}, {0, 0}, 4.5, 5}), kForever);
  EXPECT_EQ(closest_approach(leg_at({0, 3}), leg_at({4, 0})), 5);
}

TEST(ClosestApproach, IsWhatSamplesApproach) {
  constexpr int kPairs = 300;
  constexpr int kSamples = 2000;
  Random random(5);
  const auto place = [&] { return Vec2{8 * random.unit(), 8 * random.unit()}; };
  for (int pair = 0; pair < kPairs; ++pair) {
    const Leg a{place(), place(), 0, 4};
    const Leg b{place(), place(), 2 * random.unit(), 5};
    double least = kForever;
    for (int i = 0; i <= kSamples; ++i) {
      const double time_s = b.begin_s + (4 - b.begin_s) * i / kSamples;
      const Vec2 at_a = a.from + (a.to - a.from) * (time_s / 4);
      const Vec2 at_b = b.from + (b.to - b.from) * ((time_s - b.begin_s) / (5 - b.begin_s));
      least = std::min(least, norm(at_a - at_b));
    }
    EXPECT_LE(closest_approach(a, b), least + 1e-12);
    EXPECT_GE(closest_approach(a, b), least - 0.02);
  }
}

TEST(BisectDepartures, FindsWhenACrossingIsFree) {
  // Two unit disks whose paths cross at right angles: unsafe while they are less than
  // sqrt 2 seconds apart in the middle.
  const Move move(Displacement({0, -5}, {0, 5}), 1);
  const MovingDisk disk = MovingDisk::moving(Displacement({-5, 0}, {5, 0}), 10, 20, 0.5);
  const BisectedSpan span = bisect_departures(move, disk, 1);
  ASSERT_FALSE(span.empty);
  EXPECT_TRUE(span.contact_begin && span.contact_end);
  EXPECT_NEAR(span.begin_s, 10 - std::sqrt(2.0), 1e-9);
  EXPECT_NEAR(span.end_s, 10 + std::sqrt(2.0), 1e-9);
}

TEST(BisectDepartures, EndsWhereARestBeginsOrNever) {
  const Move move(Displacement({0, 0}, {4, 0}), 1);
  const BisectedSpan span = bisect_departures(move, MovingDisk::resting({4, 0}, 7, kForever, 0.5), 1);
  ASSERT_FALSE(span.empty);
  EXPECT_FALSE(span.contact_begin || span.contact_end);
  EXPECT_EQ(span.begin_s, 3);
  EXPECT_EQ(span.end_s, kForever);
}

TEST(BisectDepartures, TouchingIsNoOverlap) {
  const Move move(Displacement({0, 0}, {4, 0}), 1);
  EXPECT_TRUE(bisect_departures(move, MovingDisk::resting({2, 1}, 0, kForever, 0.5), 1).empty);
}

TEST(BisectCollision, IsTheTimeOfPassing) {
  const MovingDisk disk = MovingDisk::moving(Displacement({-5, 0}, {5, 0}), 0, 5, 0.5);
  const BisectedSpan span = bisect_collision({0, 0}, disk, 1);
  ASSERT_FALSE(span.empty);
  EXPECT_NEAR(span.begin_s, 2, 1e-9);
  EXPECT_NEAR(span.end_s, 3, 1e-9);
}

}  // namespace
}  // namespace sipplab
