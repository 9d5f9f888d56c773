// Two recorded sides against each other: density cell by density cell, paired by instance.
// Behaviour first, then success, then time, then the quality of plans.
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "bench/judge/exact.hpp"
#include "db/comparisons.hpp"

namespace sipplab::bench {

enum class CompareVerdict {
  kSame,          ///< every planning gave the same
  kChanged,       ///< other results, and nothing that counts is worse
  kInconclusive,  ///< fewer solved, which may be chance
  kRegressed,
};
/// "same", "changed", "inconclusive", "regressed".
std::string_view name(CompareVerdict verdict);

/// What differs on one instance.
struct InstanceDifference {
  std::size_t result = 0;  ///< which of the cell's results
  Difference what;
};

/// Makespans or flowtimes of the instances that both sides solved, head over base; of an instance the
/// mean over those plannings that both solved.
struct QualityChange {
  double mean_ratio = 1;
  double p_value = 1;  ///< Wilcoxon, two-sided; Holm over the cells
};

struct CellComparison {
  const db::PairedCell* cell = nullptr;
  std::vector<InstanceDifference> differences;
  /// Of different content. Repetitions and equal files of one instance are one observation: what
  /// happens to one of them happens to all.
  std::size_t instances = 0;
  /// Instances that the base solves more often, each by its first result that only the base solved.
  std::vector<std::size_t> lost;
  std::vector<std::size_t> gained;  ///< the same for the head
  std::size_t base_solved = 0;      ///< plannings, as all counts from here on
  std::size_t head_solved = 0;
  std::size_t head_invalid = 0;
  std::size_t cut_short = 0;  ///< by the clock on a side, with equal status: plan and work are not compared
  double success_p = 1;       ///< McNemar over instances, exact; Holm over the cells and all of them together
  /// Median over instances of head's planning time over base's. None on different machines.
  std::optional<double> time_ratio;
  /// Mean time where an unsolved instance counts as twice the limit; none without a limit.
  std::optional<double> base_par2_s;
  std::optional<double> head_par2_s;
  std::size_t both_solved = 0;
  QualityChange flowtime;
  QualityChange makespan;
  std::string regression;  ///< why the head is worse here; empty where it is not
};

struct CompareOptions {
  bool exact = false;  ///< any difference is a regression
};

struct CompareResult {
  std::vector<CellComparison> cells;
  std::size_t compared = 0;   ///< plannings
  std::size_t differing = 0;  ///< plannings with a difference
  std::size_t cut_short = 0;  ///< plannings of which only the status was compared
  std::size_t lost = 0;       ///< instances, lost in more cells than gained
  std::size_t gained = 0;
  double success_p = 1;  ///< over all cells together
  CompareVerdict verdict = CompareVerdict::kSame;
  std::string reason;  ///< one line
};

/// What may be said where nothing differs.
std::string sameness_text(const CompareResult& result);

/// REQUIRES: `cells` outlives the result.
CompareResult compare(const std::vector<db::PairedCell>& cells, const CompareOptions& options);

}  // namespace sipplab::bench
