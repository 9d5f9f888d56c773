// Adaptive choice among a few ways to do something, by what each has gained for its work (after Ropke and
// Pisinger 2006).
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <iterator>
#include <numeric>

#include "planner/core/random.hpp"

namespace sipplab {

/// Draws an index by weight. REQUIRES: some weight is above 0.
template <class Weights>
std::size_t draw_by(const Weights& weights, Random& random) {
  const double sum = std::accumulate(std::begin(weights), std::end(weights), 0.0);
  double left = random.unit() * sum;
  std::size_t drawn = 0;
  for (const double weight : weights) {
    left -= weight;
    if (left < 0) break;
    ++drawn;
  }
  return std::min(drawn, std::size(weights) - 1);
}

/// A roulette wheel over `kWays` ways: a way's share is its gain for its work, of late.
template <std::size_t kWays>
class Roulette {
 public:
  std::size_t draw(Random& random) const {
    std::array<double, kWays> weights{};
    double greatest = 0;
    for (std::size_t way = 0; way < kWays; ++way) {
      if (work_[way] > 0) weights[way] = gain_[way] / work_[way];
      greatest = std::max(greatest, weights[way]);
    }
    if (!(greatest > 0)) weights.fill(greatest = 1);
    for (std::size_t way = 0; way < kWays; ++way) {
      weights[way] = work_[way] > 0 ? std::max(weights[way], kLeastWeight * greatest) : greatest;
    }
    return draw_by(weights, random);
  }

  /// `gain` >= 0 and `work` > 0, in any units.
  void learn(std::size_t way, double gain, double work) {
    gain_[way] = gain_[way] * kMemory + gain;
    work_[way] = work_[way] * kMemory + work;
  }

 private:
  /// What the past counts after each draw of a way.
  static constexpr double kMemory = 0.99;
  /// Least weight, the greatest being 1: no way is given up for good.
  static constexpr double kLeastWeight = 0.1;

  std::array<double, kWays> gain_{};
  std::array<double, kWays> work_{};
};

}  // namespace sipplab
