// What recorded results say: adjusted p values, and losses that are seen.
#include "bench/judge/evidence.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <cstdint>
#include <vector>

#include "bench/judge/difference.hpp"
#include "db/statistics/statistics.hpp"
#include "planner/core/random.hpp"

namespace sipplab::bench {
namespace {

TEST(Evidence, HolmMultipliesByTheTestsThatAreLeft) {
  EXPECT_EQ(holm({0.01, 0.5, 0.02}), (std::vector<double>{0.03, 0.5, 0.04}));
  EXPECT_EQ(holm({0.4, 0.3}), (std::vector<double>{0.6, 0.6}));
}

TEST(Evidence, LossesThatAreSeenAreThoseThatTheTestFinds) {
  // A hundred instances of nine plannings, of which two lose one and two gain one by chance.
  std::vector<double> nets(100, 0.0);
  nets[0] = nets[1] = 1;
  nets[2] = nets[3] = -1;
  const double level = kRecordedLevel / 7;
  const double share = detectable_losses(nets, 900, level, 0.01);
  EXPECT_NEAR(share, 0.0279, 0.0005);
  Random random(3);
  int found = 0;
  constexpr int kTrials = 400;
  for (int trial = 0; trial < kTrials; ++trial) {
    std::vector<std::int64_t> drawn(100, 0);
    for (std::size_t i = 0; i < 100; ++i) {
      drawn[i] = static_cast<std::int64_t>(random.below(2) == 0 ? nets[i] : -nets[i]);
      for (int planning = 0; planning < 9; ++planning) drawn[i] += random.unit() < share ? 1 : 0;
    }
    found += db::statistics::sign_flips(drawn) <= level ? 1 : 0;
  }
  EXPECT_GE(found, kTrials * 95 / 100);
  EXPECT_LE(found, kTrials * 99 / 100);
  EXPECT_TRUE(std::isinf(detectable_losses({0, 0, 0, 0, 0}, 45, level, 0)));
}

}  // namespace
}  // namespace sipplab::bench
