#include "sipplab/solve.hpp"

#include "planner/complete/complete_planner.hpp"
#include "planner/solve/best_plan.hpp"
#include "planner/solve/improve_stages.hpp"
#include "planner/solve/plan.hpp"

namespace sipplab {

SearchStatistics SolveResult::statistics() const {
  SearchStatistics all = plan.statistics;
  if (improvement) all += improvement->statistics;
  return all;
}

std::optional<std::string> find_beyond(const Instance& instance, const PlannerOptions& options) {
  if (options.method == Method::kComplete || options.fallback == Fallback::kComplete) {
    const std::optional<InstanceError> error = find_beyond_complete(instance, options.rules);
    if (error) return error->what + ", expected " + error->expected;
  }
  const bool needs_plain = options.best || options.improve || options.rescheduling == Rescheduling::kEjection;
  if (!needs_plain || !options.rules.inflates()) return std::nullopt;
  return "inflated distances or times, expected none with ejection, --improve or --best";
}

SolveResult solve(const Instance& instance, const PlannerOptions& options) {
  if (options.best) return best_plan(instance, options);
  SolveResult result;
  result.plan = plan(instance, options);
  if (options.improve && result.is_solved()) {
    result.improvement = improve_in_stages(instance, result.plan, options);
  }
  return result;
}

}  // namespace sipplab
