// Two recorded sides against each other: density cell by density cell, paired by instance.
// Behaviour first, then success, then time, then the quality of plans.
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "bench/compare/exact.hpp"
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

/// Makespans or flowtimes of the instances that both sides solved, head over base.
struct QualityChange {
  double mean_ratio = 1;
  double p_value = 1;  ///< Wilcoxon, two-sided; Holm over the cells
};

struct CellComparison {
  const db::PairedCell* cell = nullptr;
  std::vector<InstanceDifference> differences;
  std::vector<std::size_t> lost;    ///< results solved by the base alone
  std::vector<std::size_t> gained;  ///< by the head alone
  std::size_t base_solved = 0;
  std::size_t head_solved = 0;
  std::size_t head_invalid = 0;
  double success_p = 1;  ///< McNemar, exact; Holm over the cells and all of them together
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
  std::size_t compared = 0;
  std::size_t differing = 0;  ///< results with a difference
  std::size_t lost = 0;
  std::size_t gained = 0;
  double success_p = 1;  ///< over all cells together
  CompareVerdict verdict = CompareVerdict::kSame;
  std::string reason;  ///< one line
};

/// REQUIRES: `cells` outlives the result.
CompareResult compare(const std::vector<db::PairedCell>& cells, const CompareOptions& options);

}  // namespace sipplab::bench
