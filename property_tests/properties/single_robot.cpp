// One robot alone: the one case in which everything is known.
#include <rapidcheck.h>

#include <cstdint>
#include <optional>
#include <vector>

#include "planner/solve/plan.hpp"
#include "property_tests/support/generators.hpp"
#include "property_tests/support/property.hpp"
#include "property_tests/support/steps_between.hpp"

namespace sipplab::single_robot_laws {
namespace {

/// A case of one robot of radius 0.5 and speed 1, and nothing that moves.
PlanCase one_robot() {
  PlanCase plan_case = *any_case_of(CaseFamily::kScattered);
  RC_PRE(!plan_case.instance.agents.empty());
  plan_case.instance.agents.resize(1);
  plan_case.instance.obstacles.clear();
  note_case(plan_case);
  return plan_case;
}

const PropertyRoom room("single_robot", [] {
  bool passed = true;

  passed &= property("solved exactly when breadth-first search reaches the goal", [] {
    const PlanCase plan_case = one_robot();
    const Agent& agent = plan_case.instance.agents[0];
    const PlanResult result = plan(plan_case.instance, plan_case.options);
    const auto steps = steps_between(plan_case.instance.map, agent.start, agent.goal);
    RC_ASSERT((result.status == PlanStatus::kSolved) == steps.has_value());
    RC_CLASSIFY(!steps, "unreachable");
    RC_CLASSIFY(plan_case.options.any_angle, "any-angle");
  });

  passed &= property("no faster than the bird flies, no slower than breadth-first search", [] {
    const PlanCase plan_case = one_robot();
    const Agent& agent = plan_case.instance.agents[0];
    const PlanResult result = plan(plan_case.instance, plan_case.options);
    RC_PRE(result.status == PlanStatus::kSolved);
    const double arrival_s = result.solution.trajectories[0].arrival_s();
    // Rounding of sums of square roots.
    constexpr double kRoundingS = 1e-9;
    RC_ASSERT(arrival_s >= distance(agent.start, agent.goal) - kRoundingS);
    const double steps_s = *steps_between(plan_case.instance.map, agent.start, agent.goal);
    RC_ASSERT(arrival_s <= plan_case.options.weight * steps_s + kRoundingS);
    if (plan_case.options.weight == 1 && !plan_case.options.any_angle &&
        plan_case.options.connectedness == 2) {
      RC_ASSERT(arrival_s == *steps_between(plan_case.instance.map, agent.start, agent.goal));
    }
  });

  passed &= property("any-angle goes straight where nothing is in the way", [] {
    PlanCase plan_case = one_robot();
    plan_case.options.any_angle = true;
    GridMap& map = plan_case.instance.map;
    map = GridMap(map.width(), map.height());
    note_case(plan_case);
    const Agent& agent = plan_case.instance.agents[0];
    const PlanResult result = plan(plan_case.instance, plan_case.options);
    RC_ASSERT(result.status == PlanStatus::kSolved);
    RC_ASSERT(result.solution.trajectories[0].motions.size() == (agent.start == agent.goal ? 0u : 1u));
  });

  return passed;
});

}  // namespace
}  // namespace sipplab::single_robot_laws
