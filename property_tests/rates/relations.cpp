// The relations one by one; see relations.hpp.
#include "property_tests/rates/relations.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "property_tests/rates/well_formed.hpp"
#include "property_tests/support/symmetry.hpp"

namespace sipplab {
namespace {

using Outcome = std::optional<bool>;

/// Seconds. Sums of the same times in another order differ by less, and other plans
/// by more.
constexpr double kSameTimeS = 1e-6;

Outcome solved(const PlanResult& result) {
  if (result.status == PlanStatus::kLimit) return std::nullopt;
  return result.status == PlanStatus::kSolved;
}

PlanResult plan_of_instance(const Planned& planned, const Instance& instance) {
  return plan(instance, planned.plan_case.options);
}

Outcome keeps_status(const Planned& planned, const Instance& changed) {
  if (planned.plan_case.instance.agents.empty() || find_error(changed)) return std::nullopt;
  const Outcome before = solved(planned.result);
  const Outcome after = solved(plan_of_instance(planned, changed));
  if (!before || !after) return std::nullopt;
  return *before == *after;
}

Outcome keeps_flowtime(const Planned& planned, const Instance& changed) {
  if (planned.plan_case.instance.agents.empty() || !planned.solved()) return std::nullopt;
  const PlanResult after = plan_of_instance(planned, changed);
  if (after.status != PlanStatus::kSolved) return std::nullopt;
  return std::abs(flowtime_s(after.solution) - flowtime_s(planned.result.solution)) <= kSameTimeS;
}

/// Only of what is solved before.
Outcome stays_solved(const Planned& planned, const PlanCase& changed) {
  if (planned.plan_case.instance.agents.empty() || !planned.solved()) return std::nullopt;
  return solved(plan(changed.instance, changed.options));
}

Instance turned(const Planned& planned) { return rotated({planned.plan_case.instance, {}}).instance; }
Instance mirrored(const Planned& planned) { return reflected({planned.plan_case.instance, {}}).instance; }

Outcome turn_keeps_status(const Planned& planned, Random& /*random*/) {
  return keeps_status(planned, turned(planned));
}
Outcome turn_keeps_flowtime(const Planned& planned, Random& /*random*/) {
  return keeps_flowtime(planned, turned(planned));
}
Outcome mirror_keeps_status(const Planned& planned, Random& /*random*/) {
  return keeps_status(planned, mirrored(planned));
}
Outcome mirror_keeps_flowtime(const Planned& planned, Random& /*random*/) {
  return keeps_flowtime(planned, mirrored(planned));
}

Outcome solved_without_one(const Planned& planned, Random& random) {
  PlanCase changed = planned.plan_case;
  auto& agents = changed.instance.agents;
  if (agents.size() < 2) return std::nullopt;
  agents.erase(agents.begin() + static_cast<std::ptrdiff_t>(random.below(agents.size())));
  return stays_solved(planned, changed);
}

Outcome solved_with_longer_ssi(const Planned& planned, Random& random) {
  PlanCase changed = planned.plan_case;
  double& ssi_s = changed.options.ssi_s;
  if (std::isinf(ssi_s)) return std::nullopt;
  ssi_s = random.below(3) == 0 ? kInfiniteSsi : ssi_s + 0.5 + static_cast<double>(random.below(8)) / 2;
  return stays_solved(planned, changed);
}

Outcome swap_keeps_status(const Planned& planned, Random& /*random*/) {
  Instance changed = planned.plan_case.instance;
  for (Agent& agent : changed.agents) std::swap(agent.start, agent.goal);
  return keeps_status(planned, changed);
}

Outcome permutation_keeps_status(const Planned& planned, Random& random) {
  PlanCase fifo = planned.plan_case;
  if (fifo.instance.agents.size() < 2) return std::nullopt;
  fifo.options.order = InitialOrder::kFifo;
  Instance changed = fifo.instance;
  random.shuffle(changed.agents);
  return keeps_status(plan_of(std::move(fifo)), changed);
}

Outcome none_sooner_than_alone(const Planned& planned, Random& /*random*/) {
  if (planned.plan_case.instance.agents.empty() || !planned.solved()) return std::nullopt;
  for (AgentIndex i = 0; i < planned.plan_case.instance.agents.size(); ++i) {
    Instance alone = planned.plan_case.instance;
    alone.agents = {planned.plan_case.instance.agents[i]};
    const PlanResult result = plan_of_instance(planned, alone);
    if (result.status == PlanStatus::kLimit) return std::nullopt;
    // Not found alone, but found among others: sooner than never.
    if (result.status == PlanStatus::kFailed) return false;
    const double arrival_s = planned.result.solution.trajectories[i].arrival_s();
    if (arrival_s < makespan_s(result.solution) - kSameTimeS) return false;
  }
  return true;
}

Outcome well_formed_is_solved(const Planned& planned, Random& /*random*/) {
  if (planned.plan_case.instance.agents.empty() || !is_well_formed(planned.plan_case.instance)) {
    return std::nullopt;
  }
  return solved(planned.result);
}

Outcome well_formed_is_solved_with_starts_kept(const Planned& planned, Random& random) {
  PlanCase changed = planned.plan_case;
  changed.options.ssi_s = kInfiniteSsi;
  return well_formed_is_solved(plan_of(std::move(changed)), random);
}

}  // namespace

Planned plan_of(PlanCase plan_case) {
  PlanResult result = plan(plan_case.instance, plan_case.options);
  return {std::move(plan_case), std::move(result)};
}

const std::vector<Relation>& soft_relations() {
  static const std::vector<Relation> relations = {
      {"a quarter turn of the map keeps the status", turn_keeps_status},
      {"a quarter turn of the map keeps the flowtime", turn_keeps_flowtime},
      {"a mirror keeps the status", mirror_keeps_status},
      {"a mirror keeps the flowtime", mirror_keeps_flowtime},
      {"what is solved stays solved without one robot", solved_without_one},
      {"what is solved stays solved with a longer start-safe interval", solved_with_longer_ssi},
      {"swapping starts and goals keeps the status", swap_keeps_status},
      {"another fifo order keeps the status", permutation_keeps_status},
      {"no robot arrives sooner than it would alone", none_sooner_than_alone},
      {"a well-formed instance is solved", well_formed_is_solved},
      {"a well-formed instance is solved with an infinite start-safe interval",
       well_formed_is_solved_with_starts_kept},
  };
  return relations;
}

}  // namespace sipplab
