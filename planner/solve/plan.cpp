#include "planner/solve/plan.hpp"

#include <memory>
#include <utility>

#include "planner/complete/complete_planner.hpp"
#include "planner/core/clock.hpp"
#include "planner/prioritized/ejection.hpp"
#include "sipplab/prioritized_planner.hpp"

namespace sipplab {
namespace {

PlanStatus status_of(LacamStatus status) {
  switch (status) {
    case LacamStatus::kSolved:
      return PlanStatus::kSolved;
    case LacamStatus::kUnsolvable:
      return PlanStatus::kFailed;
    case LacamStatus::kLimit:
      return PlanStatus::kLimit;
  }
  return PlanStatus::kFailed;
}

/// Goes on if `result` has no plan.
void plan_all_at_once(const Instance& instance, const PlannerOptions& options, PlanResult& result) {
  result.made_by = Method::kComplete;
  result.ssi_s = options.ssi_s;
  if (find_beyond_complete(instance, options.rules)) return;
  CompleteResult complete = plan_complete(instance, options);
  result.status = status_of(complete.status);
  result.statistics.expansions += complete.steps_tried;
  result.statistics.generations += complete.configurations;
  if (result.status != PlanStatus::kSolved) return;
  result.solution = std::move(complete.solution);
  result.trace.push_back({std::move(complete.order), std::nullopt, {}});
  result.ssi_kept_s = complete.ssi_kept_s;
}

/// By the method of the options alone: no escalation and no fallback.
PlanResult plan_by_method(const Instance& instance, const PlannerOptions& options) {
  const Clock::time_point begin = Clock::now();
  PlanResult result;
  if (options.method == Method::kComplete) {
    plan_all_at_once(instance, options, result);
  } else {
    const std::unique_ptr<SingleAgentPlanner> search = single_agent_planner(instance, options);
    const bool ejects = options.rescheduling == Rescheduling::kEjection;
    result =
        ejects ? plan_by_ejection(instance, options, *search) : plan_prioritized(instance, options, *search);
  }
  result.planning_seconds = seconds_since(begin);
  return result;
}

}  // namespace

PlannerOptions left_of(const PlannerOptions& options, const PlanResult& done) {
  PlannerOptions left = options;
  left.time_limit_s = options.time_limit_s - done.planning_seconds;
  left.max_expansions = options.max_expansions - done.statistics.expansions;
  left.max_restarts = options.max_restarts - done.tries();
  return left;
}

void prepend(const PlanResult& before, PlanResult& result) {
  result.trace.insert(result.trace.begin(), before.trace.begin(), before.trace.end());
  result.statistics += before.statistics;
  result.planning_seconds += before.planning_seconds;
}

PlanResult plan(const Instance& instance, const PlannerOptions& options) {
  const Clock::time_point begin = Clock::now();
  PlanResult result = plan_by_method(instance, options);
  for (const double ssi_s : options.longer_ssi_s) {
    if (result.status != PlanStatus::kFailed) break;
    PlannerOptions left = left_of(options, result);
    if (result.tries() > options.max_restarts || !(left.time_limit_s > 0)) {
      result.status = PlanStatus::kLimit;
      break;
    }
    left.ssi_s = ssi_s;
    PlanResult next = plan_by_method(instance, left);
    prepend(result, next);
    result = std::move(next);
  }
  const bool may_fall_back = options.fallback == Fallback::kComplete && options.method != Method::kComplete;
  if (may_fall_back && result.status != PlanStatus::kSolved) plan_all_at_once(instance, options, result);
  result.planning_seconds = seconds_since(begin);
  return result;
}

}  // namespace sipplab
