// No two bodies of a plan ever overlap: what the whole planner is for. Cases of every
// family, with every order, re-scheduling, start-safe interval and neighbourhood.
#include <rapidcheck.h>

#include <cstdint>
#include <string>

#include "planner/core/tolerances.hpp"
#include "planner/instance/reachability.hpp"
#include "planner/solve/plan.hpp"
#include "property_tests/support/generators.hpp"
#include "property_tests/support/property.hpp"
#include "property_tests/support/sampling_oracle.hpp"
#include "sipplab/validator.hpp"

namespace sipplab::pairwise_separation_laws {
namespace {

constexpr double kSampleStepS = 1.0 / 32;

void classify_outcome(const PlanResult& result) {
  RC_CLASSIFY(result.status == PlanStatus::kSolved, "solved");
  RC_CLASSIFY(result.status == PlanStatus::kFailed, "failed");
  RC_CLASSIFY(result.status == PlanStatus::kLimit, "limit");
  RC_CLASSIFY(result.tries() > 1, "several tries");
}

void plan_is_valid(const PlanCase& plan_case) {
  const PlanResult result = plan(plan_case.instance, plan_case.options);
  classify_case(plan_case);
  classify_outcome(result);
  if (result.status != PlanStatus::kSolved) {
    RC_ASSERT(result.solution.trajectories.empty());
    return;
  }
  const ValidationReport report = validate(plan_case.instance, result.solution);
  for (const Violation& violation : report.violations) RC_LOG() << violation.message << '\n';
  RC_ASSERT(report.valid());
}

/// The second opinion on the second opinion.
void plan_stays_apart_at_many_times(const PlanCase& plan_case) {
  const Instance& instance = plan_case.instance;
  const PlanResult result = plan(instance, plan_case.options);
  RC_PRE(result.status == PlanStatus::kSolved);
  const auto check = [&](const Trajectory& a, double radius_a, const Trajectory& b, double radius_b) {
    const SampledDistance sampled = sample_distance(a, b, kSampleStepS);
    RC_ASSERT(sampled.least_cells >= radius_a + radius_b - kValidatorToleranceCells);
  };
  const auto& trajectories = result.solution.trajectories;
  for (AgentIndex i = 0; i < instance.agents.size(); ++i) {
    const double radius = instance.agents[i].radius_cells;
    for (AgentIndex j = i + 1; j < instance.agents.size(); ++j) {
      check(trajectories[i], radius, trajectories[j], instance.agents[j].radius_cells);
    }
    for (const DynamicObstacle& obstacle : instance.obstacles) {
      check(trajectories[i], radius, obstacle.trajectory, obstacle.radius_cells);
    }
  }
}

/// Blocks the eight cells around one.
void wall_in(GridMap& map, Cell middle) {
  for (std::int32_t y = middle.y - 1; y <= middle.y + 1; ++y) {
    for (std::int32_t x = middle.x - 1; x <= middle.x + 1; ++x) {
      const Cell cell{x, y};
      if (cell != middle && map.contains(cell)) map.set_blocked(cell, true);
    }
  }
}

const PropertyRoom room("pairwise_separation", [] {
  bool passed = true;

  for (int i = 0; i < kCaseFamilies; ++i) {
    const auto family = static_cast<CaseFamily>(i);
    passed &= property("every solution passes the validator: " + std::string(name(family)),
                       [family] { plan_is_valid(*any_case_of(family)); });
  }

  passed &= property("no two bodies of a solution overlap at any of many times",
                     [] { plan_stays_apart_at_many_times(*any_case()); });

  passed &= property("an instance with an unreachable goal is not solved", [] {
    PlanCase plan_case = *any_case_of(CaseFamily::kScattered);
    Instance& instance = plan_case.instance;
    RC_PRE(!instance.agents.empty());
    wall_in(instance.map, instance.agents.back().goal);
    RC_PRE(!find_error(instance) && find_unreachable_goal(instance));
    note_case(plan_case);
    RC_ASSERT(plan(instance, plan_case.options).status != PlanStatus::kSolved);
  });

  return passed;
});

}  // namespace
}  // namespace sipplab::pairwise_separation_laws
