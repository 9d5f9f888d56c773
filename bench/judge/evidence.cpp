#include "bench/judge/evidence.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <numeric>
#include <utility>

#include "db/statistics/statistics.hpp"
#include "planner/core/random.hpp"

namespace sipplab::bench {
namespace {

/// Of what is called detectable.
constexpr double kPower = 0.95;
constexpr double kInfinity = std::numeric_limits<double>::infinity();

double median(const std::vector<double>& values) { return db::statistics::median(values).value_or(0); }

/// P(X >= k) of n fair coins.
double at_least(std::size_t k, std::size_t n) {
  if (k == 0) return 1;
  if (2 * k > n) return db::statistics::sign_test(k, n - k).value_or(2) / 2;
  return 1 - at_least(n - k + 1, n);
}

/// Fewest of n pairs above zero that reach the level; n + 1 if none does.
std::size_t needed_above(std::size_t n, double level) {
  std::size_t k = n + 1;
  while (k > 0 && at_least(k - 1, n) <= level) --k;
  return k;
}

std::vector<double> centred(const std::vector<double>& values) {
  const double middle = median(values);
  std::vector<double> rest;
  for (const double value : values) rest.push_back(value - middle);
  return rest;
}

/// The slowdown from which on a look at these pairs flags: enough of them above zero, and
/// their median above the floor.
double critical_slowdown(std::vector<double> pairs, double level, double floor) {
  const std::size_t needed = needed_above(pairs.size(), level);
  if (needed > pairs.size()) return kInfinity;
  std::sort(pairs.begin(), pairs.end());
  return std::max(-pairs[pairs.size() - needed], floor - median(pairs));
}

}  // namespace

double interquartile_mean(std::vector<double> values) {
  if (values.empty()) return 0;
  constexpr std::size_t kQuarters = 4;
  std::sort(values.begin(), values.end());
  const auto cut = static_cast<std::ptrdiff_t>(values.size() / kQuarters);
  const double sum = std::accumulate(values.begin() + cut, values.end() - cut, 0.0);
  return sum / static_cast<double>(static_cast<std::ptrdiff_t>(values.size()) - 2 * cut);
}

double slower_p_value(const std::vector<double>& values) {
  const auto above =
      static_cast<std::size_t>(std::count_if(values.begin(), values.end(), [](double v) { return v > 0; }));
  const auto below =
      static_cast<std::size_t>(std::count_if(values.begin(), values.end(), [](double v) { return v < 0; }));
  return at_least(above, above + below);
}

double upper_bound(std::vector<double> values) {
  const std::size_t needed = needed_above(values.size(), kBoundLevel);
  if (needed > values.size()) return kInfinity;
  std::sort(values.begin(), values.end());
  return values[needed - 1];
}

double lower_bound(std::vector<double> values) {
  for (double& value : values) value = -value;
  return -upper_bound(std::move(values));
}

std::optional<double> half_width(const std::vector<double>& values) {
  constexpr std::size_t kFewest = 6;
  if (values.size() < kFewest) return std::nullopt;
  const auto count = static_cast<double>(values.size());
  const double mean = std::accumulate(values.begin(), values.end(), 0.0) / count;
  double squares = 0;
  for (const double value : values) squares += (value - mean) * (value - mean);
  const double freedom = count - 1;
  return db::statistics::t_quantile(freedom) * std::sqrt(squares / freedom / count);
}

std::vector<double> holm(const std::vector<double>& p_values) {
  std::vector<std::size_t> order(p_values.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::sort(order.begin(), order.end(),
            [&p_values](std::size_t a, std::size_t b) { return p_values[a] < p_values[b]; });
  std::vector<double> adjusted(p_values.size());
  double largest = 0;
  for (std::size_t rank = 0; rank < order.size(); ++rank) {
    const auto tests_left = static_cast<double>(order.size() - rank);
    largest = std::max(largest, std::min(1.0, tests_left * p_values[order[rank]]));
    adjusted[order[rank]] = largest;
  }
  return adjusted;
}

double standard_error(const std::vector<double>& values, std::size_t pairs) {
  if (values.size() < 2 || pairs == 0) return 0;
  constexpr double kDeviationOverMad = 1.4826;  // of normal values
  constexpr double kMedianOverMean = 1.2533;    // the median scatters by sqrt(pi / 2) more
  std::vector<double> distances = centred(values);
  for (double& distance : distances) distance = std::abs(distance);
  return kMedianOverMean * kDeviationOverMad * median(distances) / std::sqrt(static_cast<double>(pairs));
}

double floor_from(double standard_error, double least) {
  return std::max(least, kFloorInStandardErrors * standard_error);
}

double detectable(const std::vector<double>& pairs, const GatePlan& plan, double floor) {
  constexpr int kDraws = 4000;
  constexpr std::uint64_t kSeed = 1;
  if (pairs.size() < 2 || plan.rows == 0) return kInfinity;
  const std::vector<double> rest = centred(pairs);
  Random random(kSeed);
  const auto draw = [&rest, &random](std::size_t count) {
    std::vector<double> drawn;
    for (std::size_t i = 0; i < count; ++i) {
      drawn.push_back(rest[static_cast<std::size_t>(random.below(rest.size()))]);
    }
    return drawn;
  };
  // Holm's strictest step: the row may be the only one that is slower.
  const double level = kSuspicionLevel / static_cast<double>(plan.rows);
  std::vector<double> critical;
  for (int i = 0; i < kDraws; ++i) {
    const double first = critical_slowdown(draw(plan.pairs), level, floor);
    const double fresh = critical_slowdown(draw(plan.fresh_pairs), kConfirmationLevel, floor);
    critical.push_back(std::max(first, fresh));
  }
  return db::statistics::quantile(critical, kPower).value_or(kInfinity);
}

double detectable_by_ranks(const std::vector<double>& pairs, double level, double floor) {
  // Relative to Student's test, of normal values: what ranks throw away.
  constexpr double kEfficiencyOfRanks = 3 / std::numbers::pi;
  const auto count = static_cast<double>(pairs.size());
  if (std::ldexp(2.0, -static_cast<int>(std::min<std::size_t>(pairs.size(), 1000))) > level) return kInfinity;
  const double mean = std::accumulate(pairs.begin(), pairs.end(), 0.0) / count;
  double squares = 0;
  for (const double pair : pairs) squares += (pair - mean) * (pair - mean);
  const double error = std::sqrt(squares / (count - 1) / count);
  const double power = db::statistics::normal_quantile(kPower);
  return std::max(floor + power * error, (db::statistics::normal_quantile(1 - level / 2) + power) * error /
                                             std::sqrt(kEfficiencyOfRanks));
}

double detectable_losses(const std::vector<double>& nets, std::size_t plannings, double level, double floor) {
  const auto count = static_cast<double>(nets.size());
  const double z = db::statistics::normal_quantile(1 - level / 2);
  if (plannings == 0 || z * z >= count) return kInfinity;
  // The squares of nets without a change, which has made one side of them larger.
  double lost = 0;
  double gained = 0;
  for (const double net : nets) (net > 0 ? lost : gained) += net * net;
  const double scatter = 2 * std::min(lost, gained);
  // Of q losses the sum of nets is q, and that of their squares scatter + q + q^2 / count, for some instances
  // lose twice: the test finds q >= 1 + z sqrt(that), the 1 since sums of signs come in steps of two, and no
  // fewer than signs that all agree need.
  const double share_of_square = 1 - z * z / count;
  const double linear = 2 + z * z;
  const double found = (linear + std::sqrt(linear * linear - 4 * share_of_square * (1 - z * z * scatter))) /
                       (2 * share_of_square);
  const double least =
      std::max({found, std::ceil(1 - std::log2(level)), floor * static_cast<double>(plannings)});
  // So many or more come in 95 of 100 comparisons.
  const double power = db::statistics::normal_quantile(kPower);
  const double root = (power + std::sqrt(power * power + 4 * (least + scatter))) / 2;
  const double share = (root * root - scatter) / static_cast<double>(plannings);
  return share <= 1 ? share : kInfinity;
}

}  // namespace sipplab::bench
