#include "planner/prioritized/prioritized_planner.hpp"

#include <algorithm>
#include <memory>

#include "planner/complete/complete_planner.hpp"
#include "planner/prioritized/ejection.hpp"
#include "planner/prioritized/limits.hpp"
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

std::string_view name(PlanStatus status) {
  switch (status) {
    case PlanStatus::kSolved:
      return "solved";
    case PlanStatus::kFailed:
      return "failed";
    case PlanStatus::kLimit:
      return "limit";
  }
  return "unknown";
}

PlanResult plan_prioritized(const Instance& instance, const PlannerOptions& options,
                            SingleAgentPlanner& planner) {
  if (options.rescheduling == Rescheduling::kEjection) return plan_by_ejection(instance, options, planner);
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

namespace {

PlanStatus status_of(LacamStatus status) {
  switch (status) {
    case LacamStatus::kSolved:
      return PlanStatus::kSolved;
    case LacamStatus::kUnsolvable:
      return PlanStatus::kFailed;
    case LacamStatus::kLimit:
      return PlanStatus::kLimit;
  }
  return PlanStatus::kFailed;
}

/// Goes on where `result` has no plan.
void plan_all_at_once(const Instance& instance, const PlannerOptions& options, PlanResult& result) {
  result.made_by = Method::kComplete;
  result.ssi_s = options.ssi_s;
  if (find_beyond_complete(instance, options.rules)) return;
  CompleteOptions complete_options;
  complete_options.seed = options.seed;
  complete_options.ssi_s = options.ssi_s;
  complete_options.max_steps = options.max_expansions;
  complete_options.deadline = deadline_after(Clock::now(), options.time_limit_s);
  CompleteResult complete = plan_complete(instance, complete_options);
  result.status = status_of(complete.status);
  result.statistics.expansions += complete.steps_tried;
  result.statistics.generations += complete.configurations;
  if (result.status != PlanStatus::kSolved) return;
  result.solution = std::move(complete.solution);
  result.trace.push_back({std::move(complete.order), std::nullopt, {}});
  result.ssi_kept_s = complete.ssi_kept_s;
}

}  // namespace

std::unique_ptr<SingleAgentPlanner> single_agent_planner(const Instance& instance,
                                                         const PlannerOptions& options) {
  const SippOptions search{options.any_angle, options.connectedness, options.weight, options.rules};
  if (options.rules.is_plain()) return std::make_unique<SippSearch>(instance, search);
  return std::make_unique<TurningSearch>(instance, search);
}

namespace {

/// By the method of the options alone: no fallback.
PlanResult plan_by_method(const Instance& instance, const PlannerOptions& options) {
  const Clock::time_point begin = Clock::now();
  PlanResult result;
  if (options.method == Method::kComplete) {
    plan_all_at_once(instance, options, result);
  } else {
    const std::unique_ptr<SingleAgentPlanner> search = single_agent_planner(instance, options);
    result = plan_prioritized(instance, options, *search);
  }
  result.planning_seconds = seconds_since(begin);
  return result;
}

}  // namespace

PlanResult plan(const Instance& instance, const PlannerOptions& options) {
  return plan_escalating(instance, options, {});
}

PlannerOptions left_of(const PlannerOptions& options, const PlanResult& done) {
  PlannerOptions left = options;
  left.time_limit_s = options.time_limit_s - done.planning_seconds;
  left.max_expansions = options.max_expansions - done.statistics.expansions;
  left.max_restarts = options.max_restarts - done.tries();
  return left;
}

void prepend(const PlanResult& before, PlanResult& result) {
  result.trace.insert(result.trace.begin(), before.trace.begin(), before.trace.end());
  result.statistics += before.statistics;
  result.planning_seconds += before.planning_seconds;
}

PlanResult plan_escalating(const Instance& instance, const PlannerOptions& options,
                           const std::vector<double>& longer_s) {
  const Clock::time_point begin = Clock::now();
  PlanResult result = plan_by_method(instance, options);
  for (const double ssi_s : longer_s) {
    if (result.status != PlanStatus::kFailed) break;
    PlannerOptions left = left_of(options, result);
    if (result.tries() > options.max_restarts || !(left.time_limit_s > 0)) {
      result.status = PlanStatus::kLimit;
      break;
    }
    left.ssi_s = ssi_s;
    PlanResult next = plan_by_method(instance, left);
    prepend(result, next);
    result = std::move(next);
  }
  const bool may_fall_back = options.fallback == Fallback::kComplete && options.method != Method::kComplete;
  if (may_fall_back && result.status != PlanStatus::kSolved) plan_all_at_once(instance, options, result);
  result.planning_seconds = seconds_since(begin);
  return result;
}

}  // namespace sipplab
