// Claim: whatever plan is improved, the result passes the validator, keeps its guarantee of
// start-safe intervals, is not worse, and is the same for the same number of iterations. The
// same of --best, which finds the plan itself.
#include <iterator>
#include <optional>

#include "fuzz/support/case_input.hpp"
#include "fuzz/support/claims.hpp"
#include "fuzz/support/target.hpp"
#include "planner/improve/objective.hpp"
#include "planner/solve/plan.hpp"
#include "sipplab/solve.hpp"

namespace {

using namespace sipplab;
using fuzz::Claim;
using fuzz::Event;
using fuzz::require;

/// Some milliseconds.
constexpr std::uint64_t kMostIterations = 8;

/// With one of a few objectives, by the seed of the case, which stays the same while a case is made smaller.
PlannerOptions improving(const PlanCase& plan_case) {
  constexpr Objective kObjectives[] = {{1, 0}, {0, 1}, {1, 20}};
  PlannerOptions options = plan_case.options;
  options.objective = kObjectives[options.seed % std::size(kObjectives)];
  options.improve = ImproveBudget{};
  options.improve->iterations = kMostIterations;
  return options;
}

void check_valid(const PlanCase& plan_case, double ssi_s, const ImproveResult& result) {
  ValidationOptions options;
  options.ssi_s = ssi_s;
  options.rules = plan_case.options.rules;
  require(Claim::kPlanIsValid, result.order.has_value(), "a guarantee that was kept is kept in no order");
  options.order = *result.order;
  const ValidationReport report = validate(plan_case.instance, result.solution, options);
  require(Claim::kPlanIsValid, report.valid(), report.valid() ? "" : report.violations.front().message);
}

void check_same(const ImproveResult& one, const ImproveResult& other) {
  require(Claim::kSameInputSamePlan,
          one.solution == other.solution && one.order == other.order &&
              one.statistics.expansions == other.statistics.expansions,
          "improved again, something differs");
}

/// A plan by the options of the case, then improvement.
void check_improvement(const PlanCase& plan_case) {
  const PlanResult planned = plan(plan_case.instance, plan_case.options);
  const bool solved = planned.status == PlanStatus::kSolved;
  fuzz::count(solved ? Event::kSolved : Event::kFailed);
  if (!solved) return;
  PlannerOptions options = improving(plan_case);
  options.ssi_s = planned.ssi_kept_s;
  const auto improved = [&] {
    return improve(plan_case.instance, planned.solution, planned.order(), options);
  };
  const ImproveResult result = improved();
  const auto cost = [](const Solution& solution) {
    return PlanCost{flowtime_s(solution), makespan_s(solution)};
  };
  require(Claim::kImprovementIsNoWorse,
          !is_better(options.objective, cost(planned.solution), cost(result.solution)),
          "worse than the plan that was given");
  check_valid(plan_case, planned.ssi_kept_s, result);
  check_same(result, improved());
}

/// Everything together.
void check_best(const PlanCase& plan_case) {
  PlannerOptions options = improving(plan_case);
  options.best = true;
  const SolveResult best = solve(plan_case.instance, options);
  const bool solved = best.plan.status == PlanStatus::kSolved;
  fuzz::count(solved ? Event::kSolved : Event::kFailed);
  require(Claim::kResultIsWhole, solved == best.improvement.has_value(), "improved what is no plan");
  if (!solved) return;
  check_valid(plan_case, best.ssi_kept_s(), *best.improvement);
  check_same(*best.improvement, *solve(plan_case.instance, options).improvement);
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  std::optional<PlanCase> plan_case = fuzz::read_case(data, size);
  if (!plan_case) return -1;
  PlannerOptions& options = plan_case->options;
  options.rules.inflate_distance_cells = 0;  // improvement refuses these
  options.rules.inflate_time_s = 0;
  if (options.seed % 2 == 0) {
    check_improvement(*plan_case);
  } else {
    check_best(*plan_case);
  }
  return 0;
}
