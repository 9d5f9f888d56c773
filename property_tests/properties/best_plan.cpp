// Methods tried one after the other: escalation of start-safe intervals, and the best plan
// that can be had.
#include "sipplab/solve.hpp"

#include <rapidcheck.h>

#include <algorithm>
#include <numeric>

#include "planner/complete/complete_planner.hpp"
#include "planner/improve/objective.hpp"
#include "planner/solve/improve_stages.hpp"
#include "planner/solve/plan.hpp"
#include "property_tests/support/assert_valid.hpp"
#include "property_tests/support/generators.hpp"
#include "property_tests/support/property.hpp"

namespace sipplab::best_plan_laws {
namespace {

constexpr std::uint64_t kRestarts = 40;
constexpr std::uint64_t kIterations = 10;

PlanCase any_noted_case() {
  PlanCase plan_case = *any_case();
  plan_case.options.max_restarts = std::min(plan_case.options.max_restarts, kRestarts);
  classify_case(plan_case);
  note_case(plan_case);
  return plan_case;
}

std::vector<double> any_longer_ssi_s() {
  return *rc::gen::element(std::vector<double>{}, std::vector<double>{2.5},
                           std::vector<double>{1, 5, kInfiniteSsi});
}

/// More than the method and ejection use on maps of this size, and an end for the fallback if
/// there is no plan.
constexpr std::uint64_t kAmpleExpansions = 200'000;

PlannerOptions best_options(const PlanCase& plan_case) {
  PlannerOptions options = plan_case.options;
  options.best = true;
  options.longer_ssi_s = any_longer_ssi_s();
  options.improve = ImproveBudget{};
  options.improve->iterations = kIterations;
  return options;
}

const PropertyRoom room("best_plan", [] {
  bool passed = true;

  passed &=
      property("escalation: the plan of the first start-safe interval with which the method succeeds", [] {
        PlanCase plan_case = any_noted_case();
        const std::vector<double> longer_s = any_longer_ssi_s();
        PlannerOptions escalating = plan_case.options;
        escalating.longer_ssi_s = longer_s;
        const PlanResult result = plan(plan_case.instance, escalating);
        RC_CLASSIFY(result.ssi_s != plan_case.options.ssi_s, "with another interval");
        RC_CLASSIFY(result.ssi_s != plan_case.options.ssi_s && result.status == PlanStatus::kSolved,
                    "solved with another interval");
        RC_ASSERT(result.tries() <= plan_case.options.max_restarts + 1);
        RC_ASSERT(result.statistics.expansions <= plan_case.options.max_expansions);
        if (result.status == PlanStatus::kSolved) {
          assert_valid(plan_case.instance, result.solution, {result.ssi_s, result.order()});
        }
        RC_PRE(result.status != PlanStatus::kLimit);
        std::vector<double> all_s = {plan_case.options.ssi_s};
        all_s.insert(all_s.end(), longer_s.begin(), longer_s.end());
        std::size_t tries = 0;
        for (const double ssi_s : all_s) {
          plan_case.options.ssi_s = ssi_s;
          const PlanResult one = plan(plan_case.instance, plan_case.options);
          tries += one.tries();
          if (one.status != PlanStatus::kSolved) continue;
          RC_ASSERT(result.solution == one.solution);
          RC_ASSERT(result.ssi_s == ssi_s);
          RC_ASSERT(result.tries() == tries);
          return;
        }
        RC_ASSERT(result.status == PlanStatus::kFailed);
      });

  passed &= property("the best plan: valid, with the guarantee for as long as it says", [] {
    const PlanCase plan_case = any_noted_case();
    const SolveResult best = solve(plan_case.instance, best_options(plan_case));
    RC_CLASSIFY(best.steps.size() > 1, "several steps");
    RC_CLASSIFY(best.steps.size() > 1 && best.improvement, "solved in a later step");
    RC_ASSERT(best.improvement.has_value() == (best.plan.status == PlanStatus::kSolved));
    if (!best.improvement) return;
    RC_ASSERT(best.improvement->order.has_value());
    assert_valid(plan_case.instance, best.improvement->solution,
                 {best.ssi_kept_s(), *best.improvement->order});
    if (best.plan.made_by != Method::kComplete) RC_ASSERT(best.plan.ssi_kept_s == best.plan.ssi_s);
    const PlanCost before{flowtime_s(best.plan.solution), makespan_s(best.plan.solution)};
    RC_ASSERT(!is_better(Objective{}, before, best.improvement->log.curve.back().cost));
  });

  passed &= property("the best plan: solves what LaCAM solves", [] {
    PlanCase plan_case = any_noted_case();
    RC_PRE(!find_beyond_complete(plan_case.instance, plan_case.options.rules));
    const SolveResult best = solve(plan_case.instance, best_options(plan_case));
    RC_CLASSIFY(best.steps.back().kind == BestStep::Kind::kFallback, "by the fallback");
    plan_case.options.method = Method::kComplete;
    const PlanResult complete = plan(plan_case.instance, plan_case.options);
    RC_CLASSIFY(complete.status == PlanStatus::kSolved, "solved");
    if (complete.status == PlanStatus::kSolved) RC_ASSERT(best.improvement.has_value());
  });

  passed &=
      property("the best plan: solves what the method solves in few tries, and what ejection solves", [] {
        PlanCase plan_case = any_noted_case();
        plan_case.options.max_expansions = kAmpleExpansions;
        const SolveResult best = solve(plan_case.instance, best_options(plan_case));
        plan_case.options.max_restarts = 1;
        const PlanResult method = plan(plan_case.instance, plan_case.options);
        plan_case.options.rescheduling = Rescheduling::kEjection;
        plan_case.options.max_restarts = 4 * plan_case.instance.agents.size();
        const PlanResult ejection = plan(plan_case.instance, plan_case.options);
        RC_CLASSIFY(method.status != PlanStatus::kSolved && best.improvement.has_value(),
                    "better than the method");
        // Steps before it may have used up the restarts that ejection would need.
        if (method.status == PlanStatus::kSolved) {
          const PlanCost cost{flowtime_s(method.solution), makespan_s(method.solution)};
          RC_ASSERT(!is_better(Objective{}, cost, best.improvement->log.curve.back().cost));
          if (best.plan.made_by != Method::kComplete) RC_ASSERT(best.plan.solution == method.solution);
        } else if (ejection.status == PlanStatus::kSolved && best.plan.tries() <= kRestarts) {
          RC_ASSERT(best.improvement.has_value());
        }
      });

  passed &= property("the best plan: no worse than LaCAM's after some unit moves, with its corners cut", [] {
    const PlanCase plan_case = any_noted_case();
    const Instance& instance = plan_case.instance;
    RC_PRE(!find_beyond_complete(instance, plan_case.options.rules));
    const PlannerOptions options = best_options(plan_case);
    PlannerOptions step = plan_case.options;
    step.max_restarts = std::min<std::uint64_t>(step.max_restarts, 1);
    RC_PRE(plan(instance, step).status == PlanStatus::kSolved);
    step.method = Method::kComplete;
    const PlanResult complete = plan(instance, step);
    RC_PRE(complete.status == PlanStatus::kSolved);
    step.improve = budget_of_unit_moves(*options.improve);
    const auto begun = improve_unit_moves(instance, complete.solution, step);
    RC_PRE(begun.has_value());
    const PlanCost tightened = tightened_cost(instance, *begun, step);
    const SolveResult best = solve(instance, options);
    RC_PRE(best.steps.front().status == PlanStatus::kSolved);  // LaCAM has fewer steps there
    RC_CLASSIFY(best.plan.made_by == Method::kComplete, "LaCAM's is taken");
    RC_ASSERT(!is_better(Objective{}, tightened, best.improvement->log.curve.back().cost));
  });

  passed &= property("the best plan: the same again, and its tries are those of its steps", [] {
    const PlanCase plan_case = any_noted_case();
    PlannerOptions options = best_options(plan_case);
    options.max_restarts = *rc::gen::element<std::uint64_t>(40, 0, 1, 2, 4);
    const SolveResult one = solve(plan_case.instance, options);
    const SolveResult other = solve(plan_case.instance, options);
    RC_ASSERT(one.plan.status == other.plan.status);
    RC_ASSERT(one.plan.tries() == other.plan.tries());
    RC_ASSERT(one.improvement.has_value() == other.improvement.has_value());
    if (one.improvement) RC_ASSERT(one.improvement->solution == other.improvement->solution);
    std::size_t tries = 0;
    std::size_t counted = 0;
    for (const BestStep& step : one.steps) {
      tries += step.tries;
      if (step.kind != BestStep::Kind::kFallback) counted += step.tries;
    }
    RC_ASSERT(one.plan.tries() == tries);
    RC_CLASSIFY(counted == options.max_restarts + 1, "as many as allowed");
    RC_ASSERT(counted <= options.max_restarts + 1);
  });

  return passed;
});

}  // namespace
}  // namespace sipplab::best_plan_laws
