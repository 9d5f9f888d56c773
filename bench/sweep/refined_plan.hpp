// Planning as a user asks for it: one method, longer start-safe intervals after it, all methods
// in turn, and improvement of what they give.
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "planner/improve/improve_budget.hpp"
#include "planner/portfolio/best_plan.hpp"
#include "planner/validator/validator.hpp"

namespace sipplab::bench {

/// What is to be done besides the method of PlannerOptions.
struct Refinement {
  bool best = false;  ///< plan_best()
  /// Improvement; none: no improvement, or with `best` until the time limit.
  std::optional<ImproveBudget> improve;
  Objective objective;
  /// Start-safe intervals that are tried when that of the options fails; with `best` none
  /// stands for the default ones.
  std::vector<double> longer_ssi_s;
  unsigned threads = 1;  ///< of improvement; what comes out does not depend on it

  bool is_wanted() const { return best || improve.has_value(); }
};

/// "+improve:300i,flowtime", "+best,flowtime"; empty where nothing is wanted. Start-safe
/// intervals are left out: a sweep sets none.
std::string refinement_suffix(const Refinement& refinement);
/// The flags of `sipplab plan` that a suffix stands for; empty for no suffix.
std::string refinement_flags(std::string_view suffix);

struct RefinedPlan {
  PlanResult plan;
  std::vector<BestStep> steps;  ///< of plan_best()
  std::optional<ImproveResult> improvement;

  const Solution& solution() const { return improvement ? improvement->solution : plan.solution; }
  /// The final order; where the plan keeps the promise of start-safe intervals in none, the one
  /// in which robots were planned.
  const PriorityOrder& order() const {
    return improvement && improvement->order ? *improvement->order : plan.order();
  }
  /// How long it keeps starts safe, in that order; 0 where it promises nothing of them.
  double ssi_kept_s() const { return improvement && !improvement->log.keeps_promise ? 0 : plan.ssi_kept_s; }
  /// What the validator is to check of a plan that was made under these rules.
  ValidationOptions promises(const MotionRules& rules) const { return {ssi_kept_s(), order(), rules}; }
  /// Wall clock, planning and improving.
  double seconds() const {
    return plan.planning_seconds + (improvement ? improvement->log.curve.back().seconds : 0);
  }
  SearchStatistics statistics() const;
};

/// Why the options and the refinement do not go together, in one line: ejection and improvement
/// know nothing of inflated distances and times.
std::optional<std::string> find_beyond_refinement(const PlannerOptions& options,
                                                  const Refinement& refinement);

/// REQUIRES: !find_beyond_refinement(options, refinement).
RefinedPlan plan_refined(const Instance& instance, const PlannerOptions& options,
                         const Refinement& refinement);

}  // namespace sipplab::bench
