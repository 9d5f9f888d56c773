// What is said of two sides, base and head: one metric, in one cell or in all of them together.
// Sweeps of the history and processes that run in turn give the same kind of statement; only where
// its pairs come from differs.
#pragma once

#include <array>
#include <cstddef>
#include <limits>
#include <optional>
#include <string_view>
#include <vector>

#include "db/comparisons.hpp"
#include "db/thresholds.hpp"

namespace sipplab::bench {

/// From harmless to grave.
enum class Verdict {
  kSame,          ///< every planning gave the same
  kEquivalent,    ///< what differs is below its floor
  kImproved,      ///< better for certain, and nothing that judges is worse
  kChanged,       ///< other results, and nothing that judges is worse for certain
  kInconclusive,  ///< may be worse by as much as matters, and may not: more pairs would tell
  kRegressed,
};
/// "same", "equivalent", "improved", "changed", "inconclusive", "regressed".
std::string_view name(Verdict verdict);

/// How pairs become a p value.
enum class Test {
  kNone,
  kSigns,       ///< of lost and gained plannings, by instance: McNemar's, exact
  kRanks,       ///< Wilcoxon's, two-sided
  kFreshPairs,  ///< sign test, one-sided, to be confirmed by fresh pairs
};

/// Chance of calling some metric of equal builds different over all cells, by the tests of recorded results,
/// and again of some cell: half of either is on the side of worse.
inline constexpr double kRecordedLevel = 0.01;

/// A pair is the logarithm of head over base, 0.03 for 3 % more; of kSigns 1 for a planning that only the
/// base solves and -1 for one that only the head solves. Above zero is worse.
struct Metric {
  std::string_view name = {};
  db::MetricKind kind = db::MetricKind::kQuality;
  Test test = Test::kNone;
  bool median = false;         ///< the effect is the median of the pairs, else their mean
  bool judges = false;         ///< in a cell; other metrics inform
  bool judges_pooled = false;  ///< over all cells together
  bool doubts_pooled = false;  ///< there, a worse effect that may matter and may be chance is inconclusive
  bool doubts_work = false;    ///< the same, but only where no plan differs: other plans scatter it
  /// What one planning gave; 0 and less has no logarithm. None: the pairs are measured elsewhere.
  double (*value)(const db::ResultRow& row) = nullptr;
  bool of_machine = false;  ///< compared on one machine alone, and of unsolved plannings too
  bool of_work = false;  ///< not compared where the clock cut a side short: it says how fast the machine was
};

extern const Metric kSuccess;
extern const Metric kFlowtime;
extern const Metric kMakespan;
extern const Metric kExpansions;
extern const Metric kGenerations;
extern const Metric kTries;
extern const Metric kInstructions;
extern const Metric kMemory;       ///< of two processes, which differ by themselves: it judges nothing
extern const Metric kSweepTime;    ///< of sweeps, which did not run in turn: it judges nothing
extern const Metric kProcessTime;  ///< of pairs of processes, by the gate
extern const Metric kProcessMemory;

/// In the order in which people ask; those with a `value` are of recorded results. A new metric is a row here
/// and a constant above: reports, verdicts and JSON follow.
inline constexpr const Metric* kMetrics[] = {&kProcessTime, &kSuccess,     &kFlowtime,     &kMakespan,
                                             &kExpansions,  &kGenerations, &kInstructions, &kTries,
                                             &kMemory,      &kSweepTime,   &kProcessMemory};

/// Added to the bytes of both sides before they are compared: pages are counted in batches, so that a
/// planning in less says nothing.
inline constexpr double kMemoryGrainBytes = 1 << 20;

/// Smallest effects that count, by kind of metric.
struct Floors {
  std::array<double, db::kThresholds.size()> shares;
  Floors() {
    for (const db::Threshold& threshold : db::kThresholds) (*this)[threshold.kind] = threshold.floor;
  }
  double& operator[](db::MetricKind kind) { return shares[static_cast<std::size_t>(kind)]; }
  /// As the effects of this metric are: a difference of shares, or a logarithm.
  double of(const Metric& metric) const;
};

/// A look at fresh pairs alone.
struct Confirmation {
  double effect = 0;
  double p_value = 1;
};

struct Difference {
  const Metric* metric = nullptr;
  std::optional<std::size_t> cell = {};  ///< none: all cells together
  /// One for each instance, or pair of processes: repetitions and equal files of one instance are one
  /// observation, and so is an instance in several cells.
  std::vector<double> pairs = {};
  std::vector<double> fresh_pairs = {};  ///< of those that were to confirm
  std::size_t plannings = 0;             ///< behind the pairs, of recorded results
  std::size_t lost = 0;                  ///< of success: plannings that only the base solved
  std::size_t gained = 0;                ///< that only the head solved
  double effect = 0;
  /// 95 % interval of the effect, infinite if the pairs are too few.
  double at_least = -std::numeric_limits<double>::infinity();
  double at_most = std::numeric_limits<double>::infinity();
  double p_value = 1;
  double adjusted_p = 1;         ///< Holm's, over the rows that are judged together
  double adjusted_faster_p = 1;  ///< of kFreshPairs, on the other side
  std::optional<Confirmation> confirmation = {};
  double noise = 0;  ///< standard error of the effect between equal builds
  double floor = 0;  ///< the metric's, or what the noise asks for
  double detectable = std::numeric_limits<double>::infinity();  ///< effect that is found 19 times of 20
  std::optional<Verdict> verdict = {};                          ///< none: it informs

  std::size_t worse() const;   ///< pairs above zero
  std::size_t better() const;  ///< pairs below
};

/// Whether a reader is to look at it: regressed, inconclusive or improved.
bool is_news(const Difference& row);

/// From its pairs: effect, interval and p value, adjusted by nothing.
void evaluate(Difference& row);

/// A metric of recorded results, evaluated.
Difference measured(const Metric& metric, const std::vector<const db::PairedCell*>& cells,
                    std::optional<std::size_t> cell);

/// Adjusts the p values of rows of recorded metrics that are judged together, gives verdicts to them, and
/// says what they could have seen. `same_plans`: nothing differs but work.
void judge_recorded(const std::vector<Difference*>& family, const Floors& floors, bool same_plans);

/// Adjusts the p values of rows of kFreshPairs. Their verdicts wait for second_look().
void judge_times(const std::vector<Difference*>& rows);

/// Whether fresh pairs are worth their time: the first look found a change of speed, or cannot rule out a
/// slowdown.
bool needs_second_look(const Difference& row, double tolerance);

/// The verdict of a row of kFreshPairs, after its fresh pairs if it needed some.
void second_look(Difference& row, double tolerance);

}  // namespace sipplab::bench
