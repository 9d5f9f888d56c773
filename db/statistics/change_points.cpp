// E-divisive for numbers: sums of distances come from two Fenwick trees over ranks.
#include "db/statistics/change_points.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "planner/core/random.hpp"

namespace sipplab::db::statistics {
namespace {

/// Permutations are counted until this many were at least as divided as the series: more
/// would not make a p value significant again (Besag & Clifford 1991).
constexpr std::uint64_t kEnoughExceedances = 20;
/// p values reach down to 1e-4, which Benjamini and Hochberg need for a thousand series.
constexpr double kMostPermutations = 9'999;
constexpr double kFewestPermutations = 199;
/// Steps of a Fenwick tree for one test, about 0.1 s: long series get fewer permutations.
constexpr double kStepsPerTest = 2e7;

/// Counts and sums of the values up to a rank.
class RankedSums {
 public:
  explicit RankedSums(std::size_t size) : counts_(size + 1), sums_(size + 1) {}

  void clear() {
    std::fill(counts_.begin(), counts_.end(), 0.0);
    std::fill(sums_.begin(), sums_.end(), 0.0);
    count_ = sum_ = 0;
  }
  void add(std::size_t rank, double value) {
    for (std::size_t i = rank + 1; i < counts_.size(); i += i & (~i + 1)) {
      counts_[i] += 1;
      sums_[i] += value;
    }
    count_ += 1;
    sum_ += value;
  }
  /// Sum of the distances between `value`, of that rank, and all that were added.
  double distances(std::size_t rank, double value) const {
    double count = 0;
    double sum = 0;
    for (std::size_t i = rank + 1; i > 0; i -= i & (~i + 1)) {
      count += counts_[i];
      sum += sums_[i];
    }
    return value * count - sum + (sum_ - sum) - value * (count_ - count);
  }

 private:
  std::vector<double> counts_;
  std::vector<double> sums_;
  double count_ = 0;
  double sum_ = 0;
};

struct Best {
  std::size_t position = 0;
  double strength = 0;
};

/// One part of the series, which it can divide in any order of its points.
class Part {
 public:
  Part(const std::vector<double>& values, std::size_t begin, std::size_t end)
      : values_(values.begin() + static_cast<std::ptrdiff_t>(begin),
                values.begin() + static_cast<std::ptrdiff_t>(end)),
        ranks_(values_.size()),
        order_(values_.size()),
        within_(values_.size() + 1),
        sums_(values_.size()) {
    // Distances do not change, and sums keep their precision far away from 0.
    const double middle = values_[values_.size() / 2];
    for (double& value : values_) value -= middle;
    std::vector<std::size_t> sorted(values_.size());
    std::iota(sorted.begin(), sorted.end(), std::size_t{0});
    std::stable_sort(sorted.begin(), sorted.end(),
                     [this](std::size_t a, std::size_t b) { return values_[a] < values_[b]; });
    for (std::size_t rank = 0; rank < sorted.size(); ++rank) ranks_[sorted[rank]] = rank;
    std::iota(order_.begin(), order_.end(), std::size_t{0});
  }

  std::size_t size() const { return values_.size(); }
  bool constant() const {
    return std::all_of(values_.begin(), values_.end(), [this](double value) { return value == values_[0]; });
  }

  void shuffle(Random& random) { random.shuffle(order_); }

  /// The division that is strongest in the present order.
  Best best(std::size_t min_segment) {
    const std::size_t n = size();
    // within_[k]: distances among the last n - k points, then among the first k.
    sums_.clear();
    within_[n] = 0;
    for (std::size_t k = n; k-- > 0;) {
      within_[k] = within_[k + 1] + sums_.distances(ranks_[order_[k]], values_[order_[k]]);
      sums_.add(ranks_[order_[k]], values_[order_[k]]);
    }
    const double all = within_[0];
    sums_.clear();
    Best found;
    double before = 0;
    for (std::size_t k = 0; k < n; ++k) {
      if (k >= min_segment && n - k >= min_segment) {
        const double strength = strength_of(k, before, within_[k], all - before - within_[k]);
        if (strength > found.strength) found = {k, strength};
      }
      before += sums_.distances(ranks_[order_[k]], values_[order_[k]]);
      sums_.add(ranks_[order_[k]], values_[order_[k]]);
    }
    return found;
  }

 private:
  /// The scaled energy distance of the first k points and the others, from sums of distances.
  double strength_of(std::size_t k, double first, double last, double across) const {
    const auto m = static_cast<double>(k);
    const auto n = static_cast<double>(size() - k);
    const double energy = 2 * across / (m * n) - first / (m * (m - 1) / 2) - last / (n * (n - 1) / 2);
    return energy * m * n / (m + n);
  }

  std::vector<double> values_;
  std::vector<std::size_t> ranks_;
  std::vector<std::size_t> order_;
  std::vector<double> within_;
  RankedSums sums_;
};

std::uint64_t permutations_for(std::size_t size) {
  const auto n = static_cast<double>(size);
  return static_cast<std::uint64_t>(
      std::clamp(kStepsPerTest / (n * std::log2(n + 1)), kFewestPermutations, kMostPermutations));
}

Division test_part(const std::vector<double>& values, std::size_t begin, std::size_t end,
                   const ChangePointOptions& options) {
  Division division;
  Part part(values, begin, end);
  if (part.constant()) return division;
  const Best found = part.best(options.min_segment);
  if (found.strength <= 0) return division;
  // Sums of the same distances in another order differ in their last bits.
  constexpr double kRounding = 1 - 1e-9;
  Random random(options.seed + begin * 1'000'003 + end);
  const std::uint64_t permutations = permutations_for(part.size());
  std::uint64_t exceedances = 0;
  std::uint64_t tried = 0;
  while (tried < permutations && exceedances < kEnoughExceedances) {
    part.shuffle(random);
    ++tried;
    if (part.best(options.min_segment).strength >= found.strength * kRounding) ++exceedances;
  }
  division.position = begin + found.position;
  division.p_value = exceedances >= kEnoughExceedances
                         ? static_cast<double>(exceedances) / static_cast<double>(tried)
                         : static_cast<double>(exceedances + 1) / static_cast<double>(tried + 1);
  division.accepted = division.p_value <= options.significance;
  return division;
}

void divide_part(const std::vector<double>& values, std::size_t begin, std::size_t end,
                 const ChangePointOptions& options, std::vector<Division>& divisions) {
  if (end - begin < 2 * options.min_segment) return;
  const Division division = test_part(values, begin, end, options);
  if (division.accepted) divide_part(values, begin, division.position, options, divisions);
  divisions.push_back(division);
  if (division.accepted) divide_part(values, division.position, end, options, divisions);
}

}  // namespace

std::vector<Division> divide(const std::vector<double>& values, const ChangePointOptions& options) {
  std::vector<Division> divisions;
  divide_part(values, 0, values.size(), options, divisions);
  return divisions;
}

std::vector<bool> benjamini_hochberg(const std::vector<double>& p_values, double rate) {
  std::vector<double> sorted = p_values;
  std::sort(sorted.begin(), sorted.end());
  double threshold = -1;
  for (std::size_t i = 0; i < sorted.size(); ++i) {
    const double bound = rate * static_cast<double>(i + 1) / static_cast<double>(sorted.size());
    if (sorted[i] <= bound) threshold = sorted[i];
  }
  std::vector<bool> stands;
  for (const double p : p_values) stands.push_back(p <= threshold);
  return stands;
}

}  // namespace sipplab::db::statistics
