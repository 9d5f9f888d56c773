// The best plan that can be had in a given time: one at once from the complete planner, then
// methods from the paper's to coarser ones until one gives a better one, then improvement until the
// time is over.
#pragma once

#include <cstdint>
#include <limits>
#include <optional>
#include <string_view>
#include <vector>

#include "planner/improve/improve.hpp"
#include "planner/prioritized/prioritized_planner.hpp"

namespace sipplab {

struct BestOptions {
  /// The method of the first step, and limits over all steps: time_limit_s is for everything.
  PlannerOptions planner;
  /// Longer start-safe intervals that are tried when planner.ssi_s fails.
  std::vector<double> longer_ssi_s = {9, 15};
  Objective objective;
  /// Of the improvement, besides the limits of `planner`.
  std::uint64_t max_iterations = UINT64_MAX;
  double improve_time_limit_s = std::numeric_limits<double>::infinity();
  unsigned threads = 1;  ///< of the improvement, as in ImproveOptions
};

/// A step of plan_best() that was taken.
struct BestStep {
  enum class Kind { kMethod, kEscalation, kEjection, kFallback };
  Kind kind = Kind::kMethod;
  double ssi_s = 0;
  PlanStatus status = PlanStatus::kFailed;
  std::size_t tries = 0;
  double seconds = 0;            ///< wall clock that it took
  double ended_s = 0;            ///< wall clock since the first step began
  std::optional<PlanCost> cost;  ///< of its plan, where it gave one
};
/// "method", "escalation", "ejection", "fallback".
std::string_view name(BestStep::Kind kind);

struct BestResult {
  /// The plan that was improved, with the tries and work of all steps.
  PlanResult plan;
  std::vector<BestStep> steps;
  /// None where there is no plan.
  std::optional<ImproveResult> improvement;
};

/// Steps:
///  (1) the complete planner, where the instance is of its kind: a plan in hand within
///      milliseconds, though a poor one;
///  (2) the method of the options;
///  (3) the same with each longer start-safe interval;
///  (4) ejection, with the first interval and then with the longer ones;
/// of (2) to (4) each until it gives a plan, which is then taken instead, or has had its
/// restarts; where none does and (1) was cut short, the complete planner again. Then the plan is
/// improved until a limit strikes. Steps are limited by counts, and by shares of the time limit, so the
/// result is repeatable where these are not used up and max_iterations strikes before the time
/// limit. A signal (options.planner.stop) ends steps and improvement; there is a plan then if
/// there was one before.
/// REQUIRES: !find_error(instance), !options.planner.rules.inflates().
BestResult plan_best(const Instance& instance, const BestOptions& options);

}  // namespace sipplab
