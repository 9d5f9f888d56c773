// Quantiles, means and tests on paired results.
#include "db/statistics/statistics.hpp"

#include <algorithm>
#include <cmath>

namespace sipplab::db::statistics {
namespace {

/// 2^-n is a normal double up to here, with room to spare.
constexpr std::uint64_t kCountedCoins = 1000;

/// P(X <= k) of n fair coins, for k <= n / 2.
double fair_coin_tail(std::uint64_t n, std::uint64_t k) {
  const auto coins = static_cast<double>(n);
  const auto heads = static_cast<double>(k);
  double sum = 0;
  if (n <= kCountedCoins) {
    // Binomial coefficients one from the other: exact as long as they fit 53 bits.
    double term = std::ldexp(1.0, -static_cast<int>(n));
    for (double i = 0; i <= heads; ++i) {
      sum += term;
      term = term * (coins - i) / (i + 1);
    }
    return sum;
  }
  // The largest term in logarithms, and the smaller ones from it.
  const double log_largest = std::lgamma(coins + 1) - std::lgamma(heads + 1) -
                             std::lgamma(coins - heads + 1) - coins * std::log(2.0);
  double ratio = 1;
  for (double i = heads; i >= 0 && ratio > 0; --i) {
    sum += ratio;
    ratio *= i / (coins - i + 1);
  }
  return std::exp(log_largest) * sum;
}

struct RankedDifferences {
  std::size_t count = 0;
  /// Twice the rank of each difference: an integer, although tied ranks are halves.
  std::vector<std::size_t> doubled_ranks;
  std::size_t doubled_positive = 0;  ///< sum over positive differences
  double tie_correction = 0;         ///< sum of t^3 - t over groups of t equal sizes
};

RankedDifferences rank(std::vector<double> differences) {
  std::erase(differences, 0.0);
  const auto by_size = [](double a, double b) { return std::abs(a) < std::abs(b); };
  std::sort(differences.begin(), differences.end(), by_size);
  RankedDifferences ranked;
  ranked.count = differences.size();
  for (std::size_t begin = 0; begin < differences.size();) {
    std::size_t end = begin;
    while (end < differences.size() && std::abs(differences[end]) == std::abs(differences[begin])) ++end;
    // Ranks begin + 1 .. end share their mean.
    const std::size_t doubled = begin + 1 + end;
    for (std::size_t i = begin; i < end; ++i) {
      ranked.doubled_ranks.push_back(doubled);
      if (differences[i] > 0) ranked.doubled_positive += doubled;
    }
    const auto tied = static_cast<double>(end - begin);
    ranked.tie_correction += tied * tied * tied - tied;
    begin = end;
  }
  return ranked;
}

/// Sum of all doubled ranks.
std::size_t doubled_total(const RankedDifferences& ranked) { return ranked.count * (ranked.count + 1); }

/// Counts out, for every sum, the share of sign patterns that give it.
double exact_wilcoxon(const RankedDifferences& ranked, std::size_t doubled_smaller) {
  std::vector<double> probability(doubled_total(ranked) + 1, 0.0);
  probability[0] = 1;
  std::size_t reach = 0;
  for (const std::size_t step : ranked.doubled_ranks) {
    reach += step;
    for (std::size_t sum = reach + 1; sum-- > 0;) {
      const double with = sum >= step ? probability[sum - step] : 0.0;
      probability[sum] = (probability[sum] + with) / 2;
    }
  }
  double tail = 0;
  for (std::size_t sum = 0; sum <= doubled_smaller; ++sum) tail += probability[sum];
  return std::min(1.0, 2 * tail);
}

double normal_wilcoxon(const RankedDifferences& ranked, std::size_t doubled_smaller) {
  const auto n = static_cast<double>(ranked.count);
  const double mean = n * (n + 1) / 4;
  const double variance = n * (n + 1) * (2 * n + 1) / 24 - ranked.tie_correction / 48;
  const double distance = std::max(0.0, mean - static_cast<double>(doubled_smaller) / 2 - 0.5);
  return std::erfc(distance / std::sqrt(variance) / std::sqrt(2.0));
}

}  // namespace

std::optional<double> quantile(std::vector<double> values, double p) {
  if (values.empty()) return std::nullopt;
  const double position = p * static_cast<double>(values.size() - 1);
  const auto below = static_cast<std::size_t>(position);
  const double weight = position - static_cast<double>(below);
  const auto lower = values.begin() + static_cast<std::ptrdiff_t>(below);
  std::nth_element(values.begin(), lower, values.end());
  if (weight == 0) return *lower;
  const double upper = *std::min_element(lower + 1, values.end());
  // Equal neighbours may be infinite, and their difference no number.
  if (*lower == upper) return upper;
  return *lower + weight * (upper - *lower);
}

std::optional<double> median(std::vector<double> values) { return quantile(std::move(values), 0.5); }

std::optional<double> geometric_mean(const std::vector<double>& values) {
  if (values.empty()) return std::nullopt;
  double sum = 0;
  for (const double value : values) {
    if (!(value > 0)) return std::nullopt;
    sum += std::log(value);
  }
  return std::exp(sum / static_cast<double>(values.size()));
}

std::optional<double> sign_test(std::uint64_t wins, std::uint64_t losses) {
  if (wins + losses == 0) return std::nullopt;
  if (wins == losses) return 1.0;
  return std::min(1.0, 2 * fair_coin_tail(wins + losses, std::min(wins, losses)));
}

double mcnemar(std::uint64_t lost, std::uint64_t gained) { return sign_test(lost, gained).value_or(1.0); }

std::optional<double> wilcoxon(const std::vector<double>& differences) {
  const RankedDifferences ranked = rank(differences);
  if (ranked.count == 0) return std::nullopt;
  const std::size_t doubled_smaller =
      std::min(ranked.doubled_positive, doubled_total(ranked) - ranked.doubled_positive);
  return ranked.count <= kExactWilcoxonLimit ? exact_wilcoxon(ranked, doubled_smaller)
                                             : normal_wilcoxon(ranked, doubled_smaller);
}

ConfidenceInterval wilson_interval(double held, double of) {
  if (of == 0) return {};
  constexpr double kNormalQuantile = 1.959963984540054;  // 95 %, two-sided
  const double rate = held / of;
  const double weight = kNormalQuantile * kNormalQuantile / of;
  const double middle = (rate + weight / 2) / (1 + weight);
  const double half = kNormalQuantile * std::sqrt(rate * (1 - rate) / of + weight / (4 * of)) / (1 + weight);
  // Exact at the ends, where rounding leaves a trace.
  return {held == 0 ? 0.0 : std::max(0.0, middle - half), held == of ? 1.0 : std::min(1.0, middle + half)};
}

double t_quantile(double freedom) {
  constexpr double z = 1.959964;
  constexpr double z2 = z * z;
  constexpr double first = z * (z2 + 1) / 4;
  constexpr double second = z * ((5 * z2 + 16) * z2 + 3) / 96;
  constexpr double third = z * (((3 * z2 + 19) * z2 + 17) * z2 - 15) / 384;
  constexpr double fourth = z * ((((79 * z2 + 776) * z2 + 1482) * z2 - 1920) * z2 - 945) / 92160;
  return z + (first + (second + (third + fourth / freedom) / freedom) / freedom) / freedom;
}

std::optional<double> par2(const std::vector<TimedResult>& results) {
  if (results.empty()) return std::nullopt;
  double sum = 0;
  for (const TimedResult& result : results) sum += result.solved ? result.time_s : 2 * result.limit_s;
  return sum / static_cast<double>(results.size());
}

}  // namespace sipplab::db::statistics
