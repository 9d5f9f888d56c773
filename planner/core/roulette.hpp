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

/// A roulette wheel over `kChoices` choices: a choice's share is its gain for its work, of late.
template <std::size_t kChoices>
class Roulette {
 public:
  std::size_t draw(Random& random) const {
    std::array<double, kChoices> weights{};
    double greatest = 0;
    for (std::size_t choice = 0; choice < kChoices; ++choice) {
      if (work_[choice] > 0) weights[choice] = gain_[choice] / work_[choice];
      greatest = std::max(greatest, weights[choice]);
    }
    if (!(greatest > 0)) weights.fill(greatest = 1);
    for (std::size_t choice = 0; choice < kChoices; ++choice) {
      weights[choice] = work_[choice] > 0 ? std::max(weights[choice], kLeastWeight * greatest) : greatest;
    }
    return draw_by(weights, random);
  }

  /// `gain` >= 0 and `work` > 0, in any units.
  void learn(std::size_t choice, double gain, double work) {
    gain_[choice] = gain_[choice] * kMemory + gain;
    work_[choice] = work_[choice] * kMemory + work;
  }

 private:
  /// What the past counts after each draw of a choice.
  static constexpr double kMemory = 0.99;
  /// Least weight, the greatest being 1: no choice is given up for good.
  static constexpr double kLeastWeight = 0.1;

  std::array<double, kChoices> gain_{};
  std::array<double, kChoices> work_{};
};

}  // namespace sipplab
