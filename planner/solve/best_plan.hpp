// The best plan that can be had in a given time: one at once from the complete planner, then
// methods from the paper's to coarser ones until one gives a better one, then improvement until the
// time is over.
#pragma once

#include <optional>
#include <string_view>

#include "planner/improve/objective.hpp"
#include "planner/instance/instance.hpp"
#include "planner/prioritized/plan_result.hpp"

namespace sipplab {

struct SolveResult;

/// A step of best_plan() that was taken.
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

/// Steps:
///  (1) the complete planner, if it can plan such instances: a plan in hand within
///      milliseconds, though a poor one;
///  (2) the method of the options;
///  (3) the same with each longer start-safe interval;
///  (4) ejection, with the first interval and then with the longer ones;
/// of (2) to (4) each until it gives a plan, which is then taken instead, or has had its
/// restarts; if none does and (1) was cut short, the complete planner again. Then the plan is
/// improved until a limit is reached. If options.longer_ssi_s is empty, kLongerSsiS are tried.
/// Steps are limited by counts, and by shares of options.time_limit_s, which is for everything: the result is
/// repeatable if these are not used up and the iterations of options.improve end before the time limit.
/// A signal (options.stop) ends steps and improvement; there is a plan then if there was one before.
/// REQUIRES: as solve().
SolveResult best_plan(const Instance& instance, const PlannerOptions& options);

inline constexpr double kLongerSsiS[] = {9, 15};

}  // namespace sipplab
