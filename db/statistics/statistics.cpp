// Quantiles, means and tests on paired results.
#include "db/statistics/statistics.hpp"

#include <algorithm>
#include <boost/math/distributions/binomial.hpp>
#include <boost/math/distributions/normal.hpp>
#include <boost/math/distributions/students_t.hpp>
#include <cmath>
#include <cstdlib>
#include <numeric>

namespace sipplab::db::statistics {
namespace {

/// In double alone: the same digits on machines whose long double is another type.
using Policy = boost::math::policies::policy<boost::math::policies::promote_double<false>>;
using Binomial = boost::math::binomial_distribution<double, Policy>;
using StudentsT = boost::math::students_t_distribution<double, Policy>;

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

/// Of all choices of some steps, twice the share whose sum is at most `smaller`: counts out, for every sum,
/// the share of choices that give it. REQUIRES: smaller is at most half the sum of all.
double exact_tails(const std::vector<std::size_t>& steps, std::size_t smaller) {
  std::vector<double> probability(std::accumulate(steps.begin(), steps.end(), std::size_t{1}), 0.0);
  probability[0] = 1;
  std::size_t reach = 0;
  for (const std::size_t step : steps) {
    reach += step;
    for (std::size_t sum = reach + 1; sum-- > 0;) {
      const double with = sum >= step ? probability[sum - step] : 0.0;
      probability[sum] = (probability[sum] + with) / 2;
    }
  }
  double tail = 0;
  for (std::size_t sum = 0; sum <= smaller; ++sum) tail += probability[sum];
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
  const Binomial fair_coins(static_cast<double>(wins + losses), 0.5);
  return std::min(1.0, 2 * cdf(fair_coins, static_cast<double>(std::min(wins, losses))));
}

double mcnemar(std::uint64_t lost, std::uint64_t gained) { return sign_test(lost, gained).value_or(1.0); }

double sign_flips(const std::vector<std::int64_t>& nets) {
  std::vector<std::size_t> steps;
  std::size_t lost = 0;
  std::size_t all = 0;
  for (const std::int64_t net : nets) {
    if (net == 0) continue;
    steps.push_back(static_cast<std::size_t>(std::abs(net)));
    all += steps.back();
    lost += net > 0 ? steps.back() : 0;
  }
  return exact_tails(steps, std::min(lost, all - lost));
}

std::optional<double> wilcoxon(const std::vector<double>& differences) {
  const RankedDifferences ranked = rank(differences);
  if (ranked.count == 0) return std::nullopt;
  const std::size_t doubled_smaller =
      std::min(ranked.doubled_positive, doubled_total(ranked) - ranked.doubled_positive);
  return ranked.count <= kExactWilcoxonLimit ? exact_tails(ranked.doubled_ranks, doubled_smaller)
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

double normal_quantile(double p) {
  return boost::math::quantile(boost::math::normal_distribution<double, Policy>(), p);
}

double t_quantile(double freedom) { return boost::math::quantile(StudentsT(freedom), 0.975); }

std::optional<double> par2(const std::vector<TimedResult>& results) {
  if (results.empty()) return std::nullopt;
  double sum = 0;
  for (const TimedResult& result : results) sum += result.solved ? result.time_s : 2 * result.limit_s;
  return sum / static_cast<double>(results.size());
}

}  // namespace sipplab::db::statistics
