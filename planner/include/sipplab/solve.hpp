// The whole pipeline behind one call: a first plan or the best that all methods give, then improvement.
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "sipplab/improve.hpp"
#include "sipplab/validator.hpp"

namespace sipplab {

/// A step of options.best that was taken.
struct BestStep {
  enum class Kind { kMethod, kEscalation, kEjection, kFallback };
  Kind kind = Kind::kMethod;
  double ssi_s = 0;
  PlanStatus status = PlanStatus::kFailed;
  std::size_t tries = 0;
  double seconds = 0;            ///< wall clock that it took
  double ended_s = 0;            ///< wall clock since the first step began
  std::optional<PlanCost> cost;  ///< of its plan, if it gave one
};
/// "method", "escalation", "ejection", "fallback".
std::string_view name(BestStep::Kind kind);

struct SolveResult {
  PlanResult plan;              ///< before improvement
  std::vector<BestStep> steps;  ///< of options.best
  /// None if there is no plan, or if it was not asked for.
  std::optional<ImproveResult> improvement;

  bool is_solved() const { return plan.status == PlanStatus::kSolved; }
  const Solution& solution() const { return improvement ? improvement->solution : plan.solution; }
  /// The final order; if the plan keeps the guarantee of start-safe intervals in no order, the one
  /// in which robots were planned.
  const PriorityOrder& order() const {
    return improvement && improvement->order ? *improvement->order : plan.order();
  }
  /// How long it keeps starts safe, in that order; 0 if it guarantees none.
  double ssi_kept_s() const { return improvement ? improvement->ssi_kept_s : plan.ssi_kept_s; }
  /// What the validator is to check of a plan that was made under these rules.
  ValidationOptions guarantees(const MotionRules& rules) const { return {ssi_kept_s(), order(), rules}; }
  /// Wall clock, planning and improving.
  double seconds() const {
    return plan.planning_seconds + (improvement ? improvement->log.curve.back().seconds : 0);
  }
  SearchStatistics statistics() const;
};

/// Why options and instance do not go together, in one line. For example, LaCAM plans for neither moving
/// obstacles nor different speeds, and ejection and improvement for neither inflated distances nor times.
std::optional<std::string> find_beyond(const Instance& instance, const PlannerOptions& options);

/// Plans as the options say; if they ask for it, with all methods in turn, and improves the plan.
/// REQUIRES: !find_error(instance) and !find_beyond(instance, options).
SolveResult solve(const Instance& instance, const PlannerOptions& options);

}  // namespace sipplab
