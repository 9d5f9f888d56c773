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
bool count(const db::PairedResult& result, const std::optional<Change>& what, Judged& counts) {
  const bool differs = what.has_value();
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
  counts.other_plans += differs && what->kind != ChangeKind::kWork ? 1U : 0U;
  counts.cut_short += !differs && (is_cut_short(result.base) || is_cut_short(result.head)) ? 1U : 0U;
  return differs;
}

void find_changes(Judgement& judgement, std::size_t number) {
  std::map<std::tuple<std::string_view, ChangeKind, std::string, std::string>, std::size_t> known;
  const std::vector<db::PairedResult>& results = judgement.results[number].results;
  for (std::size_t i = 0; i < results.size(); ++i) {
    auto what = change(results[i].base, results[i].head);
    if (judgement.results[number].is_planning) {
      count(results[i], what, judgement.all);
    } else {
      ++judgement.all.tasks;
      judgement.all.other_tasks += what ? 1U : 0U;
    }
    if (!count(results[i], what, judgement.cells[number])) continue;
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

/// Validity first, then what the head lost, what it gained, other plans and at last other work.
int rank(const Judgement& judgement, const Finding& finding) {
  if (finding.what.kind == ChangeKind::kValidity) return 0;
  if (finding.what.kind == ChangeKind::kWork) return 4;
  if (finding.what.kind != ChangeKind::kStatus) return 3;
  return is_solved(judgement.result(finding).head) ? 2 : 1;
}

std::string sameness_text(const Judged& all) {
  if (all.cut_short == 0)
    return fmt::format("all {} plannings gave the same status, plan and work", all.compared);
  return fmt::format(
      "all {} plannings gave the same status, and the same plan and work but for {} that the clock cut "
      "short, which were not compared in these",
      all.compared, all.cut_short);
}

double percent(double log_ratio) { return 100 * std::expm1(log_ratio); }

/// " (95 %: +4.8 to +6.3)"; empty if there is no such interval.
std::string interval_text(double low, double high, bool signs) {
  constexpr double kNoDigit = 0.05;  // it would be "+0.0"
  if (!std::isfinite(low) || !std::isfinite(high)) return "";
  if (std::abs(low) < kNoDigit && std::abs(high) < kNoDigit) return "";
  return signs ? fmt::format(" (95 %: {:+.1f} to {:+.1f})", low, high)
               : fmt::format(" (95 %: {:.1f} to {:.1f})", low, high);
}

/// "from 2.5 points on", "from 0.4 % on": what would have been found 19 times of 20.
std::string seen_text(const Difference& row) {
  if (!std::isfinite(row.detectable)) return "nothing with so few";
  return row.metric == &kSuccess ? fmt::format("from {:.1f} points on", 100 * row.detectable)
                                 : fmt::format("from {:.1f} % on", percent(row.detectable));
}

/// Why a row does not count for certain.
std::string doubt(const Difference& row) {
  if (row.verdict != Verdict::kInconclusive) return "";
  if (row.metric->test == Test::kFreshPairs) {
    return row.at_least > 0 ? ", likely but not certain: measure again" : ", too noisy now to tell";
  }
  const bool certain = row.adjusted_p <= kRecordedLevel;
  // What is seen are losses of plannings by chance: few instances that lose all of theirs are not like that.
  if (row.metric == &kSuccess && !certain && row.effect >= row.detectable) {
    const std::size_t lost = row.worse();
    return fmt::format(", which may be chance: in {} instance{} alone (spread over all, it sees {})", lost,
                       lost == 1 ? "" : "s", seen_text(row));
  }
  return fmt::format(", which may be {} (sees {})", certain ? "too small to matter" : "chance",
                     seen_text(row));
}

/// What plannings were lost and gained, where that is no news: "success -0.2 points (95 %: ...)".
std::string harmless_words(const Difference& success) {
  const bool small = success.verdict == Verdict::kEquivalent;
  return words(success) + (small                ? ", too small to matter"
                           : success.effect > 0 ? fmt::format(", within chance (sees {})", seen_text(success))
                                                : "");
}

/// What rows of one metric say together: the one over all cells, then the worst cell, the others counted.
std::string words(const Judgement& judgement, const std::vector<const Difference*>& rows) {
  const Difference* pooled = nullptr;
  const Difference* worst = nullptr;
  std::size_t cells = 0;
  for (const Difference* row : rows) {
    if (!row->cell) {
      pooled = row;
      continue;
    }
    ++cells;
    if (worst == nullptr || std::abs(row->effect) > std::abs(worst->effect)) worst = row;
  }
  std::string text = pooled != nullptr ? words(*pooled) : "";
  if (worst == nullptr) return text + doubt(*pooled);
  const double effect = percent(worst->effect);
  if (pooled == nullptr) {
    text += words(*worst);
  } else if (worst->metric == &kProcessTime) {
    text += fmt::format(", most of all {:.1f} %", std::abs(effect));
  } else {
    text += worst->metric == &kSuccess ? fmt::format(", most of all {:+.1f} points", -100 * worst->effect)
                                       : fmt::format(", most of all {:+.1f} %", effect);
  }
  text += " in " + judgement.cells[*worst->cell].name + doubt(*worst);
  const auto all = std::count_if(judgement.differences.begin(), judgement.differences.end(),
                                 [worst](const Difference& row) {
                                   return row.cell && row.metric == worst->metric && !row.pairs.empty();
                                 });
  if (cells > 1) text += fmt::format(" ({} of {} cells are like that)", cells, all);
  return text;
}

/// Raises cells and the whole by their rows, and says why.
void judge_metrics(Judgement& judgement, bool excused) {
  constexpr Verdict kOf[] = {Verdict::kRegressed, Verdict::kInconclusive, Verdict::kImproved};
  std::vector<std::string> said;
  std::vector<std::string> noise;
  for (const Verdict verdict : kOf) {
    for (const Metric* metric : kMetrics) {
      if (excused && metric->test == Test::kFreshPairs) continue;
      std::vector<const Difference*> rows;
      for (const Difference& row : judgement.differences) {
        if (row.metric != metric || row.verdict != verdict) continue;
        rows.push_back(&row);
        if (row.cell) judgement.cells[*row.cell].raise(verdict, words(row) + doubt(row));
      }
      if (rows.empty()) continue;
      const bool unknown = verdict == Verdict::kInconclusive && metric->test == Test::kFreshPairs;
      (unknown ? noise : said).push_back(words(judgement, rows));
      judgement.all.verdict = std::max(judgement.all.verdict, verdict);
    }
    // What was lost matters more than what a noisy machine does not tell.
    if (verdict == Verdict::kInconclusive) said.insert(said.end(), noise.begin(), noise.end());
  }
  for (const std::string& text : said) judgement.all.add(text);
}

std::string changes_text(const Judged& judged) {
  const std::size_t work = judged.differing - judged.other_plans;
  if (judged.other_plans == 0)
    return fmt::format("plans unchanged, other work in {} of {}", work, judged.compared);
  return fmt::format("{} of {} plannings changed", judged.other_plans, judged.compared);
}

std::string tasks_text(const Judged& judged) {
  return fmt::format("{} of {} tasks beside planning gave another outcome", judged.other_tasks, judged.tasks);
}

/// Who says that plans are meant to differ has not said that fewer are found: net losses that may be chance
/// are told, and do not pass as what was expected.
void doubt_losses(Judgement& judgement) {
  for (Difference& row : judgement.differences) {
    const bool lost = row.metric == &kSuccess && !row.cell && row.effect > 0;
    if (lost && row.verdict == Verdict::kChanged) row.verdict = Verdict::kInconclusive;
  }
}

void judge_behaviour(Judgement& judgement) {
  std::vector<Judged*> all = {&judgement.all};
  for (Judged& cell : judgement.cells) all.push_back(&cell);
  for (Judged* judged : all) {
    if (judged->newly_invalid > 0) {
      judged->raise(Verdict::kRegressed,
                    fmt::format("{} plans of the head are invalid", judged->newly_invalid));
    }
  }
  for (const Finding& finding : judgement.findings) {
    if (finding.what.kind != ChangeKind::kRepetition) continue;
    for (Judged* judged : {&judgement.cells[finding.cell], &judgement.all}) {
      judged->raise(Verdict::kRegressed,
                    judgement.result(finding).instance + " gives another result when it is planned again");
    }
  }
}

/// Of the same plans with other work, where no count is news: whether what differs is below its floor.
Verdict verdict_of_work(const Judgement& judgement, std::optional<std::size_t> cell) {
  const bool may_matter =
      std::any_of(judgement.differences.begin(), judgement.differences.end(), [cell](const Difference& row) {
        return row.cell == cell && row.metric->kind == db::MetricKind::kCounts &&
               row.verdict == Verdict::kChanged;
      });
  return may_matter ? Verdict::kChanged : Verdict::kEquivalent;
}

/// Adds what changed without being worse, and what stayed as it was.
void complete(Judgement& judgement, std::optional<std::size_t> cell, bool expected) {
  Judged& judged = cell ? judgement.cells[*cell] : judgement.all;
  if (judged.other_plans > 0) {
    judged.verdict = std::max(judged.verdict, Verdict::kChanged);
  } else if (judged.differing > 0 && judged.verdict < Verdict::kImproved) {
    judged.verdict = verdict_of_work(judgement, cell);
  }
  if (judged.differing > 0) {
    judged.add(changes_text(judged) + (expected && judged.other_plans > 0 ? ", as expected" : ""));
  } else {
    judged.add(judged.verdict <= Verdict::kImproved ? sameness_text(judged) : "plans unchanged");
  }
  if (judged.other_tasks > 0) {
    judged.verdict = std::max(judged.verdict, Verdict::kChanged);
    judged.add(tasks_text(judged));
  }
}

/// The same of metrics over all cells that are no news.
void complete_metrics(Judgement& judgement, bool excused) {
  const auto calm = [&judgement](const Metric& metric) -> const Difference* {
    const Difference* row = judgement.find(metric, std::nullopt);
    return row == nullptr || row->pairs.empty() || is_news(*row) ? nullptr : row;
  };
  const Difference* success = calm(kSuccess);
  if (success != nullptr && success->lost + success->gained > 0) judgement.all.add(harmless_words(*success));
  for (const Metric* metric : kMetrics) {
    const Difference* work = metric->kind == db::MetricKind::kCounts ? calm(*metric) : nullptr;
    if (work == nullptr || work->worse() + work->better() == 0 || judgement.all.other_plans > 0) continue;
    judgement.all.add(words(*work));
  }
  if (const Difference* time = calm(kProcessTime); time != nullptr && !excused) {
    const auto& rows = judgement.differences;
    const bool some_slower = std::any_of(rows.begin(), rows.end(), [](const Difference& row) {
      return row.metric == &kProcessTime && row.verdict >= Verdict::kInconclusive;
    });
    judgement.all.add((some_slower ? "over all cells " : "no slowdown: ") + words(*time));
  }
  const Difference* flowtime = calm(kFlowtime);
  if (flowtime != nullptr && judgement.all.verdict > Verdict::kImproved) judgement.all.add(words(*flowtime));
}

}  // namespace

std::string words(const Difference& row) {
  const double effect = percent(row.effect);
  if (row.metric == &kSuccess) {
    return fmt::format("success {:+.1f} points{}: {} of {} plannings lost, {} gained, p = {:.2g}",
                       -100 * row.effect, interval_text(-100 * row.at_most, -100 * row.at_least, true),
                       row.lost, row.plannings, row.gained, row.adjusted_p);
  }
  if (row.metric != &kProcessTime) {
    return fmt::format("{} {:+.1f} %{}", row.metric->name, effect,
                       interval_text(percent(row.at_least), percent(row.at_most), true));
  }
  if (row.verdict == Verdict::kRegressed) {
    return fmt::format("{:.1f} % slower{}", effect,
                       interval_text(percent(row.at_least), percent(row.at_most), false));
  }
  if (row.verdict == Verdict::kImproved) {
    return fmt::format("faster: {:.1f} % less time{}", -effect,
                       interval_text(-percent(row.at_most), -percent(row.at_least), false));
  }
  const std::string interval = interval_text(percent(row.at_least), percent(row.at_most), true);
  return fmt::format("time {:+.1f} %{}", effect, interval);
}

std::string sight_text(const Judgement& judgement) {
  std::string text;
  for (const Metric* metric : kMetrics) {
    const Difference* row = judgement.find(*metric, std::nullopt);
    if (metric->value == nullptr || !metric->judges_pooled || row == nullptr || row->pairs.empty()) continue;
    // Where nothing differs, nothing is known of how changes scatter.
    if (metric != &kSuccess && row->worse() + row->better() == 0) continue;
    text += fmt::format("{}{} {}", text.empty() ? "" : ", ", metric->name, seen_text(*row));
  }
  return text;
}

void Judged::add(const std::string& why) { reason += (reason.empty() ? "" : "; ") + why; }

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
  std::vector<const db::PairedCell*> plannings;
  for (const db::PairedCell& cell : judgement.results) {
    cases.push_back(cell.parameters);
    all.push_back(&cell);
    if (cell.is_planning) plannings.push_back(&cell);
  }
  if (names.empty()) names = case_words(cases);
  judgement.all.name = "all cells";
  judgement.all.instances = instances(plannings);
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
  for (const Metric* metric : kMetrics) {
    if (metric->value == nullptr) continue;
    judgement.differences.push_back(measured(*metric, plannings, std::nullopt));
    for (std::size_t i = 0; i < all.size(); ++i) {
      if (all[i]->is_planning) judgement.differences.push_back(measured(*metric, {all[i]}, i));
    }
  }
  return judgement;
}

