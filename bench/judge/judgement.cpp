#include "bench/judge/judgement.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <set>
#include <string_view>
#include <tuple>
#include <utility>

#include "bench/judge/case_words.hpp"
#include "db/statistics/statistics.hpp"

namespace sipplab::bench {
namespace {

bool is_solved(const db::ResultRow& row) { return row.status == db::ResultStatus::kSolved; }

std::optional<double> par2(const db::PairedCell& cell, db::ResultRow db::PairedResult::*side) {
  if (std::isinf(cell.parameters.real("time_limit_s"))) return std::nullopt;
  constexpr double kSecondsPerNanosecond = 1e-9;
  std::vector<db::statistics::TimedResult> times;
  for (const db::PairedResult& result : cell.results) {
    const db::ResultRow& row = result.*side;
    times.push_back({is_solved(row), static_cast<double>(row.planning_time_ns) * kSecondsPerNanosecond,
                     cell.parameters.real("time_limit_s")});
  }
  return db::statistics::par2(times);
}

/// Adds one planning; whether it differs.
bool count(const db::PairedResult& result, bool differs, Judged& counts) {
  const bool base = is_solved(result.base);
  const bool head = is_solved(result.head);
  const bool invalid =
      result.head.status == db::ResultStatus::kInvalid && result.base.status != db::ResultStatus::kInvalid;
  ++counts.compared;
  counts.base_solved += base ? 1U : 0U;
  counts.head_solved += head ? 1U : 0U;
  counts.both_solved += base && head ? 1U : 0U;
  counts.newly_invalid += invalid ? 1U : 0U;
  counts.differing += differs ? 1U : 0U;
  counts.cut_short += !differs && (is_cut_short(result.base) || is_cut_short(result.head)) ? 1U : 0U;
  return differs;
}

void find_changes(Judgement& judgement, std::size_t number) {
  std::map<std::tuple<std::string_view, ChangeKind, std::string, std::string>, std::size_t> known;
  const std::vector<db::PairedResult>& results = judgement.results[number].results;
  for (std::size_t i = 0; i < results.size(); ++i) {
    auto what = change(results[i].base, results[i].head);
    count(results[i], what.has_value(), judgement.all);
    if (!count(results[i], what.has_value(), judgement.cells[number])) continue;
    const std::string_view instance = results[i].instance_hash;
    const auto [place, is_new] = known.emplace(std::make_tuple(instance, what->kind, what->base, what->head),
                                               judgement.findings.size());
    if (is_new) judgement.findings.push_back({number, i, std::move(*what), 0});
    ++judgement.findings[place->second].plannings;
  }
}

std::size_t instances(const std::vector<const db::PairedCell*>& cells) {
  std::set<std::string_view> hashes;
  for (const db::PairedCell* cell : cells) {
    for (const db::PairedResult& result : cell->results) hashes.insert(result.instance_hash);
  }
  return hashes.size();
}

/// Validity first, then what the head lost, then what it gained.
int rank(const Judgement& judgement, const Finding& finding) {
  if (finding.what.kind == ChangeKind::kValidity) return 0;
  if (finding.what.kind != ChangeKind::kStatus) return 3;
  return is_solved(judgement.result(finding).head) ? 2 : 1;
}

/// "flowtime +1.3 % in warehouse, 64 robots (p = 2e-05)": what a row says that is no good.
std::string words(const Judgement& judgement, const Difference& row, double tolerance) {
  const std::string where =
      row.cell ? "in " + judgement.cells[*row.cell].name : std::string("over all cells");
  const bool regressed = row.verdict == Verdict::kRegressed;
  const auto percent = [](double effect) { return 100 * std::expm1(effect); };
  if (row.metric == &kProcessTime) {
    return regressed
               ? fmt::format("slower by {:.1f} % {}", percent(row.confirmation->effect), where)
               : fmt::format("too noisy now to rule out a slowdown of {:.1f} % {}", 100 * tolerance, where);
  }
  const std::string what = row.metric == &kSuccess
                               ? fmt::format("instances: {} lost, {} gained", row.worse(), row.better())
                               : fmt::format("{} {:+.1f} %", row.metric->name, percent(row.effect));
  return fmt::format("{} {}{} (p = {:.2g})", what, where, regressed ? "" : ", which may be chance",
                     row.adjusted_p);
}

/// Raises cells and the whole by the rows of one metric. For the whole the row over all cells speaks where
/// none is graver, else the cell that is worst.
void judge_metric(Judgement& judgement, const std::vector<Difference*>& rows, double tolerance) {
  const Difference* worst = nullptr;
  std::map<Verdict, std::size_t> cells;
  for (const Difference* row : rows) {
    if (!row->verdict || *row->verdict <= Verdict::kChanged) continue;
    if (row->cell) judgement.cells[*row->cell].raise(*row->verdict, words(judgement, *row, tolerance));
    cells[*row->verdict] += row->cell ? 1U : 0U;
    if (worst == nullptr || *row->verdict > *worst->verdict ||
        (*row->verdict == *worst->verdict && worst->cell && row->effect > worst->effect)) {
      worst = row;
    }
  }
  if (worst == nullptr) return;
  const std::size_t others = cells[*worst->verdict] - (worst->cell ? 1U : 0U);
  judgement.all.raise(*worst->verdict,
                      words(judgement, *worst, tolerance) +
                          (others > 0 ? fmt::format("; cells like that: {} more", others) : ""));
}

void judge_behaviour(Judgement& judgement, Verdict changed) {
  const auto raise = [changed](Judged& judged, const std::string& first) {
    if (judged.newly_invalid > 0) {
      judged.raise(Verdict::kRegressed,
                   fmt::format("{} plans of the head are invalid", judged.newly_invalid));
    }
    if (judged.differing == 0) return;
    const std::string why = changed == Verdict::kRegressed ? "first " + first
                            : changed == Verdict::kChanged ? "and nothing is worse for certain"
                                                           : "as allowed";
    judged.raise(changed, fmt::format("{} of {} plannings gave another result, {}", judged.differing,
                                      judged.compared, why));
  };
  std::vector<bool> known(judgement.cells.size(), false);
  for (const Finding& finding : judgement.findings) {
    const std::string& instance = judgement.result(finding).instance;
    Judged& cell = judgement.cells[finding.cell];
    if (finding.what.kind == ChangeKind::kRepetition) {
      for (Judged* judged : {&cell, &judgement.all}) {
        judged->raise(Verdict::kRegressed, instance + " gives another result when it is planned again");
      }
    }
    if (!known[finding.cell]) raise(cell, instance);
    known[finding.cell] = true;
  }
  if (!judgement.findings.empty())
    raise(judgement.all, judgement.result(judgement.findings.front()).instance);
}

std::string sameness_text(const Judged& all) {
  if (all.cut_short == 0)
    return fmt::format("all {} plannings gave the same status, plan and work", all.compared);
  return fmt::format(
      "all {} plannings gave the same status, and the same plan and work but for {} that the clock cut "
      "short, which were not compared in these",
      all.compared, all.cut_short);
}

}  // namespace

void Judged::raise(Verdict to, const std::string& why) {
  if (to < verdict) return;
  reason = to > verdict || reason.empty() ? why : reason + "; " + why;
  verdict = to;
}

const Difference* Judgement::find(const Metric& metric, std::optional<std::size_t> cell) const {
  for (const Difference& row : differences) {
    if (row.metric == &metric && row.cell == cell) return &row;
  }
  return nullptr;
}

Judgement measured(std::vector<db::PairedCell> cells, std::vector<std::string> names) {
  Judgement judgement;
  std::erase_if(cells, [](const db::PairedCell& cell) { return cell.results.empty(); });
  judgement.results = std::move(cells);
  std::vector<db::CaseInfo> cases;
  std::vector<const db::PairedCell*> all;
  for (const db::PairedCell& cell : judgement.results) {
    cases.push_back(cell.parameters);
    all.push_back(&cell);
  }
  if (names.empty()) names = case_words(cases);
  judgement.all.name = "all cells";
  judgement.all.instances = instances(all);
  for (std::size_t i = 0; i < all.size(); ++i) {
    Judged cell;
    cell.name = names[i];
    if (!all[i]->base_planner.empty()) {
      cell.name += fmt::format(", {} against {}", all[i]->parameters.planner, all[i]->base_planner);
    }
    cell.instances = instances({all[i]});
    cell.base_par2_s = par2(*all[i], &db::PairedResult::base);
    cell.head_par2_s = par2(*all[i], &db::PairedResult::head);
    judgement.cells.push_back(std::move(cell));
    find_changes(judgement, i);
  }
  std::stable_sort(
      judgement.findings.begin(), judgement.findings.end(),
      [&judgement](const Finding& a, const Finding& b) { return rank(judgement, a) < rank(judgement, b); });
  for (const Metric* metric : kRecordedMetrics) {
    judgement.differences.push_back(measured(*metric, all, std::nullopt));
    for (std::size_t i = 0; i < all.size(); ++i) {
      judgement.differences.push_back(measured(*metric, {all[i]}, i));
    }
  }
  return judgement;
}

void add_repetition(Judgement& judgement, Finding finding) {
  const db::PairedResult& result = judgement.result(finding);
  const std::size_t added = change(result.base, result.head) ? 0 : 1;  // else it is counted
  judgement.cells[finding.cell].differing += added;
  judgement.all.differing += added;
  judgement.findings.push_back(std::move(finding));
}

void judge(Judgement& judgement, const JudgeOptions& options) {
  judge_behaviour(judgement, options.changed);
  std::map<const Metric*, std::vector<Difference*>> metrics;
  for (Difference& row : judgement.differences) metrics[row.metric].push_back(&row);
  for (const Metric* metric : kRecordedMetrics) {
    judge_rows(metrics[metric]);
    for (Difference* row : metrics[metric]) {
      if (metric == &kFlowtime && !options.quality) row->verdict.reset();
    }
    judge_metric(judgement, metrics[metric], options.tolerance);
  }
  Judged& all = judgement.all;
  if (const std::vector<Difference*>& times = metrics[&kProcessTime]; !times.empty()) {
    const bool slower = std::any_of(times.begin(), times.end(), [](const Difference* row) {
      return row->verdict > Verdict::kEquivalent;
    });
    const bool excused = slower && !options.times_excuse.empty() && judgement.findings.empty();
    if (!excused) judge_metric(judgement, times, options.tolerance);
    all.raise(Verdict::kEquivalent, excused ? options.times_excuse : "no slowdown");
  }
  if (all.verdict > Verdict::kEquivalent || all.differing > 0) return;
  all.reason = sameness_text(all) + (all.reason.empty() ? "" : "; " + all.reason);
}

std::string_view heading(const Judgement& judgement, const Finding& finding) {
  const int place = rank(judgement, finding);
  return place == 1 ? "lost" : place == 2 ? "gained" : name(finding.what.kind);
}

std::string behaviour_text(const Judgement& judgement) {
  const Judged& all = judgement.all;
  if (all.differing == 0) return sameness_text(all);
  const Difference& success = *judgement.find(kSuccess, std::nullopt);
  return fmt::format("{} of {} plannings differ; instances: {} lost, {} gained, p = {:.2g}", all.differing,
                     all.compared, success.worse(), success.better(), success.adjusted_p);
}

}  // namespace sipplab::bench
