#include "planner/improve/tighten.hpp"

#include <algorithm>
#include <memory>
#include <numeric>
#include <vector>

#include "planner/improve/attempt.hpp"
#include "planner/prioritized/limits.hpp"

namespace sipplab {
namespace {

/// Share of the flowtime that a pass must gain for another one.
constexpr double kLeastGain = 0.002;

}  // namespace

double length_cells(const Trajectory& trajectory) {
  double cells = 0;
  for (const TimedMotion& motion : trajectory.motions) cells += distance(motion.from, motion.to);
  return cells;
}

PlanCost tighten_all(const Instance& instance, PartialPlan& plan, PlanCost cost, const SearchLimits& limits,
                     const std::function<void(const PlanCost&)>& after_pass) {
  std::vector<AgentIndex> agents(instance.agents.size());
  std::iota(agents.begin(), agents.end(), AgentIndex{0});
  std::vector<double> standing_s(agents.size());
  double before_s = kForever;
  while (!limits.is_over() && before_s - cost.flowtime_s > kLeastGain * cost.flowtime_s) {
    before_s = cost.flowtime_s;
    for (const AgentIndex agent : agents) {
      const Trajectory& trajectory = plan.trajectory(agent);
      standing_s[agent] =
          trajectory.arrival_s() - length_cells(trajectory) / instance.agents[agent].speed_cells_per_s;
    }
    std::stable_sort(agents.begin(), agents.end(),
                     [&](AgentIndex a, AgentIndex b) { return standing_s[a] > standing_s[b]; });
    for (const AgentIndex agent : agents) {
      if (limits.is_over()) break;
      plan.tighten(agent);
    }
    cost = cost_of(instance, plan);
    if (after_pass && cost.flowtime_s < before_s) after_pass(cost);
  }
  return cost;
}

PlanCost tightened_cost(const Instance& instance, const Solution& given, const PriorityOrder& order,
                        const PlannerOptions& options) {
  SearchLimits limits;
  limits.deadline = deadline_after(Clock::now(), options.improve.value_or(ImproveBudget{}).seconds);
  limits.stop = options.stop;
  const std::unique_ptr<SingleAgentPlanner> planner = single_agent_planner(instance, options);
  PartialPlan plan(instance, options.ssi_s, *planner);
  for (const AgentIndex agent : order) plan.insert(agent, given.trajectories[agent]);
  return tighten_all(instance, plan, cost_of(instance, plan), limits);
}

}  // namespace sipplab
