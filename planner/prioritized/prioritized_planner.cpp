#include "sipplab/prioritized_planner.hpp"

#include <algorithm>
#include <memory>

#include "planner/prioritized/limits.hpp"
#include "planner/prioritized/priority_order.hpp"
#include "planner/prioritized/start_guard.hpp"
#include "planner/search/sipp_search.hpp"

namespace sipplab {
namespace {

/// How one pass over an order ended.
struct PassResult {
  std::optional<AgentIndex> failed;
  PlanFailure failure = PlanFailure::kNoPath;
};

/// Plans the agents one by one, each around those before it.
PassResult plan_in_order(const Instance& instance, const PlannerOptions& options, const PriorityOrder& order,
                         SingleAgentPlanner& planner, const SearchLimits& limits,
                         ReservationTable& reservations, SearchStatistics& statistics, Solution& solution) {
  reservations.clear();
  for (const DynamicObstacle& obstacle : instance.obstacles) {
    reservations.add(obstacle.trajectory, obstacle.radius_cells);
  }
  StartGuard starts(instance, options.ssi_s, reservations);
  for (AgentIndex agent = 0; agent < instance.agents.size(); ++agent) starts.protect(agent);
  for (const AgentIndex agent : order) {
    SearchLimits left = limits;
    left.max_expansions = limits.max_expansions - statistics.expansions;
    starts.begin(agent);
    Expected<Trajectory, PlanFailure> trajectory = planner.plan(agent, reservations, left, statistics);
    starts.end();
    if (!trajectory) return {agent, trajectory.error()};
    reservations.add(*trajectory, instance.agents[agent].radius_cells);
    solution.trajectories[agent] = std::move(*trajectory);
  }
  return {};
}

}  // namespace

PlanResult plan_prioritized(const Instance& instance, const PlannerOptions& options,
                            SingleAgentPlanner& planner) {
  const Clock::time_point begin = Clock::now();
  const SearchLimits limits = search_limits(options, begin);
  std::vector<double> lengths_s;
  for (AgentIndex agent = 0; agent < instance.agents.size(); ++agent) {
    lengths_s.push_back(planner.lower_bound_s(agent));
  }
  Random random(options.seed);
  PriorityOrder first = initial_order(options.order, lengths_s, random);
  OrderSequence orders(options.rescheduling, std::move(first), random);

  ReservationTable reservations(instance.map, askers_of(instance, options.rules));
  PlanResult result;
  result.ssi_s = result.ssi_kept_s = options.ssi_s;
  while (true) {
    Solution solution;
    solution.trajectories.resize(instance.agents.size());
    const PassResult pass = plan_in_order(instance, options, orders.current(), planner, limits, reservations,
                                          result.statistics, solution);
    result.trace.push_back({orders.current(), pass.failed, {}});
    if (!pass.failed) {
      result.status = PlanStatus::kSolved;
      result.solution = std::move(solution);
      break;
    }
    if (pass.failure != PlanFailure::kNoPath) {
      result.status = PlanStatus::kLimit;
      break;
    }
    if (!orders.advance(*pass.failed)) {
      result.status = PlanStatus::kFailed;
      break;
    }
    if (result.trace.size() > options.max_restarts || limits.is_over()) {
      result.status = PlanStatus::kLimit;
      break;
    }
  }
  result.planning_seconds = seconds_since(begin);
  return result;
}

std::unique_ptr<SingleAgentPlanner> single_agent_planner(const Instance& instance,
                                                         const PlannerOptions& options) {
  const SippOptions search{options.any_angle, options.connectedness, options.weight, options.rules};
  if (options.rules.is_plain()) return std::make_unique<SippSearch>(instance, search);
  return std::make_unique<TurningSearch>(instance, search);
}

}  // namespace sipplab
