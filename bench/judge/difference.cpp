#include "bench/judge/difference.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <numeric>

#include "bench/judge/change.hpp"
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
  if (metric.of_work && (is_cut_short(result.base) || is_cut_short(result.head))) return std::nullopt;
  const bool comparable =
      metric.of_machine ? cell.same_machine : solved(result.base) * solved(result.head) > 0;
  if (!comparable || base <= 0 || head <= 0) return std::nullopt;
  return std::log(head / base);
}

double count(std::uint64_t value) { return static_cast<double>(value); }

double sum(const std::vector<double>& values) { return std::accumulate(values.begin(), values.end(), 0.0); }

double centre(const Metric& metric, const std::vector<double>& pairs) {
  if (pairs.empty()) return 0;
  if (metric.median) return *statistics::median(pairs);
  return sum(pairs) / static_cast<double>(pairs.size());
}

std::vector<double> negative(std::vector<double> values) {
  for (double& value : values) value = -value;
  return values;
}

double p_value(const Difference& row) {
  switch (row.metric->test) {
    case Test::kSigns:
      return statistics::sign_flips({row.pairs.begin(), row.pairs.end()});
    case Test::kRanks:
      return statistics::wilcoxon(row.pairs).value_or(1);
    case Test::kFreshPairs:
      return slower_p_value(row.pairs);
    case Test::kNone:
      break;
  }
  return 1;
}

/// A test of ranks may be certain of another direction than the mean goes: then it says nothing of the mean.
bool is_worse(const Difference& row) {
  return row.adjusted_p <= kRecordedLevel && row.effect > row.floor && row.at_least > 0;
}
bool is_better(const Difference& row) {
  return row.adjusted_p <= kRecordedLevel && row.effect < -row.floor && row.at_most < 0;
}

Verdict verdict(const Difference& row, bool same_plans) {
  if (row.worse() + row.better() == 0) return Verdict::kSame;
  if (is_worse(row)) return Verdict::kRegressed;
  if (is_better(row)) return Verdict::kImproved;
  if (row.at_most <= row.floor && row.at_least >= -row.floor) return Verdict::kEquivalent;
  // Worse by as much as matters, or by more than chance gives, and by how much is not known well enough.
  const bool is_worse_so_far = row.effect > row.floor || row.at_least > 0;
  const bool doubts = row.metric->doubts_pooled || (row.metric->doubts_work && same_plans);
  const bool doubtful = !row.cell && doubts && is_worse_so_far;
  return doubtful ? Verdict::kInconclusive : Verdict::kChanged;
}

bool is_slower(const Difference& row) { return row.adjusted_p <= kSuspicionLevel && row.effect > row.floor; }
bool is_faster(const Difference& row) {
  return row.adjusted_faster_p <= kSuspicionLevel && row.effect < -row.floor;
}

}  // namespace

const Metric kSuccess = {.name = "success",
                         .kind = db::MetricKind::kSuccess,
                         .test = Test::kSigns,
                         .judges = true,
                         .judges_pooled = true,
                         .doubts_pooled = true,
                         .value = solved};
const Metric kFlowtime = {.name = "flowtime",
                          .test = Test::kRanks,
                          .judges = true,
                          .judges_pooled = true,
                          .doubts_pooled = true,
                          .value = [](const db::ResultRow& row) { return row.flowtime_s.value_or(0); }};
const Metric kMakespan = {
    .name = "makespan", .test = Test::kRanks, .judges_pooled = true, .value = [](const db::ResultRow& row) {
      return row.makespan_s.value_or(0);
    }};
const Metric kExpansions = {.name = "expansions",
                            .kind = db::MetricKind::kCounts,
                            .test = Test::kRanks,
                            .judges = true,
                            .judges_pooled = true,
                            .doubts_work = true,
                            .value = [](const db::ResultRow& row) { return count(row.expansions); },
                            .of_work = true};
const Metric kGenerations = {.name = "generations",
                             .kind = db::MetricKind::kCounts,
                             .test = Test::kRanks,
                             .judges_pooled = true,
                             .value = [](const db::ResultRow& row) { return count(row.generations); },
                             .of_work = true};
const Metric kTries = {.name = "tries",
                       .kind = db::MetricKind::kCounts,
                       .test = Test::kRanks,
                       .judges_pooled = true,
                       .value = [](const db::ResultRow& row) { return count(row.tries); },
                       .of_work = true};
const Metric kInstructions = {.name = "instructions",
                              .kind = db::MetricKind::kTime,
                              .test = Test::kRanks,
                              .judges_pooled = true,
                              .value =
                                  [](const db::ResultRow& row) {
                                    return count(static_cast<std::uint64_t>(row.instructions.value_or(0)));
                                  },
                              .of_machine = true,
                              .of_work = true};
const Metric kMemory = {.name = "peak memory",
                        .kind = db::MetricKind::kMemory,
                        .value =
                            [](const db::ResultRow& row) {
                              if (!row.peak_memory_bytes) return 0.0;
                              return kMemoryGrainBytes + static_cast<double>(*row.peak_memory_bytes);
                            },
                        .of_machine = true};
