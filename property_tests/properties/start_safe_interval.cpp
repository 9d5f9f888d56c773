// Start-safe intervals: the guarantee that is made for the final order, and what an
// interval of 0 leaves alone. [AY18], section 3.
#include <rapidcheck.h>

#include <algorithm>
#include <cmath>

#include "planner/core/tolerances.hpp"
#include "planner/solve/plan.hpp"
#include "property_tests/support/generators.hpp"
#include "property_tests/support/property.hpp"
#include "property_tests/support/sampling_oracle.hpp"
#include "sipplab/validator.hpp"

namespace sipplab::start_safe_interval_laws {
namespace {

constexpr double kSampleStepS = 1.0 / 32;

/// A case with the given start-safe interval, and its solution.
struct Solved {
  PlanCase plan_case;
  PlanResult result;
};
Solved any_solved(const rc::Gen<double>& ssi) {
  Solved solved{*any_case(), {}};
  solved.plan_case.options.ssi_s = *ssi;
  RC_PRE(solved.plan_case.instance.agents.size() >= 2);
  note_case(solved.plan_case);
  solved.result = plan(solved.plan_case.instance, solved.plan_case.options);
  RC_CLASSIFY(solved.result.status == PlanStatus::kSolved, "solved");
  RC_CLASSIFY(solved.result.tries() > 1, "several tries");
  return solved;
}

void keeps_its_guarantee(const Solved& solved) {
  if (solved.result.status != PlanStatus::kSolved) return;
  ValidationOptions options;
  options.ssi_s = solved.plan_case.options.ssi_s;
  options.rules = solved.plan_case.options.rules;
  options.order = solved.result.order();
  const ValidationReport report = validate(solved.plan_case.instance, solved.result.solution, options);
  for (const Violation& violation : report.violations) RC_LOG() << violation.message << '\n';
  RC_ASSERT(report.valid());
}

rc::Gen<double> any_eighths() {
  return rc::gen::map(rc::gen::inRange(1, 64), [](int eighths) { return eighths / 8.0; });
}

/// The agents in their priority order, so that fifo is that order.
Instance in_order(const Instance& instance, const PriorityOrder& order) {
  Instance sorted = instance;
  for (std::size_t i = 0; i < order.size(); ++i) sorted.agents[i] = instance.agents[order[i]];
  return sorted;
}

const PropertyRoom room("start_safe_interval", [] {
  bool passed = true;

  passed &= property("no robot comes too near a lower-priority start during [0, k], k a fraction",
                     [] { keeps_its_guarantee(any_solved(any_eighths())); });

  passed &= property("no robot ever comes too near a lower-priority start, its own goal's disk excepted",
                     [] { keeps_its_guarantee(any_solved(rc::gen::just(kInfiniteSsi))); });

  passed &= property("the guarantee holds at many times as well", [] {
    const Solved solved = any_solved(any_eighths());
    RC_PRE(solved.result.status == PlanStatus::kSolved);
    const auto& agents = solved.plan_case.instance.agents;
    const PriorityOrder& order = solved.result.order();
    for (std::size_t i = 0; i < order.size(); ++i) {
      for (std::size_t j = i + 1; j < order.size(); ++j) {
        const double contact = agents[order[i]].radius_cells + agents[order[j]].radius_cells;
        for (double time_s = 0; time_s <= solved.plan_case.options.ssi_s; time_s += kSampleStepS) {
          const Vec2 place = sampled_position(solved.result.solution.trajectories[order[i]], time_s);
          RC_ASSERT(norm(place - centre(agents[order[j]].start)) >= contact - kValidatorToleranceCells);
        }
      }
    }
  });

  passed &= property("with an interval of 0, the others move as they do without the last robot", [] {
    const Solved solved = any_solved(rc::gen::just(0.0));
    RC_PRE(solved.result.status == PlanStatus::kSolved);
    PlannerOptions options = solved.plan_case.options;
    options.order = InitialOrder::kFifo;
    options.rescheduling = Rescheduling::kNone;
    Instance instance = in_order(solved.plan_case.instance, solved.result.order());
    const PlanResult all = plan(instance, options);
    RC_ASSERT(all.status == PlanStatus::kSolved);
    instance.agents.pop_back();
    const PlanResult others = plan(instance, options);
    RC_ASSERT(others.status == PlanStatus::kSolved);
    Solution expected = all.solution;
    expected.trajectories.pop_back();
    RC_ASSERT(others.solution == expected);
  });

  passed &= property("a start is entered as soon as its protection ends, and no sooner", [] {
    // Robot 0 has to go through the start of robot 1.
    const int eighths = *rc::gen::inRange(0, 64);
    Instance instance;
    instance.map = GridMap(8, 3);
    instance.map.set_blocked({2, 0}, true);
    instance.map.set_blocked({2, 2}, true);
    instance.agents.resize(2);
    instance.agents[0].start = {0, 1};
    instance.agents[0].goal = {7, 1};
    instance.agents[1].start = {2, 1};
    instance.agents[1].goal = {7, 2};
    PlannerOptions options;
    options.order = InitialOrder::kFifo;
    options.rescheduling = Rescheduling::kNone;
    options.ssi_s = eighths / 8.0;
    const PlanResult result = plan(instance, options);
    RC_ASSERT(result.status == PlanStatus::kSolved);
    // 7 cells to go. Where the robot touches the protected start, 6 of them lie ahead.
    const double earliest_s = std::max(7.0, options.ssi_s + 6);
    RC_ASSERT(std::abs(result.solution.trajectories[0].arrival_s() - earliest_s) < 1e-6);
  });

  return passed;
});

}  // namespace
}  // namespace sipplab::start_safe_interval_laws
