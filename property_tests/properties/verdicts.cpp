// Judges of two sides against each other: counts, effects, chances and verdicts from pairs of results that
// are drawn, each computed here by its definition.
#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <numeric>
#include <optional>
#include <set>
#include <string>
#include <tuple>
#include <utility>
#include <vector>

#include "bench/judge/evidence.hpp"
#include "bench/judge/judgement.hpp"
#include "property_tests/support/histories.hpp"
#include "property_tests/support/paired_results.hpp"
#include "property_tests/support/plain_statistics.hpp"
#include "property_tests/support/property.hpp"

namespace sipplab::bench::verdicts_laws {
namespace {

using db::any_flag;
using db::any_whole;
using db::ResultRow;
using db::ResultStatus;

constexpr double kInfinity = std::numeric_limits<double>::infinity();
constexpr int kFewer = (kCasesOfHistories + 1) / 2;

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
      const bool is_work = law.kind == db::MetricKind::kCounts || metric == "instructions";
      if (is_work && (result.base.limit == "time" || result.head.limit == "time")) continue;
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
      const bool doubts = success || row.metric->name == "flowtime" ||
                          (row.metric->name == "expansions" && judgement.all.other_plans == 0);
      Verdict expected = verdict_of(row, doubts);
      // Where other plans are expected, fewer are not.
      const bool fewer = success && pooled && row.effect > 0 && judgement.all.other_plans > 0;
      if (options.expects_changes && fewer && expected == Verdict::kChanged)
        expected = Verdict::kInconclusive;
      RC_ASSERT(row.verdict == expected);
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
    // The same plans with other work are not the same.
    if (worst == Verdict::kSame && judged.differing > 0) {
      worst = Verdict::kEquivalent;
      for (const Difference& row : judgement.differences) {
        const auto law = kLaws.find(row.metric->name);
        const bool counts = law != kLaws.end() && law->second.kind == db::MetricKind::kCounts;
        if (counts && row.cell == cell && row.verdict == Verdict::kChanged) worst = Verdict::kChanged;
      }
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

const PropertyRoom room("verdicts", kCasesOfHistories, [] {
  bool passed = true;

  passed &= property("a change is called after the gravest that differs", changes_are_told_by_what_differs);
  passed &= property("every planning is counted once, and is in one finding if it differs",
                     everything_is_counted, kFewer);
  passed &=
      property("effects and chances are those of instances, by definition", metrics_are_as_defined, kFewer);
  passed &= property("base and head exchanged, worse is better", sides_are_alike, kFewer);
  passed &= property("verdicts follow from rows that are judged together", verdicts_follow_from_rows, kFewer);

  return passed;
});

}  // namespace
}  // namespace sipplab::bench::verdicts_laws
