#include "bench/sweep/refined_plan.hpp"

#include <utility>

namespace sipplab::bench {

std::string refinement_suffix(const Refinement& refinement) {
  if (!refinement.is_wanted()) return "";
  std::string suffix = refinement.best ? "+best" : "+improve";
  if (refinement.improve) suffix += ":" + format_improve_budget(*refinement.improve);
  return suffix + "," + format_objective(refinement.objective);
}

std::string refinement_flags(std::string_view suffix) {
  if (suffix.empty()) return "";
  const std::string_view kind_and_budget = suffix.substr(1, suffix.find(',') - 1);
  const std::size_t colon = kind_and_budget.find(':');
  std::string flags;
  if (kind_and_budget.substr(0, colon) == "best") flags += " --best";
  if (colon != std::string_view::npos) {
    flags += " --improve " + std::string(kind_and_budget.substr(colon + 1));
  }
  return flags + " --objective " + std::string(suffix.substr(suffix.find(',') + 1));
}

SearchStatistics RefinedPlan::statistics() const {
  SearchStatistics all = plan.statistics;
  if (improvement) all += improvement->statistics;
  return all;
}

std::optional<std::string> find_beyond_refinement(const PlannerOptions& options,
                                                  const Refinement& refinement) {
  if (!options.rules.inflates()) return std::nullopt;
  if (!refinement.is_wanted() && options.rescheduling != Rescheduling::kEjection) return std::nullopt;
  return "inflated distances or times, expected none with ejection, --improve or --best";
}

RefinedPlan plan_refined(const Instance& instance, const PlannerOptions& options,
                         const Refinement& refinement) {
  const ImproveBudget budget = refinement.improve.value_or(ImproveBudget{});
  if (refinement.best) {
    BestOptions best;
    best.planner = options;
    if (!refinement.longer_ssi_s.empty()) best.longer_ssi_s = refinement.longer_ssi_s;
    best.objective = refinement.objective;
    best.max_iterations = budget.iterations;
    best.improve_time_limit_s = budget.seconds;
    best.threads = refinement.threads;
    BestResult result = plan_best(instance, best);
    return {std::move(result.plan), std::move(result.steps), std::move(result.improvement)};
  }
  RefinedPlan refined;
  refined.plan = plan_escalating(instance, options, refinement.longer_ssi_s);
  if (!refinement.improve || refined.plan.status != PlanStatus::kSolved) return refined;
  ImproveOptions improving = improve_options(options, refined.plan);
  improving.objective = refinement.objective;
  improving.max_iterations = budget.iterations;
  improving.time_limit_s = budget.seconds;
  improving.threads = refinement.threads;
  refined.improvement = improve(instance, refined.plan.solution, refined.plan.order(), improving);
  return refined;
}

}  // namespace sipplab::bench
