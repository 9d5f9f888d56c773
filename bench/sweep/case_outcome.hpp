// What the instances of one case gave, summed up. Exact per-instance results are in
// the history; this is for counters, tables and JSON.
#pragma once

#include <cstdint>
#include <optional>

#include "db/records.hpp"

namespace sipplab::bench {

class CaseOutcome {
 public:
  void add(const db::ResultRow& row);

  std::int64_t results() const { return results_; }
  std::int64_t solved() const { return solved_; }
  std::int64_t limited() const { return limited_; }
  std::int64_t invalid() const { return invalid_; }

  /// 0..1; 0 without results.
  double success_rate() const { return mean(static_cast<double>(solved_)); }
  /// Means over all results, limits included.
  double mean_planning_s() const { return mean(planning_s_); }
  double mean_tries() const { return mean(tries_); }
  double mean_expansions() const { return mean(expansions_); }
  /// Means over solved results; none if nothing was solved.
  std::optional<double> mean_solved_planning_s() const { return mean_of_solved(solved_planning_s_); }
  std::optional<double> mean_makespan_s() const { return mean_of_solved(makespan_s_); }
  std::optional<double> mean_flowtime_s() const { return mean_of_solved(flowtime_s_); }

 private:
  double mean(double sum) const { return results_ > 0 ? sum / static_cast<double>(results_) : 0; }
  std::optional<double> mean_of_solved(double sum) const {
    if (solved_ == 0) return std::nullopt;
    return sum / static_cast<double>(solved_);
  }

  std::int64_t results_ = 0;
  std::int64_t solved_ = 0;
  std::int64_t limited_ = 0;
  std::int64_t invalid_ = 0;
  double planning_s_ = 0;
  double solved_planning_s_ = 0;
  double tries_ = 0;
  double expansions_ = 0;
  double makespan_s_ = 0;
  double flowtime_s_ = 0;
};

inline void CaseOutcome::add(const db::ResultRow& row) {
  constexpr double kSecondsPerNanosecond = 1e-9;
  ++results_;
  planning_s_ += static_cast<double>(row.planning_time_ns) * kSecondsPerNanosecond;
  tries_ += static_cast<double>(row.tries);
  expansions_ += static_cast<double>(row.expansions);
  limited_ += row.status == db::ResultStatus::kLimit ? 1 : 0;
  invalid_ += row.status == db::ResultStatus::kInvalid ? 1 : 0;
  if (row.status != db::ResultStatus::kSolved) return;
  ++solved_;
  solved_planning_s_ += static_cast<double>(row.planning_time_ns) * kSecondsPerNanosecond;
  makespan_s_ += row.makespan_s.value_or(0);
  flowtime_s_ += row.flowtime_s.value_or(0);
}

}  // namespace sipplab::bench