const Metric kSweepTime = {
    .name = "sweep time",
    .kind = db::MetricKind::kTime,
    .median = true,
    .value = [](const db::ResultRow& row) { return static_cast<double>(row.planning_time_ns); },
    .of_machine = true};
const Metric kProcessTime = {.name = "time",
                             .kind = db::MetricKind::kTime,
                             .test = Test::kFreshPairs,
                             .median = true,
                             .judges = true,
                             .judges_pooled = true};
const Metric kProcessMemory = {.name = "memory",
                               .kind = db::MetricKind::kMemory,
                               .test = Test::kFreshPairs,
                               .median = true,
                               .judges_pooled = true};

double Floors::of(const Metric& metric) const {
  const double share = shares[static_cast<std::size_t>(metric.kind)];
  return metric.test == Test::kSigns ? share : std::log1p(share);
}

std::string_view name(Verdict verdict) {
  constexpr std::string_view kNames[] = {"same",    "equivalent",   "improved",
                                         "changed", "inconclusive", "regressed"};
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

bool is_news(const Difference& row) {
  return row.verdict == Verdict::kRegressed || row.verdict == Verdict::kInconclusive ||
         row.verdict == Verdict::kImproved;
}

void evaluate(Difference& row) {
  // Lost plannings are counted by instance, and are a share of all plannings.
  const double scale = row.metric->test == Test::kSigns && row.plannings > 0
                           ? count(row.pairs.size()) / count(row.plannings)
                           : 1;
  row.effect = scale * centre(*row.metric, row.pairs);
  row.p_value = row.adjusted_p = p_value(row);
  if (row.metric->median) {
    row.at_least = lower_bound(row.pairs);
    row.at_most = upper_bound(row.pairs);
  } else if (const auto half = half_width(row.pairs)) {
    row.at_least = row.effect - scale * *half;
    row.at_most = row.effect + scale * *half;
  }
}

Difference measured(const Metric& metric, const std::vector<const db::PairedCell*>& cells,
                    std::optional<std::size_t> cell) {
  std::map<std::string_view, std::vector<double>> by_instance;
  Difference row;
  row.metric = &metric;
  row.cell = cell;
  for (const db::PairedCell* paired : cells) {
    for (const db::PairedResult& result : paired->results) {
      const auto pair = pair_of(metric, *paired, result);
      if (!pair) continue;
      by_instance[result.instance_hash].push_back(*pair);
      ++row.plannings;
      row.lost += metric.test == Test::kSigns && *pair > 0 ? 1U : 0U;
      row.gained += metric.test == Test::kSigns && *pair < 0 ? 1U : 0U;
    }
  }
  for (const auto& [instance, pairs] : by_instance) {
    row.pairs.push_back(metric.test == Test::kSigns ? sum(pairs) : centre(metric, pairs));
  }
  evaluate(row);
  return row;
}

void judge_recorded(const std::vector<Difference*>& family, const Floors& floors, bool same_plans) {
  std::vector<double> p_values;
  for (const Difference* row : family) p_values.push_back(row->p_value);
  const std::vector<double> adjusted = holm(p_values);
  for (std::size_t i = 0; i < family.size(); ++i) {
    Difference& row = *family[i];
    row.adjusted_p = adjusted[i];
    row.floor = floors.of(*row.metric);
    const double level = kRecordedLevel / count(family.size());
    row.detectable = row.metric->test == Test::kSigns
                         ? detectable_losses(row.pairs, row.plannings, level, row.floor)
                         : detectable_by_ranks(row.pairs, level, row.floor);
    row.verdict = verdict(row, same_plans);
  }
}

void judge_times(const std::vector<Difference*>& rows) {
  std::vector<double> slower;
  std::vector<double> faster;
  for (const Difference* row : rows) {
    slower.push_back(row->p_value);
    faster.push_back(slower_p_value(negative(row->pairs)));
  }
  slower = holm(slower);
  faster = holm(faster);
  for (std::size_t i = 0; i < rows.size(); ++i) {
    rows[i]->adjusted_p = slower[i];
    rows[i]->adjusted_faster_p = faster[i];
  }
}

bool needs_second_look(const Difference& row, double tolerance) {
  return is_slower(row) || is_faster(row) || row.at_most >= tolerance;
}

void second_look(Difference& row, double tolerance) {
  row.verdict = Verdict::kEquivalent;
  if (row.fresh_pairs.empty()) return;
  const bool faster = is_faster(row);
  const bool suspected = faster || is_slower(row);
  row.confirmation = Confirmation{centre(*row.metric, row.fresh_pairs),
                                  slower_p_value(faster ? negative(row.fresh_pairs) : row.fresh_pairs)};
  std::vector<double> all = row.pairs;
  all.insert(all.end(), row.fresh_pairs.begin(), row.fresh_pairs.end());
  row.at_least = lower_bound(all);
  row.at_most = upper_bound(all);
  const double confirmed = faster ? -row.confirmation->effect : row.confirmation->effect;
  if (suspected && row.confirmation->p_value <= kConfirmationLevel && confirmed > row.floor) {
    row.verdict = faster ? Verdict::kImproved : Verdict::kRegressed;
    row.effect = centre(*row.metric, all);
  } else if (row.at_most >= tolerance) {
    row.verdict = Verdict::kInconclusive;
  }
}

}  // namespace sipplab::bench
