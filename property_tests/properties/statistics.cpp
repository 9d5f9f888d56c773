// Statistics against their definitions: what is computed by cleverness is counted out here, choice by
// choice, and formulas are written down in another form.
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <functional>
#include <numeric>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "db/queries.hpp"
#include "db/statistics/change_points.hpp"
#include "db/statistics/statistics.hpp"
#include "property_tests/support/histories.hpp"
#include "property_tests/support/plain_statistics.hpp"
#include "property_tests/support/property.hpp"

namespace sipplab::db::statistics::statistics_laws {
namespace {

/// Sums of some thousand terms, and the tails of distributions.
constexpr double kRounding = 1e-9;

void equal(std::optional<double> value, double expected) {
  RC_LOG() << (value ? std::to_string(*value) : "none") << ", expected " << expected << '\n';
  RC_ASSERT(value.has_value());
  RC_ASSERT(*value == expected || std::abs(*value - expected) <= kRounding * std::abs(expected));
}

std::vector<double> any_values(int least, int most, int largest) {
  std::vector<double> values;
  for (auto left = any_whole(least, most); left > 0; --left) {
    values.push_back(static_cast<double>(any_whole(-largest, largest)) / 2);
  }
  return values;
}

// --- tests of signs and ranks -------------------------------------------------------

/// Of all choices of signs, the share whose sum is as far from the middle, or farther, as that of the sizes
/// that are `chosen`. Twice the sizes, which are whole then.
double two_sided(const std::vector<double>& sizes, const std::vector<bool>& chosen) {
  const std::size_t choices = std::size_t{1} << sizes.size();
  const auto distance = [&](const auto& is_chosen) {
    double sum = 0;
    for (std::size_t i = 0; i < sizes.size(); ++i) sum += is_chosen(i) ? sizes[i] : -sizes[i];
    return std::abs(sum);
  };
  const double ours = distance([&](std::size_t i) { return chosen[i]; });
  std::size_t as_far = 0;
  for (std::size_t choice = 0; choice < choices; ++choice) {
    as_far += distance([&](std::size_t i) { return (choice >> i & 1U) != 0; }) >= ours ? 1U : 0U;
  }
  return static_cast<double>(as_far) / static_cast<double>(choices);
}

/// Its mean rank among the sizes: those that are smaller come before it, half of its equals too.
double rank_of(double difference, const std::vector<double>& differences) {
  double rank = 0.5;
  for (const double other : differences) {
    rank += std::abs(other) < std::abs(difference) ? 1 : std::abs(other) == std::abs(difference) ? 0.5 : 0;
  }
  return rank;
}

struct Ranked {
  std::vector<double> ranks;
  std::vector<bool> positive;
};
Ranked ranked(std::vector<double> differences) {
  std::erase(differences, 0.0);
  Ranked made;
  for (const double difference : differences) {
    made.ranks.push_back(rank_of(difference, differences));
    made.positive.push_back(difference > 0);
  }
  return made;
}

void ranks_are_counted_out() {
  const std::vector<double> differences = any_values(1, 10, 5);
  const Ranked made = ranked(differences);
  if (made.ranks.empty()) {
    RC_ASSERT(!wilcoxon(differences).has_value());
  } else {
    equal(wilcoxon(differences), two_sided(made.ranks, made.positive));
  }
  RC_CLASSIFY(made.ranks.size() < differences.size(), "with zeros");
}

void many_ranks_are_nearly_normal() {
  std::vector<double> differences = any_values(80, 140, 60);
  const double shift = static_cast<double>(any_whole(-20, 20)) / 2;
  for (double& difference : differences) difference += shift;
  const Ranked made = ranked(differences);
  if (made.ranks.size() <= kExactWilcoxonLimit) RC_DISCARD("counted out");
  // Half of the sum of all ranks, and a quarter of the sum of their squares: each has its own coin.
  double mean = 0;
  double variance = 0;
  double sum = 0;
  for (std::size_t i = 0; i < made.ranks.size(); ++i) {
    mean += made.ranks[i] / 2;
    variance += made.ranks[i] * made.ranks[i] / 4;
    sum += made.positive[i] ? made.ranks[i] : 0;
  }
  const double distance =
      std::max(0.0, std::abs(sum - mean) - 0.5);  // sums are half a rank apart from the middle
  equal(wilcoxon(differences), std::erfc(distance / std::sqrt(2 * variance)));
}

/// Counted out by sums of twice the ranks, whatever their number.
double counted_by_sums(const Ranked& made) {
  std::vector<double> chance = {1};
  std::size_t ours = 0;
  for (std::size_t i = 0; i < made.ranks.size(); ++i) {
    const auto step = static_cast<std::size_t>(std::lround(2 * made.ranks[i]));
    std::vector<double> next(chance.size() + step, 0.0);
    for (std::size_t sum = 0; sum < chance.size(); ++sum) {
      next[sum] += chance[sum] / 2;
      next[sum + step] += chance[sum] / 2;
    }
    chance = std::move(next);
    ours += made.positive[i] ? step : 0;
  }
  const std::size_t smaller = std::min(ours, chance.size() - 1 - ours);
  const double tail =
      std::accumulate(chance.begin(), chance.begin() + static_cast<std::ptrdiff_t>(smaller) + 1, 0.0);
  return std::min(1.0, 2 * tail);
}

void up_to_the_limit_ranks_are_exact() {
  std::vector<double> differences;
  const auto count = static_cast<std::size_t>(any_whole(static_cast<std::int64_t>(kExactWilcoxonLimit) - 3,
                                                        static_cast<std::int64_t>(kExactWilcoxonLimit)));
  while (differences.size() < count)
    differences.push_back(static_cast<double>(any_whole(1, 60)) * (any_whole(0, 2) == 0 ? -1 : 1));
  equal(wilcoxon(differences), counted_by_sums(ranked(differences)));
}

void signs_are_counted_out() {
  std::vector<std::int64_t> nets;
  std::vector<double> sizes;
  std::vector<bool> positive;
  for (auto left = any_whole(0, 10); left > 0; --left) {
    nets.push_back(any_whole(-4, 4));
    if (nets.back() == 0) continue;
    sizes.push_back(std::abs(static_cast<double>(nets.back())));
    positive.push_back(nets.back() > 0);
  }
  equal(sign_flips(nets), two_sided(sizes, positive));
}

void coins_are_counted_out() {
  const auto wins = static_cast<std::uint64_t>(any_whole(0, 40));
  const auto losses = static_cast<std::uint64_t>(any_whole(0, 40));
  const double expected =
      wins == losses ? 1 : std::min(1.0, 2 * bench::at_least(std::max(wins, losses), wins + losses));
  if (wins + losses == 0) {
    RC_ASSERT(!sign_test(wins, losses).has_value());
  } else {
    equal(sign_test(wins, losses), expected);
  }
  equal(mcnemar(wins, losses), expected);
}

// --- means, intervals, quantiles ----------------------------------------------------

void intervals_solve_their_equation() {
  const auto of = static_cast<double>(any_whole(1, 300));
  const double held = static_cast<double>(any_whole(0, static_cast<std::int64_t>(of)));
  const ConfidenceInterval interval = wilson_interval(held, of);
  const double rate = held / of;
  RC_ASSERT(interval.low <= rate);
  RC_ASSERT(rate <= interval.high);
  // A true rate lies at the end if the one that was seen is 1.96 of its standard deviations away.
  constexpr double kTwoSided = 1.959963984540054;
  for (const double end : {interval.low, interval.high}) {
    if (end == 0 || end == 1) continue;
    RC_ASSERT(std::abs(std::abs(rate - end) - kTwoSided * std::sqrt(end * (1 - end) / of)) < 1e-12);
  }
  RC_ASSERT((interval.low == 0) == (held == 0));
  RC_ASSERT((interval.high == 1) == (held == of));
}

/// P(T <= t) by Simpson's rule over the density.
double student_below(double t, int freedom) {
  const double nu = freedom;
  const double scale =
      std::exp(std::lgamma((nu + 1) / 2) - std::lgamma(nu / 2)) / std::sqrt(nu * std::acos(-1.0));
  const auto density = [&](double x) { return scale * std::pow(1 + x * x / nu, -(nu + 1) / 2); };
  constexpr int kSteps = 2000;
  double sum = 0;
  for (int i = 0; i < kSteps; ++i) {
    const double a = t * i / kSteps;
    const double b = t * (i + 1) / kSteps;
    sum += (density(a) + 4 * density((a + b) / 2) + density(b)) * (b - a) / 6;
  }
  return 0.5 + sum;
}

void quantiles_of_distributions_are_where_they_say() {
  const auto freedom = static_cast<int>(any_whole(2, 60));
  RC_ASSERT(std::abs(student_below(t_quantile(freedom), freedom) - 0.975) < 1e-9);
  const double p = static_cast<double>(any_whole(1, 999)) / 1000;
  RC_ASSERT(std::abs(std::erfc(-normal_quantile(p) / std::sqrt(2.0)) / 2 - p) < 1e-12);
}

void means_of_powers_have_mean_exponents() {
  std::vector<double> values;
  double exponents = 0;
  for (auto left = any_whole(1, 9); left > 0; --left) {
    const auto exponent = static_cast<int>(any_whole(-9, 9));
    values.push_back(std::ldexp(1.0, exponent));
    exponents += exponent;
  }
  equal(geometric_mean(values), std::exp2(exponents / static_cast<double>(values.size())));
  values.push_back(static_cast<double>(any_whole(-1, 0)));
  RC_ASSERT(!geometric_mean(values).has_value());
}

void unsolved_ones_count_twice_their_limit() {
  std::vector<TimedResult> results;
  double sum = 0;
  for (auto left = any_whole(1, 6); left > 0; --left) {
    results.push_back(
        {any_flag(), static_cast<double>(any_whole(1, 9)), static_cast<double>(any_whole(10, 20))});
    sum += results.back().solved ? results.back().time_s : results.back().limit_s + results.back().limit_s;
  }
  equal(par2(results), sum / static_cast<double>(results.size()));
  RC_ASSERT(!par2({}).has_value());
}

// --- the same in SQL ----------------------------------------------------------------

/// One row of numbers, which may be missing.
using Row = std::vector<std::optional<double>>;

/// The first row of the answer to one question with all the calls in it.
std::vector<Value> answers(const std::vector<std::string>& calls, const std::vector<Row>& rows) {
  static const NewHistory kHistory;
  std::string called;
  for (const std::string& call : calls) called += (called.empty() ? "" : ", ") + call;
  std::string values;
  for (const Row& row : rows) {
    values += values.empty() ? "(" : ", (";
    for (std::size_t i = 0; i < row.size(); ++i)
      values += (i > 0 ? ", " : "") + (row[i] ? std::to_string(*row[i]) : "NULL");
    values += ")";
  }
  return must(run_sql(kHistory.path(), "SELECT " + called + " FROM (VALUES " + values + ")")).rows.at(0);
}

void sql_says_the_same() {
  std::vector<Row> rows;
  std::vector<double> first;
  std::vector<TimedResult> timed;
  std::uint64_t lost = 0;
  std::uint64_t gained = 0;
  std::uint64_t above = 0;
  std::uint64_t below = 0;
  double held = 0;
  for (auto left = any_whole(1, 8); left > 0; --left) {
    const bool missing = any_whole(0, 4) == 0;
    const auto a = static_cast<double>(any_whole(-2, 4));
    const auto b = static_cast<double>(any_whole(0, 1));
    const auto c = static_cast<double>(any_whole(1, 9));
    rows.push_back({a, b, c});
    if (missing) {
      for (auto& value : rows.back()) value.reset();
      continue;
    }
    first.push_back(a);
    timed.push_back({a != 0, b, c});
    lost += a != 0 && b == 0 ? 1U : 0U;
    gained += a == 0 && b != 0 ? 1U : 0U;
    above += a > 0 ? 1U : 0U;
    below += a < 0 ? 1U : 0U;
    held += a != 0 ? 1 : 0;
  }
  const std::size_t count = first.size();
  const ConfidenceInterval interval = wilson_interval(held, static_cast<double>(count));
  std::vector<double> third;
  for (const TimedResult& one : timed) third.push_back(one.limit_s);
  const auto of_some = [count](double value) { return count == 0 ? std::nullopt : std::optional(value); };
  const std::vector<std::pair<std::string, std::optional<double>>> expected = {
      {"median(column1)", median(first)},
      {"quantile(column1, 0.25)", quantile(first, 0.25)},
      {"sign_test(column1)", sign_test(above, below)},
      {"wilcoxon(column1)", wilcoxon(first)},
      {"mcnemar(column1, column2)", of_some(mcnemar(lost, gained))},
      {"par2(column1, column2, column3)", par2(timed)},
      {"wilson_low(column1)", of_some(interval.low)},
      {"wilson_high(column1)", of_some(interval.high)},
      {"geomean(column3)", geometric_mean(third)}};
  std::vector<std::string> calls;
  for (const auto& [call, value] : expected) calls.push_back(call);
  const std::vector<Value> said = answers(calls, rows);
  for (std::size_t i = 0; i < expected.size(); ++i) {
    RC_LOG() << calls[i] << '\n';
    RC_ASSERT(std::holds_alternative<double>(said[i]) == expected[i].second.has_value());
    if (expected[i].second) equal(std::get<double>(said[i]), *expected[i].second);
  }
}

// --- the same by another program ----------------------------------------------------

struct Known {
  std::string_view what;
  std::vector<double> numbers;
  double expected;
};
const std::vector<Known>& known_values() {
  static const std::vector<Known> values = {
#include "property_tests/data/statistics.inc"
  };
  return values;
}

void another_program_says_the_same() {
  constexpr double kRoundingOfTails = 1e-9;
  for (const Known& known : known_values()) {
    const std::vector<double>& x = known.numbers;
    const auto count = [&x](std::size_t i) { return static_cast<std::uint64_t>(x[i]); };
    std::optional<double> said;
    if (known.what == "wilcoxon") said = wilcoxon(x);
    if (known.what == "sign_test") said = sign_test(count(0), count(1));
    if (known.what == "wilson_low") said = wilson_interval(x[0], x[1]).low;
    if (known.what == "wilson_high") said = wilson_interval(x[0], x[1]).high;
    if (known.what == "t_quantile") said = t_quantile(x[0]);
    if (known.what == "normal_quantile") said = normal_quantile(x[0]);
    if (known.what == "quantile") said = quantile({x.begin() + 1, x.end()}, x[0]);
    if (known.what == "geometric_mean") said = geometric_mean(x);
    RC_LOG() << known.what << " of " << x.size() << " numbers from " << x[0] << " on\n";
    RC_ASSERT(said.has_value());
    RC_ASSERT(std::abs(*said - known.expected) <= kRoundingOfTails * std::abs(known.expected) + 1e-15);
  }
}

// --- changes of level ---------------------------------------------------------------

/// The scaled energy distance between the first k of the values and the others, from all pairs.
double strength(const std::vector<double>& values, std::size_t k) {
  const auto mean_distance = [&](std::size_t a, std::size_t b, std::size_t c, std::size_t d) {
    double sum = 0;
    double pairs = 0;
    for (std::size_t i = a; i < b; ++i) {
      for (std::size_t j = c; j < d; ++j) {
        if (i == j) continue;
        sum += std::abs(values[i] - values[j]);
        ++pairs;
      }
    }
    return sum / pairs;
  };
  const std::size_t n = values.size();
  const double energy = 2 * mean_distance(0, k, k, n) - mean_distance(0, k, 0, k) - mean_distance(k, n, k, n);
  return energy * static_cast<double>(k) * static_cast<double>(n - k) / static_cast<double>(n);
}

std::optional<std::size_t> strongest(const std::vector<double>& values, std::size_t min_segment,
                                     double& best) {
  std::optional<std::size_t> place;
  best = 0;
  for (std::size_t k = min_segment; k + min_segment <= values.size(); ++k) {
    const double now = strength(values, k);
    if (now > best * (1 + kRounding) + kRounding) {
      best = now;
      place = k;
    }
  }
  return place;
}

void series_divide_where_they_differ_most() {
  std::vector<double> values = any_values(2, 24, 8);
  const auto step = static_cast<std::size_t>(any_whole(0, static_cast<std::int64_t>(values.size())));
  const double height = static_cast<double>(any_whole(0, 3)) * 4;
  for (std::size_t i = step; i < values.size(); ++i) values[i] += height;
  ChangePointOptions options;
  options.min_segment = static_cast<std::size_t>(any_whole(2, 4));
  const std::vector<Division> divisions = divide(values, options);
  // Taken apart as the divisions say, in the order of positions.
  std::size_t next = 0;
  const std::function<void(std::size_t, std::size_t)> check = [&](std::size_t begin, std::size_t end) {
    if (end - begin < 2 * options.min_segment) return;
    const std::vector<double> part(values.begin() + static_cast<std::ptrdiff_t>(begin),
                                   values.begin() + static_cast<std::ptrdiff_t>(end));
    double best = 0;
    const auto place = strongest(part, options.min_segment, best);
    // Which of the divisions is that of this part: behind those of the part before it.
    std::size_t mine = next;
    if (place) {
      while (mine < divisions.size() &&
             !(divisions[mine].position > begin && divisions[mine].position < end &&
               std::abs(strength(part, divisions[mine].position - begin) - best) <= kRounding * (1 + best))) {
        ++mine;
      }
      RC_ASSERT(mine < divisions.size());
      RC_ASSERT(divisions[mine].accepted == (divisions[mine].p_value <= options.significance));
      RC_ASSERT(divisions[mine].p_value > 0);
      RC_ASSERT(divisions[mine].p_value <= 1);
      if (divisions[mine].accepted) check(begin, divisions[mine].position);
      RC_ASSERT(next == mine);
      ++next;
      if (divisions[mine].accepted) check(divisions[mine].position, end);
    } else {
      RC_ASSERT(mine < divisions.size());
      RC_ASSERT(!divisions[mine].accepted);
      ++next;
    }
  };
  check(0, values.size());
  RC_ASSERT(next == divisions.size());
  RC_CLASSIFY(
      std::any_of(divisions.begin(), divisions.end(), [](const Division& one) { return one.accepted; }),
      "with a change");
}

/// Of all orders of seven values, the share that is divided as strongly: what permutations estimate.
void chances_are_those_of_all_orders() {
  std::vector<double> values = any_values(6, 6, 3);
  const double height = static_cast<double>(any_whole(0, 4));
  for (std::size_t i = 3; i < values.size(); ++i) values[i] += height;
  ChangePointOptions options;
  options.min_segment = 3;
  const Division division = divide(values, options).front();
  double ours = 0;
  if (!strongest(values, options.min_segment, ours)) RC_DISCARD("no division");
  std::vector<std::size_t> order(values.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  double as_strong = 0;
  double orders = 0;
  do {
    std::vector<double> shuffled;
    for (const std::size_t i : order) shuffled.push_back(values[i]);
    double best = 0;
    strongest(shuffled, options.min_segment, best);
    as_strong += best >= ours * (1 - kRounding) ? 1 : 0;
    ++orders;
  } while (std::next_permutation(order.begin(), order.end()));
  const double exact = as_strong / orders;
  // Counted until twenty were as strong: right to within a fifth, once in a million less than within this.
  RC_ASSERT(division.p_value <= std::min(1.0, 3.5 * exact + 0.001));
  RC_ASSERT(division.p_value >= 0.4 * exact);
}

void false_discoveries_are_as_defined() {
  std::vector<double> p_values;
  for (auto left = any_whole(0, 8); left > 0; --left)
    p_values.push_back(static_cast<double>(any_whole(0, 40)) / 200);
  const double rate = static_cast<double>(any_whole(1, 20)) / 100;
  const std::vector<bool> stands = benjamini_hochberg(p_values, rate);
  RC_ASSERT(stands.size() == p_values.size());
  for (std::size_t i = 0; i < p_values.size(); ++i) {
    // Some test, itself or a weaker one, is below its share of the rate by the number of tests up to it.
    const bool expected = std::any_of(p_values.begin(), p_values.end(), [&](double p) {
      const auto up_to_it =
          std::count_if(p_values.begin(), p_values.end(), [p](double other) { return other <= p; });
      return p >= p_values[i] &&
             p <= rate * static_cast<double>(up_to_it) / static_cast<double>(p_values.size());
    });
    RC_ASSERT(stands[i] == expected);
  }
}

const PropertyRoom room("statistics", kCasesOfHistories, [] {
  bool passed = true;

  passed &=
      property("a test of ranks counts choices of signs, ties and zeros included", ranks_are_counted_out);
  passed &= property("up to its limit a test of ranks is exact", up_to_the_limit_ranks_are_exact);
  passed &= property("beyond its limit a test of ranks is normal, by the squares of the ranks",
                     many_ranks_are_nearly_normal);
  passed &= property("a test of nets counts choices of signs", signs_are_counted_out);
  passed &= property("a sign test and McNemar's count coins", coins_are_counted_out);
  passed &= property("the ends of an interval of a rate solve its equation", intervals_solve_their_equation);
  passed &= property("a quantile of a distribution has its share below it",
                     quantiles_of_distributions_are_where_they_say);
  passed &=
      property("a geometric mean is the power of the mean exponent", means_of_powers_have_mean_exponents);
  passed &=
      property("PAR-2 counts an unsolved result as twice its limit", unsolved_ones_count_twice_their_limit);
  passed &= property("the functions of SQL say what those of C++ say, of the rows that are not NULL",
                     sql_says_the_same);
  passed &= property("SciPy says the same", another_program_says_the_same, 1);
  passed &= property("a series is divided where its parts differ most, and its parts again",
                     series_divide_where_they_differ_most);
  passed &= property("the chance of a division is that of all orders", chances_are_those_of_all_orders);
  passed &= property("false discoveries are held as Benjamini and Hochberg define it",
                     false_discoveries_are_as_defined);

  return passed;
});

}  // namespace
}  // namespace sipplab::db::statistics::statistics_laws
