#include "bench/judge/compare.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>

#include "bench/judge/holm.hpp"
#include "db/statistics/statistics.hpp"

namespace sipplab::bench {
namespace {

namespace statistics = db::statistics;

/// Chance of calling equal success rates different in some cell.
constexpr double kSuccessLevel = 0.05;
/// The same for flowtimes, which a change of plans always moves: together with the share
/// below, so that a certain but tiny loss fails nobody.
constexpr double kQualityLevel = 0.01;
constexpr double kQualityLoss = 0.01;

bool is_solved(const db::ResultRow& row) { return row.status == db::ResultStatus::kSolved; }

std::optional<double> par2(const db::PairedCell& cell, db::ResultRow db::PairedResult::*side) {
  if (std::isinf(cell.parameters.time_limit_s)) return std::nullopt;
  constexpr double kSecondsPerNanosecond = 1e-9;
  std::vector<statistics::TimedResult> times;
  for (const db::PairedResult& result : cell.results) {
    const db::ResultRow& row = result.*side;
    times.push_back({is_solved(row), static_cast<double>(row.planning_time_ns) * kSecondsPerNanosecond,
                     cell.parameters.time_limit_s});
  }
  return statistics::par2(times);
}

using Groups = std::vector<std::vector<std::size_t>>;

/// Indices of a cell's results, those of one instance together, in order of first appearance.
Groups results_by_instance(const db::PairedCell& cell) {
  Groups groups;
  std::map<std::string_view, std::size_t> group_of;
  for (std::size_t i = 0; i < cell.results.size(); ++i) {
    const auto [known, is_new] = group_of.emplace(cell.results[i].instance_hash, groups.size());
    if (is_new) groups.emplace_back();
    groups[known->second].push_back(i);
  }
  return groups;
}

QualityChange quality(const db::PairedCell& cell, const Groups& instances,
                      std::optional<double> db::ResultRow::*value) {
  std::vector<double> differences;
  double base_sum = 0;
  double head_sum = 0;
  for (const std::vector<std::size_t>& instance : instances) {
    double base = 0;
    double head = 0;
    double count = 0;
    for (const std::size_t i : instance) {
      const db::PairedResult& result = cell.results[i];
      if (!is_solved(result.base) || !is_solved(result.head)) continue;
      base += (result.base.*value).value_or(0);
      head += (result.head.*value).value_or(0);
      ++count;
    }
    if (count == 0) continue;
    differences.push_back((head - base) / count);
    base_sum += base / count;
    head_sum += head / count;
  }
  QualityChange change;
  if (base_sum > 0) change.mean_ratio = head_sum / base_sum;
  change.p_value = statistics::wilcoxon(differences).value_or(1);
  return change;
}

/// Median over instances of the median over their plannings.
std::optional<double> time_ratio(const db::PairedCell& cell, const Groups& instances) {
  if (!cell.same_machine) return std::nullopt;
  std::vector<double> medians;
  for (const std::vector<std::size_t>& instance : instances) {
    std::vector<double> log_ratios;
    for (const std::size_t i : instance) {
      const db::PairedResult& result = cell.results[i];
      if (result.base.planning_time_ns <= 0 || result.head.planning_time_ns <= 0) continue;
      log_ratios.push_back(std::log(static_cast<double>(result.head.planning_time_ns) /
                                    static_cast<double>(result.base.planning_time_ns)));
    }
    if (const auto median = statistics::median(std::move(log_ratios))) medians.push_back(*median);
  }
  const std::optional<double> median = statistics::median(std::move(medians));
  if (!median) return std::nullopt;
  return std::exp(*median);
}

/// Enters an instance as lost or gained where one side solves it more often.
void count_flip(const db::PairedCell& cell, const std::vector<std::size_t>& instance,
                CellComparison& comparison) {
  std::optional<std::size_t> base_alone;
  std::optional<std::size_t> head_alone;
  std::ptrdiff_t balance = 0;
  for (const std::size_t i : instance) {
    const bool base = is_solved(cell.results[i].base);
    const bool head = is_solved(cell.results[i].head);
    if (base && !head && !base_alone) base_alone = i;
    if (head && !base && !head_alone) head_alone = i;
    balance += (head ? 1 : 0) - (base ? 1 : 0);
  }
  if (balance < 0) comparison.lost.push_back(*base_alone);
  if (balance > 0) comparison.gained.push_back(*head_alone);
}

CellComparison compare_cell(const db::PairedCell& cell) {
  CellComparison comparison;
  comparison.cell = &cell;
  for (std::size_t i = 0; i < cell.results.size(); ++i) {
    const db::PairedResult& result = cell.results[i];
    if (const auto what = difference(result.base, result.head)) {
      comparison.differences.push_back({i, *what});
    } else if (is_cut_short(result.base) || is_cut_short(result.head)) {
      ++comparison.cut_short;
    }
    const bool base = is_solved(result.base);
    const bool head = is_solved(result.head);
    comparison.base_solved += base ? 1U : 0U;
    comparison.head_solved += head ? 1U : 0U;
    comparison.both_solved += base && head ? 1U : 0U;
    const bool newly_invalid =
        result.head.status == db::ResultStatus::kInvalid && result.base.status != db::ResultStatus::kInvalid;
    comparison.head_invalid += newly_invalid ? 1U : 0U;
  }
  const Groups instances = results_by_instance(cell);
  comparison.instances = instances.size();
  for (const std::vector<std::size_t>& instance : instances) count_flip(cell, instance, comparison);
  comparison.success_p = statistics::mcnemar(comparison.lost.size(), comparison.gained.size());
  comparison.time_ratio = time_ratio(cell, instances);
  comparison.base_par2_s = par2(cell, &db::PairedResult::base);
  comparison.head_par2_s = par2(cell, &db::PairedResult::head);
  comparison.flowtime = quality(cell, instances, &db::ResultRow::flowtime_s);
  comparison.makespan = quality(cell, instances, &db::ResultRow::makespan_s);
  return comparison;
}

/// Why the head is worse in a cell; empty where it is not.
std::string cell_regression(const CellComparison& cell) {
  if (cell.head_invalid > 0) return fmt::format("{} plans of the head are invalid", cell.head_invalid);
  if (cell.lost.size() > cell.gained.size() && cell.success_p <= kSuccessLevel) {
    return fmt::format("instances: {} lost, {} gained (p = {:.2g})", cell.lost.size(), cell.gained.size(),
                       cell.success_p);
  }
  const QualityChange& flowtime = cell.flowtime;
  if (flowtime.mean_ratio > 1 + kQualityLoss && flowtime.p_value <= kQualityLevel) {
    return fmt::format("flowtime {:+.1f} % on what both solved (p = {:.2g})", 100 * (flowtime.mean_ratio - 1),
                       flowtime.p_value);
  }
  return "";
}

/// Replaces p values by Holm's, each kind over all cells, and judges the cells by them.
void adjust(CompareResult& result) {
  std::vector<double> success;
  std::vector<double> flowtime;
  std::vector<double> makespan;
  for (const CellComparison& cell : result.cells) {
    success.push_back(cell.success_p);
    flowtime.push_back(cell.flowtime.p_value);
    makespan.push_back(cell.makespan.p_value);
  }
  success.push_back(statistics::mcnemar(result.lost, result.gained));
  success = holm(success);
  flowtime = holm(flowtime);
  makespan = holm(makespan);
  for (std::size_t i = 0; i < result.cells.size(); ++i) {
    result.cells[i].success_p = success[i];
    result.cells[i].flowtime.p_value = flowtime[i];
    result.cells[i].makespan.p_value = makespan[i];
    result.cells[i].regression = cell_regression(result.cells[i]);
  }
  result.success_p = success.back();
}

/// The first reason to call the head worse; empty for none.
std::string regression(const CompareResult& result, const CompareOptions& options) {
  for (const CellComparison& cell : result.cells) {
    if (cell.regression.empty()) continue;
    return fmt::format("{}, {} robots: {}", cell.cell->parameters.environment, cell.cell->parameters.robots,
                       cell.regression);
  }
  if (result.lost > result.gained && result.success_p <= kSuccessLevel) {
    return fmt::format("instances: {} lost, {} gained over all cells (p = {:.2g})", result.lost,
                       result.gained, result.success_p);
  }
  if (options.exact && result.differing > 0) {
    return fmt::format("{} of {} plannings gave another result", result.differing, result.compared);
  }
  return "";
}

}  // namespace

std::string sameness_text(const CompareResult& result) {
  if (result.cut_short == 0) {
    return fmt::format("all {} plannings gave the same status, plan and work", result.compared);
  }
  return fmt::format(
      "all {} plannings gave the same status, and the same plan and work but for {} that the clock cut "
      "short, "
      "which were not compared in these",
      result.compared, result.cut_short);
}

std::string_view name(CompareVerdict verdict) {
  switch (verdict) {
    case CompareVerdict::kSame:
      return "same";
    case CompareVerdict::kChanged:
      return "changed";
    case CompareVerdict::kInconclusive:
      return "inconclusive";
    case CompareVerdict::kRegressed:
      return "regressed";
  }
  return "unknown";
}

CompareResult compare(const std::vector<db::PairedCell>& cells, const CompareOptions& options) {
  CompareResult result;
  // An instance in several cells, such as with several intervals, is one observation of all of them.
  std::map<std::string, std::ptrdiff_t> balance;
  for (const db::PairedCell& cell : cells) {
    if (cell.results.empty()) continue;
    CellComparison comparison = compare_cell(cell);
    result.compared += cell.results.size();
    result.differing += comparison.differences.size();
    result.cut_short += comparison.cut_short;
    for (const std::size_t i : comparison.lost) --balance[cell.results[i].instance_hash];
    for (const std::size_t i : comparison.gained) ++balance[cell.results[i].instance_hash];
    result.cells.push_back(std::move(comparison));
  }
  for (const auto& [instance, cells_gained] : balance) {
    result.lost += cells_gained < 0 ? 1U : 0U;
    result.gained += cells_gained > 0 ? 1U : 0U;
  }
  adjust(result);
  result.reason = regression(result, options);
  if (!result.reason.empty()) {
    result.verdict = CompareVerdict::kRegressed;
  } else if (result.lost > result.gained) {
    result.verdict = CompareVerdict::kInconclusive;
    result.reason = fmt::format("instances: {} lost, {} gained, which may be chance (p = {:.2g})",
                                result.lost, result.gained, result.success_p);
  } else if (result.differing > 0) {
    result.verdict = CompareVerdict::kChanged;
    result.reason = fmt::format("{} of {} plannings gave another result, and nothing is worse for certain",
                                result.differing, result.compared);
  } else {
    result.reason = sameness_text(result);
  }
  return result;
}

}  // namespace sipplab::bench
