// Adaptive choice among a few ways to do something, by what each has gained (Ropke and Pisinger 2006).
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

/// A roulette wheel over `kWays` ways: favours those that gain most for their work.
template <std::size_t kWays>
class Roulette {
 public:
  Roulette() { weights_.fill(1); }

  std::size_t draw(Random& random) const { return draw_by(weights_, random); }

  /// `gain` >= 0, per unit of work, in any unit.
  void learn(std::size_t way, double gain) {
    scale_ = std::max(scale_ * kScaleDecay, gain);
    const double share = scale_ > 0 ? gain / scale_ : 0;
    weights_[way] = std::max(weights_[way] * (1 - kLearningRate) + share * kLearningRate, kLeastWeight);
  }

 private:
  /// Share of the last gain in a weight.
  static constexpr double kLearningRate = 0.02;
  /// Least weight, the greatest being 1: no way is given up for good.
  static constexpr double kLeastWeight = 0.05;
  /// Factor by which the greatest gain decays with each draw.
  static constexpr double kScaleDecay = 0.999;

  std::array<double, kWays> weights_;
  double scale_ = 0;  ///< greatest recent gain, so that weights do not depend on units
};

}  // namespace sipplab
