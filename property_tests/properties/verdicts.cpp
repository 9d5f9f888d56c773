// Judges of two sides against each other: counts, effects, chances and verdicts from pairs of results that
// are drawn, each computed here by its definition.
#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <map>
#include <nlohmann/json.hpp>
#include <numeric>
#include <optional>
#include <set>
#include <string>
#include <tuple>
#include <utility>
#include <vector>

#include "bench/judge/evidence.hpp"
#include "bench/judge/judgement.hpp"
#include "bench/judge/report.hpp"
#include "db/statistics/statistics.hpp"
#include "planner/core/random.hpp"
#include "property_tests/support/histories.hpp"
#include "property_tests/support/property.hpp"

namespace sipplab::bench::verdicts_laws {
namespace {

using db::any_flag;
using db::any_whole;
using db::ResultRow;
using db::ResultStatus;

constexpr double kInfinity = std::numeric_limits<double>::infinity();
constexpr int kFewer = (kCasesOfHistories + 1) / 2;

bool close(double a, double b) {
  return a == b || std::abs(a - b) <= 1e-9 * std::max({1.0, std::abs(a), std::abs(b)});
}

std::vector<double> any_numbers(std::int64_t least, std::int64_t most, std::int64_t largest) {
  std::vector<double> values;
  for (auto left = any_whole(least, most); left > 0; --left)
    values.push_back(static_cast<double>(any_whole(-largest, largest)) / 16);
  return values;
}

double mean(const std::vector<double>& values) {
  return values.empty()
             ? 0
             : std::accumulate(values.begin(), values.end(), 0.0) / static_cast<double>(values.size());
}

/// The middle, or the mean of the two in the middle.
double middle(std::vector<double> values) {
  if (values.empty()) return 0;
  std::sort(values.begin(), values.end());
  return (values[(values.size() - 1) / 2] + values[values.size() / 2]) / 2;
}

/// P(X >= k) of n fair coins, in the order of Pascal's triangle.
double at_least(std::size_t k, std::size_t n) {
  std::vector<double> row = {1};
  for (std::size_t coin = 0; coin < n; ++coin) {
    row.push_back(0);
    for (std::size_t i = row.size(); i-- > 1;) row[i] = (row[i] + row[i - 1]) / 2;
    row[0] /= 2;
  }
  return k > n ? 0 : std::accumulate(row.begin() + static_cast<std::ptrdiff_t>(k), row.end(), 0.0);
}

// --- evidence -----------------------------------------------------------------------

/// Holm's by closed testing: a hypothesis stands as firmly as the least firm set that holds it, each set
/// tested by the smallest of its p values times their number.
std::vector<double> by_closed_testing(const std::vector<double>& p_values) {
  std::vector<double> adjusted(p_values.size(), 0);
  for (std::size_t set = 1; set < std::size_t{1} << p_values.size(); ++set) {
    double least = 1;
    double size = 0;
    for (std::size_t i = 0; i < p_values.size(); ++i) {
      if ((set >> i & 1U) == 0) continue;
      least = std::min(least, p_values[i]);
      ++size;
    }
    for (std::size_t i = 0; i < p_values.size(); ++i) {
      if ((set >> i & 1U) != 0) adjusted[i] = std::max(adjusted[i], std::min(1.0, size * least));
    }
  }
  return adjusted;
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

// --- pairs of results ---------------------------------------------------------------

/// Nearly as the other.
ResultRow changed(ResultRow row) {
  for (auto changes = any_whole(0, 2); changes > 0; --changes) {
    switch (any_whole(0, 9)) {
      case 0:
        row.status = static_cast<ResultStatus>(any_whole(0, 3));
        break;
      case 1:
        row.plan_hash = static_cast<std::uint64_t>(any_whole(1, 3));
        break;
      case 2:
        ++row.tries;
        break;
      case 3:
        row.expansions += 3;
        break;
      case 4:
        row.generations += 7;
        break;
      case 5:
        row.flowtime_s = row.flowtime_s.value_or(8) * 1.25;
        break;
      case 6:
        row.makespan_s = row.makespan_s.value_or(4) + 0.5;
        break;
      case 7:
        row.planning_time_ns *= 2;
        break;
      case 8:
        row.limit = any_flag() ? "time" : "expansions";
        break;
      default:
        row.peak_memory_bytes = any_whole(0, 1) << 21;
        break;
    }
  }
  return row;
}

ResultRow any_row() {
  ResultRow row;
  row.status = any_whole(0, 3) > 0 ? ResultStatus::kSolved : static_cast<ResultStatus>(any_whole(0, 3));
  row.planning_time_ns = any_whole(1, 8) * 1'000'000;
  row.makespan_s = static_cast<double>(any_whole(1, 8));
  row.flowtime_s = static_cast<double>(any_whole(8, 32));
  row.tries = static_cast<std::uint64_t>(any_whole(1, 3));
  row.expansions = static_cast<std::uint64_t>(any_whole(0, 40));
  row.generations = static_cast<std::uint64_t>(any_whole(0, 40));
  row.plan_hash = 1;
  row.message = "words";
  if (any_flag()) row.instructions = any_whole(1, 9);
  if (any_flag()) row.peak_memory_bytes = any_whole(0, 3) << 20;
  return row;
}

std::vector<db::PairedCell> any_cells() {
  std::vector<db::PairedCell> cells;
  for (auto left = any_whole(1, 3); left > 0; --left) {
    db::PairedCell cell;
    cell.parameters = db::case_number(static_cast<int>(left));
    if (any_flag()) cell.parameters.options["time_limit_s"] = 8.0;
    cell.same_machine = any_flag();
    cell.base_only = static_cast<std::size_t>(any_whole(0, 2));
    cell.head_only = static_cast<std::size_t>(any_whole(0, 2));
    const bool all_alike = any_flag();
    const double shift = any_flag()   ? 1
                         : any_flag() ? 1.5
                                      : 0.5;  // of every flowtime, so that something is certain
    for (auto results = any_whole(0, 12); results > 0; --results) {
      const int number = static_cast<int>(any_whole(0, 9));
      db::PairedResult result{
          "name " + std::to_string(number), "hash " + std::to_string(number), any_row(), {}};
      result.head = all_alike ? result.base : changed(result.base);
      if (result.head.flowtime_s) *result.head.flowtime_s *= shift;
      result.base.position = result.head.position = static_cast<std::int64_t>(cell.results.size());
      cell.results.push_back(std::move(result));
    }
    cells.push_back(std::move(cell));
  }
  return cells;
}

bool solves(const ResultRow& row) { return row.status == ResultStatus::kSolved; }

/// What differs: the gravest first.
std::optional<ChangeKind> kind_of(const ResultRow& a, const ResultRow& b) {
  const auto is_invalid = [](const ResultRow& row) { return row.status == ResultStatus::kInvalid; };
  if (a.status != b.status)
    return is_invalid(a) || is_invalid(b) ? ChangeKind::kValidity : ChangeKind::kStatus;
  if (a.limit == "time" || b.limit == "time") return std::nullopt;
  if (a.plan_hash != b.plan_hash) return ChangeKind::kPlan;
  const bool same_work =
      std::tie(a.tries, a.expansions, a.generations) == std::tie(b.tries, b.expansions, b.generations);
  return same_work ? std::nullopt : std::optional(ChangeKind::kWork);
}

void changes_are_told_by_what_differs() {
  const ResultRow base = any_row();
  const ResultRow head = changed(changed(base));
  const auto told = change(base, head);
  const auto expected = kind_of(base, head);
  RC_ASSERT(told.has_value() == expected.has_value());
  RC_ASSERT(change(head, base).has_value() == expected.has_value());
  if (!told) return;
  RC_ASSERT(told->kind == *expected);
  const auto back = *change(head, base);
  RC_ASSERT(back.kind == *expected);
  RC_ASSERT(back.base == told->head);
  RC_ASSERT(back.head == told->base);
  // Both sides in words, so that a person sees what differs.
  if (*expected == ChangeKind::kWork) {
    for (const auto& [row, text] : {std::pair(base, told->base), std::pair(head, told->head)}) {
      RC_ASSERT(text == std::to_string(row.tries) + " tries, " + std::to_string(row.expansions) +
                            " expansions, " + std::to_string(row.generations) + " generations");
    }
  }
  RC_ASSERT(told->base != told->head);
}

/// Of each planning and cell, one after the other.
struct Counts {
  std::size_t compared = 0, differing = 0, other_plans = 0, cut_short = 0, base_solved = 0, head_solved = 0,
              both_solved = 0, newly_invalid = 0;
  std::set<std::string> instances;
};

void count(const db::PairedResult& result, Counts& counts) {
  const auto kind = kind_of(result.base, result.head);
  const bool is_cut = result.base.limit == "time" || result.head.limit == "time";
  ++counts.compared;
  counts.differing += kind ? 1U : 0U;
  counts.other_plans += kind && *kind != ChangeKind::kWork ? 1U : 0U;
  counts.cut_short += !kind && is_cut ? 1U : 0U;
  counts.base_solved += solves(result.base) ? 1U : 0U;
  counts.head_solved += solves(result.head) ? 1U : 0U;
  counts.both_solved += solves(result.base) && solves(result.head) ? 1U : 0U;
  counts.newly_invalid +=
      result.head.status == ResultStatus::kInvalid && result.base.status != ResultStatus::kInvalid ? 1U : 0U;
  counts.instances.insert(result.instance_hash);
}

void check(const Judged& judged, const Counts& counts) {
  RC_ASSERT(judged.compared == counts.compared);
  RC_ASSERT(judged.differing == counts.differing);
  RC_ASSERT(judged.other_plans == counts.other_plans);
  RC_ASSERT(judged.cut_short == counts.cut_short);
  RC_ASSERT(judged.base_solved == counts.base_solved);
  RC_ASSERT(judged.head_solved == counts.head_solved);
  RC_ASSERT(judged.both_solved == counts.both_solved);
  RC_ASSERT(judged.newly_invalid == counts.newly_invalid);
  RC_ASSERT(judged.instances == counts.instances.size());
}

double par2_of(const db::PairedCell& cell, ResultRow db::PairedResult::*side) {
  double sum = 0;
  for (const db::PairedResult& result : cell.results) {
    const ResultRow& row = result.*side;
    sum += solves(row) ? static_cast<double>(row.planning_time_ns) / 1e9
                       : 2 * cell.parameters.real("time_limit_s");
  }
  return sum / static_cast<double>(cell.results.size());
}

/// Cells without results are left out.
std::vector<db::PairedCell> with_results(std::vector<db::PairedCell> cells) {
  std::erase_if(cells, [](const db::PairedCell& cell) { return cell.results.empty(); });
  return cells;
}

void everything_is_counted() {
  const std::vector<db::PairedCell> drawn = any_cells();
  const std::vector<db::PairedCell> cells = with_results(drawn);
  const Judgement judgement = measured(drawn);
  RC_ASSERT(judgement.cells.size() == cells.size());
  Counts all;
  for (std::size_t i = 0; i < cells.size(); ++i) {
    Counts counts;
    for (const db::PairedResult& result : cells[i].results) {
      count(result, counts);
      count(result, all);
    }
    check(judgement.cells[i], counts);
    const bool is_limited = cells[i].parameters.real("time_limit_s") < kInfinity;
    RC_ASSERT(judgement.cells[i].base_par2_s.has_value() == is_limited);
    if (!is_limited) continue;
    RC_ASSERT(close(*judgement.cells[i].base_par2_s, par2_of(cells[i], &db::PairedResult::base)));
    RC_ASSERT(close(*judgement.cells[i].head_par2_s, par2_of(cells[i], &db::PairedResult::head)));
  }
  check(judgement.all, all);
  // Each planning that differs is in one finding; what is alike stands together.
  std::map<std::tuple<std::size_t, std::string, ChangeKind, std::string, std::string>, std::size_t> expected;
  for (std::size_t i = 0; i < cells.size(); ++i) {
    for (const db::PairedResult& result : cells[i].results) {
      if (const auto what = change(result.base, result.head))
        ++expected[{i, result.instance_hash, what->kind, what->base, what->head}];
    }
  }
  RC_ASSERT(judgement.findings.size() == expected.size());
  int last = 0;
  for (const Finding& finding : judgement.findings) {
    const auto found = expected.find({finding.cell, judgement.result(finding).instance_hash,
                                      finding.what.kind, finding.what.base, finding.what.head});
    RC_ASSERT(found != expected.end());
    RC_ASSERT(found->second == finding.plannings);
    // The gravest first: what is invalid, lost, gained, planned otherwise, and found with other work.
    const bool head_solves = solves(judgement.result(finding).head);
    const int place = finding.what.kind == ChangeKind::kValidity ? 0
                      : finding.what.kind == ChangeKind::kStatus ? (head_solves ? 2 : 1)
                      : finding.what.kind == ChangeKind::kPlan   ? 3
                                                                 : 4;
    RC_ASSERT(place >= last);
    last = place;
    const std::string_view called = heading(judgement, finding);
    RC_ASSERT(called == (place == 1 ? "lost" : place == 2 ? "gained" : name(finding.what.kind)));
  }
}

// --- metrics ------------------------------------------------------------------------

/// A metric as it is documented, by its name.
struct MetricLaw {
  std::optional<double> (*value)(const ResultRow& row);
  db::MetricKind kind;
  bool of_machine = false;  ///< else where both sides solve
  bool judges = false;
  bool judges_pooled = false;
};
const std::map<std::string_view, MetricLaw> kLaws = {
    {"flowtime",
     {[](const ResultRow& r) { return r.flowtime_s; }, db::MetricKind::kQuality, false, true, true}},
    {"makespan",
     {[](const ResultRow& r) { return r.makespan_s; }, db::MetricKind::kQuality, false, false, true}},
    {"expansions",
     {[](const ResultRow& r) { return std::optional(static_cast<double>(r.expansions)); },
      db::MetricKind::kCounts, false, true, true}},
    {"generations",
     {[](const ResultRow& r) { return std::optional(static_cast<double>(r.generations)); },
      db::MetricKind::kCounts, false, false, true}},
    {"tries",
     {[](const ResultRow& r) { return std::optional(static_cast<double>(r.tries)); }, db::MetricKind::kCounts,
      false, false, true}},
    {"instructions",
     {[](const ResultRow& r) {
        return r.instructions ? std::optional(static_cast<double>(*r.instructions)) : std::nullopt;
      },
      db::MetricKind::kTime, true, false, true}},
    // A mebibyte is added to both sides.
    {"peak memory",
     {[](const ResultRow& r) {
        return r.peak_memory_bytes ? std::optional(1048576 + static_cast<double>(*r.peak_memory_bytes))
                                   : std::nullopt;
      },
      db::MetricKind::kMemory, true, false, false}},
    {"sweep time",
     {[](const ResultRow& r) { return std::optional(static_cast<double>(r.planning_time_ns)); },
      db::MetricKind::kTime, true, false, false}},
};

/// One number for each instance of the cells.
std::map<std::string, double> pairs_of(std::string_view metric, const std::vector<db::PairedCell>& cells,
                                       std::optional<std::size_t> only) {
  std::map<std::string, std::vector<double>> by_instance;
  for (std::size_t i = 0; i < cells.size(); ++i) {
    if (only.value_or(i) != i) continue;
    for (const db::PairedResult& result : cells[i].results) {
      if (metric == "success") {
        by_instance[result.instance_hash].push_back((solves(result.base) ? 1 : 0) -
                                                    (solves(result.head) ? 1 : 0));
        continue;
      }
      const MetricLaw& law = kLaws.at(metric);
      const auto base = law.value(result.base);
      const auto head = law.value(result.head);
      const bool comparable =
          law.of_machine ? cells[i].same_machine : solves(result.base) && solves(result.head);
      if (!comparable || !base || !head || *base <= 0 || *head <= 0) continue;
      by_instance[result.instance_hash].push_back(std::log(*head) - std::log(*base));
    }
  }
  std::map<std::string, double> pairs;
  for (const auto& [instance, values] : by_instance) {
    pairs[instance] = metric == "success"      ? std::accumulate(values.begin(), values.end(), 0.0)
                      : metric == "sweep time" ? middle(values)
                                               : mean(values);
  }
  return pairs;
}

/// Of all choices of signs, those as far from the middle.
double counted_out(const std::vector<double>& sizes) {
  double ours = 0;
  for (const double size : sizes) ours += size;
  std::size_t as_far = 0;
  const std::size_t choices = std::size_t{1} << sizes.size();
  for (std::size_t choice = 0; choice < choices; ++choice) {
    double sum = 0;
    for (std::size_t i = 0; i < sizes.size(); ++i)
      sum += (choice >> i & 1U) != 0 ? std::abs(sizes[i]) : -std::abs(sizes[i]);
    as_far += std::abs(sum) >= std::abs(ours) - 1e-9 ? 1U : 0U;
  }
  return static_cast<double>(as_far) / static_cast<double>(choices);
}

/// With the ranks of their sizes, ties sharing the mean, and their signs.
std::vector<double> signed_ranks(std::vector<double> pairs) {
  std::erase(pairs, 0.0);
  std::vector<double> ranks;
  for (const double pair : pairs) {
    double rank = 0.5;
    for (const double other : pairs)
      rank += std::abs(other) < std::abs(pair) ? 1 : std::abs(other) == std::abs(pair) ? 0.5 : 0;
    ranks.push_back(pair > 0 ? rank : -rank);
  }
  return ranks;
}

void metrics_are_as_defined() {
  const std::vector<db::PairedCell> drawn = any_cells();
  const std::vector<db::PairedCell> cells = with_results(drawn);
  Judgement judgement = measured(drawn);
  for (const Difference& row : judgement.differences) {
    const auto metric = row.metric->name;
    RC_LOG() << metric << '\n';
    const auto expected = pairs_of(metric, cells, row.cell);
    RC_ASSERT(row.pairs.size() == expected.size());
    std::vector<double> pairs;
    std::size_t place = 0;
    std::size_t worse = 0;
    std::size_t better = 0;
    for (const auto& [instance, pair] : expected) {
      RC_ASSERT(std::abs(row.pairs[place] - pair) < 1e-12);
      pairs.push_back(row.pairs[place++]);
      worse += pairs.back() > 0 ? 1U : 0U;
      better += pairs.back() < 0 ? 1U : 0U;
    }
    RC_ASSERT(row.worse() == worse);
    RC_ASSERT(row.better() == better);
    if (metric == "success") {
      std::size_t lost = 0;
      std::size_t gained = 0;
      std::size_t plannings = 0;
      for (std::size_t i = 0; i < cells.size(); ++i) {
        if (row.cell.value_or(i) != i) continue;
        for (const db::PairedResult& result : cells[i].results) {
          ++plannings;
          lost += solves(result.base) && !solves(result.head) ? 1U : 0U;
          gained += !solves(result.base) && solves(result.head) ? 1U : 0U;
        }
      }
      RC_ASSERT(row.lost == lost);
      RC_ASSERT(row.gained == gained);
      RC_ASSERT(row.plannings == plannings);
      RC_ASSERT(close(row.effect * static_cast<double>(plannings),
                      static_cast<double>(lost) - static_cast<double>(gained)));
      std::vector<double> nets = pairs;
      std::erase(nets, 0.0);
      RC_ASSERT(close(row.p_value, counted_out(nets)));
    } else {
      RC_ASSERT(close(row.effect, metric == "sweep time" ? middle(pairs) : mean(pairs)));
      const bool is_tested = metric != "sweep time" && metric != "peak memory";
      RC_ASSERT(close(row.p_value, is_tested ? counted_out(signed_ranks(pairs)) : 1));
    }
    // The interval is of as many values as there are instances, and as wide on both sides.
    if (pairs.size() >= 6 && metric != "sweep time") {
      const double scale =
          metric == "success" ? static_cast<double>(pairs.size()) / static_cast<double>(row.plannings) : 1;
      RC_ASSERT(close(row.at_most - row.effect, scale * *half_width(pairs)));
      RC_ASSERT(close(row.effect - row.at_least, scale * *half_width(pairs)));
    } else if (metric != "sweep time") {
      RC_ASSERT(row.at_most == kInfinity);
      RC_ASSERT(row.at_least == -kInfinity);
    }
  }
}

/// Base and head exchanged: what was worse is better, by as much.
void sides_are_alike() {
  std::vector<db::PairedCell> cells = any_cells();
  Judgement one = measured(cells);
  for (db::PairedCell& cell : cells) {
    for (db::PairedResult& result : cell.results) std::swap(result.base, result.head);
    // In another order, too: nothing goes by it.
    std::reverse(cell.results.begin(), cell.results.end());
  }
  Judgement other = measured(cells);
  judge(one, {});
  judge(other, {});
  RC_ASSERT(one.differences.size() == other.differences.size());
  for (std::size_t i = 0; i < one.differences.size(); ++i) {
    const Difference& a = one.differences[i];
    const Difference& b = other.differences[i];
    RC_ASSERT(std::abs(a.effect + b.effect) < 1e-12);
    RC_ASSERT(a.lost == b.gained);
    RC_ASSERT(close(a.at_least, -b.at_most));
    RC_ASSERT(a.floor == b.floor);
    // Means are rounded by the order of what they are of, which makes ties and breaks them.
    if (!close(a.p_value, b.p_value) || !close(a.adjusted_p, b.adjusted_p)) continue;
    RC_ASSERT((a.verdict == Verdict::kRegressed) == (b.verdict == Verdict::kImproved));
    RC_ASSERT((a.verdict == Verdict::kSame) == (b.verdict == Verdict::kSame));
    RC_ASSERT((a.verdict == Verdict::kEquivalent) == (b.verdict == Verdict::kEquivalent));
  }
  RC_ASSERT(one.all.base_solved == other.all.head_solved);
  RC_ASSERT(one.all.differing == other.all.differing);
}

// --- verdicts -----------------------------------------------------------------------

/// Of one row, as the words of the header have it.
Verdict verdict_of(const Difference& row, bool doubts) {
  if (std::all_of(row.pairs.begin(), row.pairs.end(), [](double pair) { return pair == 0; }))
    return Verdict::kSame;
  const bool certain = row.adjusted_p <= 0.01;
  if (certain && row.effect > row.floor && row.at_least > 0) return Verdict::kRegressed;
  if (certain && -row.effect > row.floor && row.at_most < 0) return Verdict::kImproved;
  if (std::max(std::abs(row.at_least), std::abs(row.at_most)) <= row.floor) return Verdict::kEquivalent;
  // The measured effect matters, or the interval says that it is one, and reaches to what matters.
  const bool may_be_worse = row.effect > row.floor || (row.at_least > 0 && row.at_most > row.floor);
  return doubts && !row.cell && may_be_worse ? Verdict::kInconclusive : Verdict::kChanged;
}

void verdicts_follow_from_rows() {
  Judgement judgement = measured(any_cells());
  JudgeOptions options;
  for (auto& share : options.floors.shares) share = static_cast<double>(any_whole(0, 3)) / 100;
  options.expects_changes = any_flag();
  const bool repeated = any_whole(0, 4) == 0 && !judgement.results.empty();
  if (repeated) {
    Finding finding{0, 0, {ChangeKind::kRepetition, "once", "again"}};
    const bool differed = change(judgement.result(finding).base, judgement.result(finding).head).has_value();
    const std::size_t before = judgement.all.differing;
    add_repetition(judgement, finding);
    RC_ASSERT(judgement.all.differing == before + (differed ? 0 : 1));
  }
  judge(judgement, options);
  // Which rows are judged together.
  for (const bool pooled : {true, false}) {
    std::vector<const Difference*> family;
    std::vector<double> p_values;
    for (const Difference& row : judgement.differences) {
      const auto law = kLaws.find(row.metric->name);
      const bool judges = law == kLaws.end() || (pooled ? law->second.judges_pooled : law->second.judges);
      if (row.cell.has_value() == pooled) continue;
      RC_ASSERT(row.verdict.has_value() == judges);
      if (!judges) continue;
      family.push_back(&row);
      p_values.push_back(row.p_value);
    }
    const std::vector<double> adjusted = by_closed_testing(p_values);
    for (std::size_t i = 0; i < family.size(); ++i) {
      const Difference& row = *family[i];
      RC_LOG() << row.metric->name << " of " << family.size() << '\n';
      RC_ASSERT(close(row.adjusted_p, adjusted[i]));
      const bool success = row.metric->name == "success";
      const db::MetricKind kind = success ? db::MetricKind::kSuccess : kLaws.at(row.metric->name).kind;
      const double share = options.floors.shares[static_cast<std::size_t>(kind)];
      RC_ASSERT(close(row.floor, success ? share : std::log(1 + share)));
      const double level = 0.01 / static_cast<double>(family.size());
      RC_ASSERT(row.detectable == (success ? detectable_losses(row.pairs, row.plannings, level, row.floor)
                                           : detectable_by_ranks(row.pairs, level, row.floor)));
      RC_ASSERT(row.verdict == verdict_of(row, success || row.metric->name == "flowtime"));
    }
  }
  // Of a cell, and of the whole: the gravest.
  const auto gravest = [&](const Judged& judged, std::optional<std::size_t> cell) {
    Verdict worst = judged.other_plans > 0 ? Verdict::kChanged : Verdict::kSame;
    if (judged.newly_invalid > 0) worst = Verdict::kRegressed;
    for (const Difference& row : judgement.differences) {
      const bool tells = row.verdict == Verdict::kRegressed || row.verdict == Verdict::kInconclusive ||
                         row.verdict == Verdict::kImproved;
      if (tells && (!cell || row.cell == cell)) worst = std::max(worst, *row.verdict);
    }
    return repeated && cell.value_or(0) == 0 ? Verdict::kRegressed : worst;
  };
  RC_ASSERT(judgement.all.verdict == gravest(judgement.all, std::nullopt));
  for (std::size_t i = 0; i < judgement.cells.size(); ++i)
    RC_ASSERT(judgement.cells[i].verdict == gravest(judgement.cells[i], i));
  RC_ASSERT(!judgement.all.reason.empty());
  RC_CLASSIFY(judgement.all.verdict == Verdict::kRegressed, "regressed");
  RC_CLASSIFY(judgement.all.verdict == Verdict::kImproved, "improved");
  RC_CLASSIFY(judgement.all.verdict == Verdict::kInconclusive, "inconclusive");
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

// --- reports ------------------------------------------------------------------------

void reports_say_what_was_judged() {
  Judgement judgement = measured(any_cells());
  if (judgement.results.empty()) RC_DISCARD("nothing to compare");
  judge(judgement, {});
  const Report report{judgement, "sipplab compare", "base", "head"};
  const auto json = nlohmann::json::parse(report_json(report));
  RC_ASSERT(json.at("verdict") == name(judgement.all.verdict));
  RC_ASSERT(json.at("reason") == judgement.all.reason);
  RC_ASSERT(json.at("compared") == judgement.all.compared);
  RC_ASSERT(json.at("differing") == judgement.all.differing);
  RC_ASSERT(json.at("other_plans") == judgement.all.other_plans);
  const Difference& success = *judgement.find(kSuccess, std::nullopt);
  RC_ASSERT(json.at("lost") == success.lost);
  RC_ASSERT(json.at("gained") == success.gained);
  RC_ASSERT(json.at("cells").size() == judgement.cells.size());
  for (std::size_t i = 0; i < judgement.cells.size(); ++i) {
    const auto& cell = json.at("cells")[i];
    const Judged& judged = judgement.cells[i];
    RC_ASSERT(cell.at("cell") == judged.name);
    RC_ASSERT(cell.at("instances") == judged.instances);
    RC_ASSERT(cell.at("plannings") == judged.compared);
    RC_ASSERT(cell.at("differing") == judged.differing);
    RC_ASSERT(cell.at("base_solved") == judged.base_solved);
    RC_ASSERT(cell.at("head_solved") == judged.head_solved);
    RC_ASSERT(cell.at("both_solved") == judged.both_solved);
    RC_ASSERT(cell.at("base_par2_s").is_null() == !judged.base_par2_s.has_value());
    if (judged.base_par2_s) RC_ASSERT(cell.at("base_par2_s") == *judged.base_par2_s);
    if (judged.head_par2_s) RC_ASSERT(cell.at("head_par2_s") == *judged.head_par2_s);
    RC_ASSERT(cell.at("verdict") == name(judged.verdict));
    RC_ASSERT(cell.at("environment") == judgement.results[i].parameters.environment);
    RC_ASSERT(cell.at("robots") == judgement.results[i].parameters.robots);
  }
  const auto is_number = [](const nlohmann::json& value, double expected) {
    return std::isfinite(expected) ? value.is_number() && close(value.get<double>(), expected)
                                   : value.is_null();
  };
  RC_ASSERT(json.at("differences").size() == judgement.differences.size());
  for (std::size_t i = 0; i < judgement.differences.size(); ++i) {
    const auto& said = json.at("differences")[i];
    const Difference& row = judgement.differences[i];
    const bool share = row.metric == &kSuccess;
    // Logarithms as ratios less one.
    const auto shown = [share](double value) {
      return share || !std::isfinite(value) ? value : std::exp(value) - 1;
    };
    RC_LOG() << row.metric->name << '\n';
    RC_ASSERT(said.at("metric") == row.metric->name);
    RC_ASSERT(said.at("pairs") == row.pairs.size());
    RC_ASSERT(said.at("worse") == row.worse());
    RC_ASSERT(said.at("better") == row.better());
    RC_ASSERT(is_number(said.at("effect"), shown(row.effect)));
    RC_ASSERT(is_number(said.at("at_least"), shown(row.at_least)));
    RC_ASSERT(is_number(said.at("at_most"), shown(row.at_most)));
    RC_ASSERT(is_number(said.at("floor"), shown(row.floor)));
    RC_ASSERT(is_number(said.at("detectable"), shown(row.detectable)));
    const bool is_tested = row.metric != &kMemory && row.metric != &kSweepTime;
    RC_ASSERT(said.at("p_value").is_null() == !is_tested);
    if (is_tested) RC_ASSERT(is_number(said.at("p_value"), row.p_value));
    if (is_tested) RC_ASSERT(is_number(said.at("adjusted_p_value"), row.adjusted_p));
    RC_ASSERT(said.at("verdict").is_null() == !row.verdict.has_value());
    if (row.verdict) RC_ASSERT(said.at("verdict") == name(*row.verdict));
  }
  RC_ASSERT(json.at("findings").size() == judgement.findings.size());
  for (std::size_t i = 0; i < judgement.findings.size(); ++i) {
    const auto& said = json.at("findings")[i];
    const Finding& finding = judgement.findings[i];
    RC_ASSERT(said.at("what") == name(finding.what.kind));
    RC_ASSERT(said.at("instance_hash") == judgement.result(finding).instance_hash);
    RC_ASSERT(said.at("position") == judgement.result(finding).base.position);
    RC_ASSERT(said.at("plannings") == finding.plannings);
    RC_ASSERT(said.at("base") == finding.what.base);
    RC_ASSERT(said.at("head") == finding.what.head);
  }
  // The table for people: each cell's counts in its row, and those of all in the last.
  const std::vector<TextRow> table = behaviour_table(judgement);
  RC_ASSERT(table.size() == judgement.cells.size() + 2);
  const auto column = [&table](const char* heading, std::size_t row) {
    const auto at = std::find(table[0].begin(), table[0].end(), heading);
    return at == table[0].end() ? std::string("-")
                                : table[row][static_cast<std::size_t>(at - table[0].begin())];
  };
  for (std::size_t i = 0; i <= judgement.cells.size(); ++i) {
    const std::optional<std::size_t> number = i < judgement.cells.size() ? std::optional(i) : std::nullopt;
    const Judged& judged = judgement.at(number);
    const Difference& row = *judgement.find(kSuccess, number);
    RC_ASSERT(table[i + 1][0] == judged.name);
    RC_ASSERT(column("differ", i + 1) == std::to_string(judged.differing));
    RC_ASSERT(column("solved", i + 1) ==
              std::to_string(judged.base_solved) + " -> " + std::to_string(judged.head_solved));
    RC_ASSERT(column("lost", i + 1) == std::to_string(row.lost));
    RC_ASSERT(column("gained", i + 1) == std::to_string(row.gained));
    RC_ASSERT(column("both solved", i + 1) == std::to_string(judged.both_solved));
  }
  // A test for each cell and one for the whole; failed is what regressed, skipped what nobody can tell.
  const std::string xml = report_junit(report);
  const auto occurrences = [&xml](const std::string& text) {
    std::size_t found = 0;
    for (std::size_t at = xml.find(text); at != std::string::npos; at = xml.find(text, at + 1)) ++found;
    return found;
  };
  std::size_t failed = judgement.all.verdict == Verdict::kRegressed ? 1 : 0;
  std::size_t skipped = judgement.all.verdict == Verdict::kInconclusive ? 1 : 0;
  for (const Judged& cell : judgement.cells) {
    failed += cell.verdict == Verdict::kRegressed ? 1U : 0U;
    skipped += cell.verdict == Verdict::kInconclusive ? 1U : 0U;
  }
  RC_ASSERT(occurrences("<testcase ") == judgement.cells.size() + 1);
  RC_ASSERT(occurrences("<failure ") == failed);
  RC_ASSERT(occurrences("<skipped ") == skipped);
  RC_ASSERT(occurrences("failures=\"" + std::to_string(failed) + "\" skipped=\"" + std::to_string(skipped) +
                        "\"") == 1U);
}

const PropertyRoom room("verdicts", kCasesOfHistories, [] {
  bool passed = true;

  passed &= property("Holm's p values are those of closed testing", many_tests_are_closed);
  passed &= property("bounds of a median have their confidence", bounds_have_their_confidence);
  passed &= property("means of middle halves, intervals and standard errors are as defined",
                     spreads_are_as_defined);
  passed &= property("what is detectable solves its equations", what_is_detectable_solves_its_equations);
  passed &= property("a slowdown that a gate calls detectable is found 19 times of 20",
                     what_a_gate_sees_it_finds, (kCasesOfHistories + 39) / 40);
  passed &= property("a change is called after the gravest that differs", changes_are_told_by_what_differs);
  passed &= property("every planning is counted once, and is in one finding if it differs",
                     everything_is_counted, kFewer);
  passed &=
      property("effects and chances are those of instances, by definition", metrics_are_as_defined, kFewer);
  passed &= property("base and head exchanged, worse is better", sides_are_alike, kFewer);
  passed &= property("verdicts follow from rows that are judged together", verdicts_follow_from_rows, kFewer);
  passed &= property("a gate suspects by its pairs and confirms by fresh ones", looks_of_a_gate);
  passed &= property("reports say what was judged", reports_say_what_was_judged, kFewer);

  return passed;
});

}  // namespace
}  // namespace sipplab::bench::verdicts_laws
