// What is made of pairs of numbers, and both looks of a gate at them, each computed here by its definition.
#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>
#include <vector>

#include "bench/judge/difference.hpp"
#include "bench/judge/evidence.hpp"
#include "db/statistics/statistics.hpp"
#include "planner/core/random.hpp"
#include "property_tests/support/histories.hpp"
#include "property_tests/support/plain_statistics.hpp"
#include "property_tests/support/property.hpp"

namespace sipplab::bench::evidence_laws {
namespace {

using db::any_whole;

constexpr double kInfinity = std::numeric_limits<double>::infinity();

std::vector<double> any_numbers(std::int64_t least, std::int64_t most, std::int64_t largest) {
  std::vector<double> values;
  for (auto left = any_whole(least, most); left > 0; --left)
    values.push_back(static_cast<double>(any_whole(-largest, largest)) / 16);
  return values;
}

void many_tests_are_closed() {
  std::vector<double> p_values;
  for (auto left = any_whole(0, 8); left > 0; --left)
    p_values.push_back(static_cast<double>(any_whole(0, 20)) / 40);
  const std::vector<double> adjusted = holm(p_values);
  const std::vector<double> expected = by_closed_testing(p_values);
  RC_ASSERT(adjusted.size() == expected.size());
  for (std::size_t i = 0; i < adjusted.size(); ++i) RC_ASSERT(close(adjusted[i], expected[i]));
}

void bounds_have_their_confidence() {
  std::vector<double> values = any_numbers(0, 30, 40);
  const auto above =
      static_cast<std::size_t>(std::count_if(values.begin(), values.end(), [](double v) { return v > 0; }));
  const auto below =
      static_cast<std::size_t>(std::count_if(values.begin(), values.end(), [](double v) { return v < 0; }));
  RC_ASSERT(close(slower_p_value(values), at_least(above, above + below)));
  const double upper = upper_bound(values);
  const double lower = lower_bound(values);
  std::sort(values.begin(), values.end());
  // The first place so far up that a median above it would be beyond belief.
  double expected_upper = kInfinity;
  double expected_lower = -kInfinity;
  for (std::size_t place = values.size(); place-- > 0;) {
    if (at_least(place + 1, values.size()) > 0.025) continue;
    expected_upper = values[place];
    expected_lower = values[values.size() - 1 - place];
  }
  RC_ASSERT(upper == expected_upper);
  RC_ASSERT(lower == expected_lower);
  RC_ASSERT((upper == kInfinity) == (values.size() < 6));
}

void spreads_are_as_defined() {
  std::vector<double> values = any_numbers(0, 14, 60);
  const std::size_t n = values.size();
  // Without the lowest and the highest quarter.
  std::vector<double> sorted = values;
  std::sort(sorted.begin(), sorted.end());
  const std::vector<double> core(sorted.begin() + static_cast<std::ptrdiff_t>(n / 4),
                                 sorted.end() - static_cast<std::ptrdiff_t>(n / 4));
  RC_ASSERT(close(interquartile_mean(values), mean(core)));
  const auto half = half_width(values);
  RC_ASSERT(half.has_value() == (n >= 6));
  if (half) {
    double squares = 0;  // of all differences: twice the variance
    for (const double a : values) {
      for (const double b : values) squares += (a - b) * (a - b);
    }
    const auto count = static_cast<double>(n);
    RC_ASSERT(close(*half, db::statistics::t_quantile(count - 1) *
                               std::sqrt(squares / (2 * count * (count - 1)) / count)));
  }
  const auto pairs = static_cast<std::size_t>(any_whole(0, 20));
  std::vector<double> distances;
  for (const double value : values) distances.push_back(std::abs(value - middle(values)));
  // Of normal values the median distance is a quantile, and the median scatters more than the mean.
  const double expected = n < 2 || pairs == 0 ? 0
                                              : std::sqrt(std::acos(-1.0) / 2) * middle(distances) /
                                                    db::statistics::normal_quantile(0.75) /
                                                    std::sqrt(static_cast<double>(pairs));
  RC_ASSERT(std::abs(standard_error(values, pairs) - expected) <= 1e-4 * expected);
  const double least = static_cast<double>(any_whole(0, 9)) / 8;
  const double error = static_cast<double>(any_whole(0, 9)) / 8;
  RC_ASSERT(close(floor_from(error, least), std::max(least, 3 * error)));
}

/// What is called detectable is: with that effect, and the scatter that was seen, tests find it 19 times
/// of 20.
void what_is_detectable_solves_its_equations() {
  const std::vector<double> pairs = any_numbers(2, 40, 30);
  const double level = 0.01 / static_cast<double>(any_whole(1, 9));
  const double floor = static_cast<double>(any_whole(0, 4)) / 32;
  const auto n = static_cast<double>(pairs.size());
  double squares = 0;
  for (const double pair : pairs) squares += (pair - mean(pairs)) * (pair - mean(pairs));
  const double error = std::sqrt(squares / (n - 1) / n);
  const double z95 = db::statistics::normal_quantile(0.95);
  const double found = detectable_by_ranks(pairs, level, floor);
  RC_ASSERT((found == kInfinity) == (std::exp2(1 - n) > level));
  if (found < kInfinity) {
    const double by_test =
        (z95 - db::statistics::normal_quantile(level / 2)) * error / std::sqrt(3 / std::acos(-1.0));
    RC_ASSERT(close(found, std::max(floor + z95 * error, by_test)));
  }
  std::vector<double> nets;
  double lost = 0;
  double gained = 0;
  for (auto left = any_whole(0, 60); left > 0; --left) {
    nets.push_back(static_cast<double>(any_whole(-2, 2)));
    (nets.back() > 0 ? lost : gained) += nets.back() * nets.back();
  }
  const auto plannings = static_cast<std::size_t>(any_whole(0, 200));
  const double share = detectable_losses(nets, plannings, level, floor);
  if (share == kInfinity) return;
  RC_ASSERT(share > 0);
  RC_ASSERT(share <= 1);
  // So many are lost that 1.64 deviations fewer are still found.
  const double scatter = 2 * std::min(lost, gained);
  const double losses = share * static_cast<double>(plannings);
  const double least = losses - z95 * std::sqrt(losses + scatter);
  const double z = -db::statistics::normal_quantile(level / 2);
  const double by_signs = std::ceil(1 - std::log2(level));
  const double as_far = 1 + z * std::sqrt(scatter + least + least * least / static_cast<double>(nets.size()));
  const double that_matter = floor * static_cast<double>(plannings);
  RC_ASSERT(std::abs(least - std::max({by_signs, as_far, that_matter})) < 1e-6);
}

/// A slowdown of the size that a gate calls detectable is found 19 times of 20, and a smaller one less often:
/// both looks are made here, with pairs drawn as it draws them.
void what_a_gate_sees_it_finds() {
  std::vector<double> pairs = any_numbers(8, 16, 20);
  const GatePlan plan{14, 8, static_cast<std::size_t>(any_whole(1, 9))};
  const double floor = static_cast<double>(any_whole(0, 4)) / 32;
  const double seen = detectable(pairs, plan, floor);
  RC_ASSERT(detectable({1.0}, plan, floor) == kInfinity);
  if (seen == kInfinity) RC_DISCARD("nothing is seen");
  const double centre = middle(pairs);
  Random random(static_cast<std::uint64_t>(any_whole(1, 1 << 20)));
  const auto share_found = [&](double slowdown) {
    constexpr int kDraws = 800;
    int found = 0;
    for (int draw = 0; draw < kDraws; ++draw) {
      bool both = true;
      for (const auto& [count, level] : {std::pair(plan.pairs, 0.02 / static_cast<double>(plan.rows)),
                                         std::pair(plan.fresh_pairs, 0.05)}) {
        std::vector<double> drawn;
        for (std::size_t i = 0; i < count; ++i)
          drawn.push_back(pairs[static_cast<std::size_t>(random.below(pairs.size()))] - centre + slowdown);
        const auto above = static_cast<std::size_t>(
            std::count_if(drawn.begin(), drawn.end(), [](double v) { return v >= 0; }));
        both = both && at_least(above, count) <= level && middle(drawn) >= floor;
      }
      found += both ? 1 : 0;
    }
    return static_cast<double>(found) / kDraws;
  };
  RC_ASSERT(share_found(seen + 1e-9) > 0.91);
  RC_ASSERT(share_found(seen - 1e-9) < 0.98);
}

/// Both looks of a gate at times: first suspicion, then fresh pairs alone confirm.
void looks_of_a_gate() {
  std::vector<Difference> rows(static_cast<std::size_t>(any_whole(1, 4)));
  std::vector<Difference*> family;
  std::vector<double> slower;
  std::vector<double> faster;
  for (Difference& row : rows) {
    row.metric = &kProcessTime;
    const double shift = static_cast<double>(any_whole(-3, 3)) / 8;
    for (int i = 0; i < 14; ++i) row.pairs.push_back(shift + static_cast<double>(any_whole(-2, 2)) / 16);
    row.floor = static_cast<double>(any_whole(0, 2)) / 16;
    evaluate(row);
    family.push_back(&row);
    const auto above = std::count_if(row.pairs.begin(), row.pairs.end(), [](double v) { return v > 0; });
    const auto below = std::count_if(row.pairs.begin(), row.pairs.end(), [](double v) { return v < 0; });
    slower.push_back(at_least(static_cast<std::size_t>(above), static_cast<std::size_t>(above + below)));
    faster.push_back(at_least(static_cast<std::size_t>(below), static_cast<std::size_t>(above + below)));
    RC_ASSERT(close(row.effect, middle(row.pairs)));
    RC_ASSERT(row.at_most == upper_bound(row.pairs));
    RC_ASSERT(row.at_least == lower_bound(row.pairs));
  }
  judge_times(family);
  slower = by_closed_testing(slower);
  faster = by_closed_testing(faster);
  const double tolerance = static_cast<double>(any_whole(1, 3)) / 16;
  for (std::size_t i = 0; i < rows.size(); ++i) {
    Difference& row = rows[i];
    RC_ASSERT(close(row.adjusted_p, slower[i]));
    RC_ASSERT(close(row.adjusted_faster_p, faster[i]));
    const bool is_slower = slower[i] <= 0.02 && row.effect > row.floor;
    const bool is_faster = faster[i] <= 0.02 && row.effect < -row.floor;
    const bool needed = is_slower || is_faster || row.at_most >= tolerance;
    RC_ASSERT(needs_second_look(row, tolerance) == needed);
    if (needed) {
      const double shift = static_cast<double>(any_whole(-3, 3)) / 8;
      for (int k = 0; k < 8; ++k)
        row.fresh_pairs.push_back(shift + static_cast<double>(any_whole(-2, 2)) / 16);
    }
    const double first_effect = row.effect;
    second_look(row, tolerance);
    RC_ASSERT(row.confirmation.has_value() == needed);
    if (!needed) {
      RC_ASSERT(row.verdict == Verdict::kEquivalent);
      continue;
    }
    const double sign = is_faster ? -1 : 1;
    const auto agree = static_cast<std::size_t>(std::count_if(row.fresh_pairs.begin(), row.fresh_pairs.end(),
                                                              [sign](double v) { return sign * v > 0; }));
    const auto against = static_cast<std::size_t>(std::count_if(
        row.fresh_pairs.begin(), row.fresh_pairs.end(), [sign](double v) { return sign * v < 0; }));
    const double chance = at_least(agree, agree + against);
    RC_ASSERT(close(row.confirmation->p_value, chance));
    RC_ASSERT(close(row.confirmation->effect, middle(row.fresh_pairs)));
    std::vector<double> all = row.pairs;
    all.insert(all.end(), row.fresh_pairs.begin(), row.fresh_pairs.end());
    RC_ASSERT(row.at_most == upper_bound(all));
    RC_ASSERT(row.at_least == lower_bound(all));
    const bool confirmed =
        (is_slower || is_faster) && chance <= 0.05 && sign * middle(row.fresh_pairs) > row.floor;
    RC_ASSERT(row.verdict == (confirmed ? (is_faster ? Verdict::kImproved : Verdict::kRegressed)
                              : row.at_most >= tolerance ? Verdict::kInconclusive
                                                         : Verdict::kEquivalent));
    RC_ASSERT(close(row.effect, confirmed ? middle(all) : first_effect));
    RC_CLASSIFY(confirmed, "confirmed");
  }
}

const PropertyRoom room("evidence", kCasesOfHistories, [] {
  bool passed = true;

  passed &= property("Holm's p values are those of closed testing", many_tests_are_closed);
  passed &= property("bounds of a median have their confidence", bounds_have_their_confidence);
  passed &= property("means of middle halves, intervals and standard errors are as defined",
                     spreads_are_as_defined);
  passed &= property("what is detectable solves its equations", what_is_detectable_solves_its_equations);
  passed &= property("a slowdown that a gate calls detectable is found 19 times of 20",
                     what_a_gate_sees_it_finds, (kCasesOfHistories + 39) / 40);
  passed &= property("a gate suspects by its pairs and confirms by fresh ones", looks_of_a_gate);

  return passed;
});

}  // namespace
}  // namespace sipplab::bench::evidence_laws
