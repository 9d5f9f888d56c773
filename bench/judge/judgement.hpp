// Two sides against each other: behaviour planning by planning, then every metric, cell by cell and over all
// cells together, and the verdict on all of it. `sipplab compare` judges what was recorded, `sipplab gate`
// adds the times of processes that ran in turn.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "bench/judge/change.hpp"
#include "bench/judge/difference.hpp"

namespace sipplab::bench {

/// A change of behaviour on one instance. Repetitions and equal files that changed alike are one finding.
struct Finding {
  std::size_t cell = 0;
  std::size_t result = 0;  ///< the first of the cell's results
  Change what;
  std::size_t plannings = 1;
};

/// A cell, or all of them together. Counts are plannings unless stated otherwise.
struct Judged {
  std::string name;           ///< for people
  std::size_t instances = 0;  ///< of different content
  std::size_t compared = 0;
  std::size_t differing = 0;
  std::size_t other_plans = 0;  ///< those that differ in more than work
  std::size_t cut_short = 0;    ///< by the clock on a side, with equal status: plan and work are not compared
  std::size_t base_solved = 0;
  std::size_t head_solved = 0;
  std::size_t both_solved = 0;
  std::size_t newly_invalid = 0;  ///< plans of the head
  std::size_t tasks = 0;          ///< beside plannings: those of the gate's laboratory, over all cells
  std::size_t other_tasks = 0;    ///< those with another outcome
  /// Mean time, an unsolved planning counting as twice the limit (PAR-2); none without a limit.
  std::optional<double> base_par2_s;
  std::optional<double> head_par2_s;
  Verdict verdict = Verdict::kSame;
  std::string reason;  ///< one line

  /// One more reason, behind the others.
  void add(const std::string& why);
  /// A graver verdict replaces the reasons of lesser ones; an equal one adds its own.
  void raise(Verdict to, const std::string& why);
};

struct JudgeOptions {
  Floors floors;
  bool expects_changes = false;  ///< says so where plans changed, which then net losses make inconclusive
  std::string times_excuse;      ///< why slowdowns are noise if behaviour is the same; empty if they count
};

struct Judgement {
  std::vector<db::PairedCell> results;  ///< of each cell
  std::vector<Judged> cells;
  Judged all;
  std::vector<Finding> findings;
  /// All rows of a metric after each other, that over all cells first.
  std::vector<Difference> differences;

  /// None if the metric was not measured there.
  const Difference* find(const Metric& metric, std::optional<std::size_t> cell) const;
  const Judged& at(std::optional<std::size_t> cell) const { return cell ? cells[*cell] : all; }
  const db::PairedResult& result(const Finding& finding) const {
    return results[finding.cell].results[finding.result];
  }
};

/// Changes and metrics of all cells with results, without a verdict. `names`: of the cells, if they should
/// not be those of case_words().
Judgement measured(std::vector<db::PairedCell> cells, std::vector<std::string> names = {});

/// Adds that a build differs from itself when it plans again.
void add_repetition(Judgement& judgement, Finding finding);

/// Verdicts of all rows and cells, and of the whole.
void judge(Judgement& judgement, const JudgeOptions& options);

/// What a row says: "5.6 % slower (95 %: 4.8 to 6.3)", "flowtime +14.3 % (95 %: +13.9 to +14.8)".
std::string words(const Difference& row);

/// "flowtime from 0.4 % on, success from 5.2 points on": what would have been found 19 times of 20 over all
/// cells; empty if nothing was recorded.
std::string sight_text(const Judgement& judgement);

/// "lost", "gained", or the kind of its change.
std::string_view heading(const Judgement& judgement, const Finding& finding);

/// "all 16 plannings gave the same status, plan and work", or how many differ.
std::string behaviour_text(const Judgement& judgement);

}  // namespace sipplab::bench
