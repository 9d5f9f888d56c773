// Adaptive choice among a few ways to do something, by what each has gained for its work (after Ropke and
// Pisinger 2006).
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
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

/// A roulette wheel over `kChoices` choices. A choice is worth its gain for its work, of late, and is drawn
/// by its worth over the root of the work of one draw. Drawn by worth alone, choices of much work take nearly
/// all of it; by worth over work, they are hardly tried once gains are rare. (Trials, 6 s each, against worth
/// alone: flowtime of 400 robots on random-32-32-20 -2.2 %, 400 on empty-32-32 -1.6 %, 300 on room-32-32-4
/// -2.1 %, 1,000 in a warehouse -1.9 %, 192 in the paper's +0.2 %. By worth over work: -2.7, -2.0, -2.8, -3.5
/// and +1.5 %.)
template <std::size_t kChoices>
class Roulette {
 public:
  std::size_t draw(Random& random) const {
    double best = 0;
    for (const Record& record : records_) best = std::max(best, record.worth());
    std::array<double, kChoices> weights{};
    double greatest = 0;
    for (std::size_t choice = 0; choice < kChoices; ++choice) {
      const Record& record = records_[choice];
      if (record.draws == 0) continue;
      const double share = best > 0 ? std::max(record.worth() / best, kLeastShare) : 1;
      weights[choice] = share / std::sqrt(record.work / record.draws);
      greatest = std::max(greatest, weights[choice]);
    }
    for (std::size_t choice = 0; choice < kChoices; ++choice) {
      if (records_[choice].draws == 0) weights[choice] = greatest > 0 ? greatest : 1;
    }
    return draw_by(weights, random);
  }

  /// `gain` >= 0 and `work` > 0, in any units.
  void learn(std::size_t choice, double gain, double work) {
    Record& record = records_[choice];
    record = {record.gain * kMemory + gain, record.work * kMemory + work, record.draws * kMemory + 1};
  }

 private:
  /// Sums over the draws of a choice.
  struct Record {
    double gain = 0;
    double work = 0;
    double draws = 0;

    double worth() const { return work > 0 ? gain / work : 0; }
  };
  /// What the past counts after each draw of a choice.
  static constexpr double kMemory = 0.99;
  /// What a choice is worth at least, the best being 1: none is given up for good.
  static constexpr double kLeastShare = 0.1;

  std::array<Record, kChoices> records_{};
};

}  // namespace sipplab
