#include "planner/unit_moves/attempt.hpp"

#include <algorithm>
#include <utility>

#include "planner/improve/objective.hpp"
#include "sipplab/error.hpp"

namespace sipplab {
namespace {

/// Expansions after which a search for one robot is given up.
constexpr std::uint64_t kMostExpansions = 300'000;

PlanCost in_ticks(const UnitCost& cost) {
  return {static_cast<double>(cost.flowtime), static_cast<double>(cost.makespan)};
}

/// The latest arrival with which the plan may still be no worse, if `left` is what robots had that have none
/// now, less what they need at least.
Tick latest_arrival(const UnitRound& round, std::int64_t left) {
  const Objective& objective = round.objective;
  const UnitCost& cost = round.cost;
  const double spare = round.worst - value(objective, cost);
  if (objective.flowtime_weight == 0)
    return cost.makespan + static_cast<Tick>(spare / objective.makespan_weight);
  const double from_makespan = objective.makespan_weight * cost.makespan;
  const double latest = static_cast<double>(left) + (from_makespan + spare) / objective.flowtime_weight;
  return latest < kNever ? static_cast<Tick>(latest) : kNever;
}

}  // namespace

double value(const Objective& objective, const UnitCost& cost) {
  return objective.of(static_cast<double>(cost.flowtime), static_cast<double>(cost.makespan));
}

bool is_better(const Objective& objective, const UnitCost& one, const UnitCost& other) {
  return is_better(objective, in_ticks(one), in_ticks(other));
}

UnitWorker::UnitWorker(const UnitMoves& moves, SharedDistances& distances, const std::vector<Route>& plan)
    : distances_(distances),
      plan_(moves, plan.size()),
      search_(moves, distances),
      neighbourhoods_(plan_, distances) {
  for (RobotId robot = 0; robot < plan.size(); ++robot) plan_.insert(robot, plan[robot]);
}

UnitCost UnitWorker::cost() const {
  UnitCost cost;
  for (RobotId robot = 0; robot < plan_.robots(); ++robot) {
    cost.flowtime += plan_.arrival(robot);
    cost.makespan = std::max(cost.makespan, plan_.arrival(robot));
  }
  return cost;
}

UnitAttempt UnitWorker::attempt(const UnitRound& round, Random random) {
  UnitAttempt attempt;
  attempt.path = round.paths.draw(random);
  attempt.robots = neighbourhoods_.choose(static_cast<UnitRule>(attempt.path % kUnitRules),
                                          kUnitSizes[attempt.path / kUnitRules], random);
  random.shuffle(attempt.robots);
  const SearchStatistics before_it{search_.expansions(), search_.generations()};
  std::vector<Route> before = remove(attempt.robots);
  plan_again(round, before, attempt);
  if (attempt.found.size() == attempt.robots.size()) {
    const UnitCost cost = cost_with(round.cost, attempt, before);
    attempt.is_accepted = attempt.found != before && value(round.objective, cost) <= round.worst;
    attempt.gain = std::max(value(round.objective, round.cost) - value(round.objective, cost), 0.0);
  }
  put_back(attempt, attempt.found.size(), std::move(before));
  attempt.work.expansions = search_.expansions() - before_it.expansions;
  attempt.work.generations = search_.generations() - before_it.generations;
  return attempt;
}

void UnitWorker::plan_again(const UnitRound& round, const std::vector<Route>& before, UnitAttempt& attempt) {
  // What the robots had together, less what those that are planned have and the others need.
  std::int64_t left = 0;
  for (std::size_t i = 0; i < before.size(); ++i) {
    left += before[i].back().arrival - distances_.least_arrival(attempt.robots[i]);
  }
  for (const RobotId robot : attempt.robots) {
    left += distances_.least_arrival(robot);
    const Tick latest = latest_arrival(round, left);
    std::optional<Route> found = search_.find(robot, plan_, latest, kMostExpansions);
    if (!found) return;
    left -= found->back().arrival;
    plan_.insert(robot, *found);
    attempt.found.push_back(std::move(*found));
  }
}

std::vector<Route> UnitWorker::take_over(const UnitRound& round, const UnitAttempt& attempt, UnitCost& cost) {
  PLANNER_ASSERT(attempt.is_accepted);
  std::vector<Route> before = remove(attempt.robots);
  std::size_t entered = 0;
  while (entered < attempt.robots.size() && plan_.fits(attempt.found[entered])) {
    plan_.insert(attempt.robots[entered], attempt.found[entered]);
    ++entered;
  }
  if (entered == attempt.robots.size()) {
    const UnitCost now = cost_with(cost, attempt, before);
    if (value(round.objective, now) <= round.worst) {
      cost = now;
      return before;
    }
  }
  put_back(attempt, entered, std::move(before));
  return {};
}

void UnitWorker::replace(const std::vector<RobotId>& robots, const std::vector<Route>& routes) {
  remove(robots);
  for (std::size_t i = 0; i < robots.size(); ++i) plan_.insert(robots[i], routes[i]);
}

std::vector<Route> UnitWorker::remove(const std::vector<RobotId>& robots) {
  std::vector<Route> before;
  before.reserve(robots.size());
  for (const RobotId robot : robots) before.push_back(plan_.remove(robot));
  return before;
}

/// The first `entered` robots are in the plan, with their new routes.
void UnitWorker::put_back(const UnitAttempt& attempt, std::size_t entered, std::vector<Route> before) {
  for (std::size_t i = 0; i < entered; ++i) plan_.remove(attempt.robots[i]);
  for (std::size_t i = 0; i < before.size(); ++i) plan_.insert(attempt.robots[i], std::move(before[i]));
}

/// Of the plan with the new routes, if `cost` is that with those before. O(robots) only if one of these was
/// among the last to arrive.
UnitCost UnitWorker::cost_with(const UnitCost& cost, const UnitAttempt& attempt,
                               const std::vector<Route>& before) const {
  UnitCost with = cost;
  Tick latest_before = 0;
  Tick latest = 0;
  for (std::size_t i = 0; i < before.size(); ++i) {
    const Tick arrival = attempt.found[i].back().arrival;
    with.flowtime += arrival - before[i].back().arrival;
    latest_before = std::max(latest_before, before[i].back().arrival);
    latest = std::max(latest, arrival);
  }
  with.makespan = latest_before == cost.makespan ? latest_of_others() : std::max(latest, cost.makespan);
  return with;
}

Tick UnitWorker::latest_of_others() const {
  Tick latest = 0;
  for (RobotId robot = 0; robot < plan_.robots(); ++robot) latest = std::max(latest, plan_.arrival(robot));
  return latest;
}

}  // namespace sipplab