void add_repetition(Judgement& judgement, Finding finding) {
  const db::PairedResult& result = judgement.result(finding);
  const std::size_t added = change(result.base, result.head) ? 0 : 1;  // else it is counted
  judgement.cells[finding.cell].differing += added;
  judgement.cells[finding.cell].other_plans += added;
  if (judgement.results[finding.cell].is_planning) {
    judgement.all.differing += added;
    judgement.all.other_plans += added;
  } else {
    judgement.all.other_tasks += added;
  }
  judgement.findings.push_back(std::move(finding));
}

void judge(Judgement& judgement, const JudgeOptions& options) {
  judge_behaviour(judgement);
  // First all cells together, then cells: each family has its own chance of a false alarm.
  std::vector<Difference*> pooled;
  std::vector<Difference*> cells;
  bool slower = false;
  for (Difference& row : judgement.differences) {
    if (row.metric->test == Test::kFreshPairs) {
      slower = slower || row.verdict > Verdict::kEquivalent;
    } else if (row.cell ? row.metric->judges : row.metric->judges_pooled) {
      (row.cell ? cells : pooled).push_back(&row);
    }
  }
  const bool same_plans = judgement.all.other_plans == 0;
  judge_recorded(pooled, options.floors, same_plans);
  judge_recorded(cells, options.floors, same_plans);
  if (options.expects_changes && !same_plans) doubt_losses(judgement);
  const bool excused = slower && !options.times_excuse.empty() && judgement.findings.empty();
  judge_metrics(judgement, excused);
  for (std::size_t i = 0; i < judgement.cells.size(); ++i) complete(judgement, i, options.expects_changes);
  if (judgement.find(kProcessTime, std::nullopt) != nullptr)
    judgement.all.verdict = std::max(judgement.all.verdict, Verdict::kEquivalent);
  complete(judgement, std::nullopt, options.expects_changes);
  complete_metrics(judgement, excused);
  if (excused) judgement.all.add(options.times_excuse);
}

std::string_view heading(const Judgement& judgement, const Finding& finding) {
  const int place = rank(judgement, finding);
  return place == 1 ? "lost" : place == 2 ? "gained" : name(finding.what.kind);
}

std::string behaviour_text(const Judgement& judgement) {
  const Judged& all = judgement.all;
  const std::string plannings = all.differing == 0 ? sameness_text(all) : changes_text(all);
  return all.other_tasks == 0 ? plannings : plannings + "; " + tasks_text(all);
}

}  // namespace sipplab::bench
