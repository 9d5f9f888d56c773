#include "bench/judge/difference.hpp"

#include <algorithm>
#include <cmath>
#include <map>

#include "bench/judge/evidence.hpp"
#include "db/statistics/statistics.hpp"

namespace sipplab::bench {
namespace {

namespace statistics = db::statistics;

double solved(const db::ResultRow& row) { return row.status == db::ResultStatus::kSolved ? 1 : 0; }

/// None if the planning says nothing of the metric.
std::optional<double> pair_of(const Metric& metric, const db::PairedCell& cell,
                              const db::PairedResult& result) {
  const double base = metric.value(result.base);
  const double head = metric.value(result.head);
  if (metric.test == Test::kSigns) return base - head;
  const bool comparable = metric.of_time ? cell.same_machine : solved(result.base) * solved(result.head) > 0;
  if (!comparable || base <= 0 || head <= 0) return std::nullopt;
  return std::log(head / base);
}

double centre(const Metric& metric, const std::vector<double>& pairs) {
  if (pairs.empty()) return 0;
  if (metric.median) return *statistics::median(pairs);
  double sum = 0;
  for (const double pair : pairs) sum += pair;
  return sum / static_cast<double>(pairs.size());
}

double p_value(const Difference& row) {
  switch (row.metric->test) {
    case Test::kSigns:
      return statistics::mcnemar(row.worse(), row.better());
    case Test::kRanks:
      return statistics::wilcoxon(row.pairs).value_or(1);
    case Test::kFreshPairs:
      return slower_p_value(row.pairs);
    case Test::kNone:
      break;
  }
  return 1;
}

bool judges(const Difference& row) { return row.cell ? row.metric->judges : row.metric->judges_pooled; }

bool is_suspected(const Difference& row) {
  return row.adjusted_p <= row.metric->level && row.effect > row.floor;
}

Verdict verdict(const Difference& row) {
  if (is_suspected(row)) return Verdict::kRegressed;
  if (!row.cell && row.metric->doubts_pooled && row.effect > row.floor) return Verdict::kInconclusive;
  return row.worse() + row.better() > 0 ? Verdict::kChanged : Verdict::kSame;
}

}  // namespace

// Thresholds: chance of calling equal rates of success different in some cell; the same for flowtimes, which
// a change of plans always moves, and 1 %, so that a certain but tiny loss fails no build.
const Metric kSuccess = {.name = "success",
                         .test = Test::kSigns,
                         .level = 0.05,
                         .judges = true,
                         .judges_pooled = true,
                         .doubts_pooled = true,
                         .value = solved};
const Metric kFlowtime = {.name = "flowtime",
                          .test = Test::kRanks,
                          .level = 0.01,
                          .floor = 0.00995,
                          .judges = true,
                          .value = [](const db::ResultRow& row) { return row.flowtime_s.value_or(0); }};
const Metric kMakespan = {.name = "makespan", .test = Test::kRanks, .value = [](const db::ResultRow& row) {
                            return row.makespan_s.value_or(0);
                          }};
const Metric kExpansions = {
    .name = "expansions", .test = Test::kRanks, .value = [](const db::ResultRow& row) {
      return static_cast<double>(row.expansions);
    }};
const Metric kSweepTime = {
    .name = "sweep time",
    .median = true,
    .value = [](const db::ResultRow& row) { return static_cast<double>(row.planning_time_ns); },
    .of_time = true};
const Metric kProcessTime = {.name = "time",
                             .test = Test::kFreshPairs,
                             .median = true,
                             .level = kSuspicionLevel,
                             .floor = kLeastFloor,
                             .judges = true,
                             .judges_pooled = true};

std::string_view name(Verdict verdict) {
  constexpr std::string_view kNames[] = {"same", "equivalent", "changed", "inconclusive", "regressed"};
  return kNames[static_cast<std::size_t>(verdict)];
}

std::size_t Difference::worse() const {
  return static_cast<std::size_t>(
      std::count_if(pairs.begin(), pairs.end(), [](double pair) { return pair > 0; }));
}

std::size_t Difference::better() const {
  return static_cast<std::size_t>(
      std::count_if(pairs.begin(), pairs.end(), [](double pair) { return pair < 0; }));
}

void evaluate(Difference& row) {
  row.effect = centre(*row.metric, row.pairs);
  row.p_value = row.adjusted_p = p_value(row);
  if (row.metric->test == Test::kSigns) return;  // shares have no interval of this kind
  if (row.metric->median) {
    row.at_least = lower_bound(row.pairs);
    row.at_most = upper_bound(row.pairs);
  } else if (const auto half = half_width(row.pairs)) {
    row.at_least = row.effect - *half;
    row.at_most = row.effect + *half;
  }
}

Difference measured(const Metric& metric, const std::vector<const db::PairedCell*>& cells,
                    std::optional<std::size_t> cell) {
  std::map<std::string_view, std::vector<double>> by_instance;
  for (const db::PairedCell* paired : cells) {
    for (const db::PairedResult& result : paired->results) {
      if (const auto pair = pair_of(metric, *paired, result))
        by_instance[result.instance_hash].push_back(*pair);
    }
  }
  Difference row;
  row.metric = &metric;
  row.cell = cell;
  row.floor = metric.floor;
  for (const auto& [instance, pairs] : by_instance) {
    const double pair = centre(metric, pairs);
    // Lost in most cells is lost, however many there are.
    row.pairs.push_back(metric.test == Test::kSigns ? (pair > 0 ? 1.0 : 0.0) - (pair < 0 ? 1.0 : 0.0) : pair);
  }
  evaluate(row);
  return row;
}

void judge_rows(const std::vector<Difference*>& rows) {
  // A row over all cells that only informs leaves the p values of the others alone.
  std::vector<Difference*> family;
  std::vector<double> p_values;
  for (Difference* row : rows) {
    if (!row->cell && !judges(*row)) continue;
    family.push_back(row);
    p_values.push_back(row->p_value);
  }
  const std::vector<double> adjusted = holm(p_values);
  for (std::size_t i = 0; i < family.size(); ++i) {
    family[i]->adjusted_p = adjusted[i];
    const bool now = judges(*family[i]) && family[i]->metric->test != Test::kFreshPairs;
    if (now) family[i]->verdict = verdict(*family[i]);
  }
}

bool needs_second_look(const Difference& row, double tolerance) {
  return is_suspected(row) || row.at_most >= tolerance;
}

void second_look(Difference& row, double tolerance) {
  row.verdict = Verdict::kEquivalent;
  if (row.fresh_pairs.empty()) return;
  row.confirmation = Confirmation{centre(*row.metric, row.fresh_pairs), slower_p_value(row.fresh_pairs)};
  std::vector<double> all = row.pairs;
  all.insert(all.end(), row.fresh_pairs.begin(), row.fresh_pairs.end());
  row.at_least = lower_bound(all);
  row.at_most = upper_bound(all);
  if (is_suspected(row) && row.confirmation->p_value <= kConfirmationLevel &&
      row.confirmation->effect > row.floor) {
    row.verdict = Verdict::kRegressed;
  } else if (row.at_most >= tolerance) {
    row.verdict = Verdict::kInconclusive;
  }
}

}  // namespace sipplab::bench
