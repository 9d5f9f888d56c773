#include "planner/improve/attempt.hpp"

#include <algorithm>
#include <utility>

#include "sipplab/error.hpp"

namespace sipplab {
namespace {

/// Robots removed at once: few, so that thousands of neighbourhoods are tried in the time
/// that one plan takes. From trials on the paper's warehouse.
constexpr std::size_t kFewestRemoved = 2;
constexpr std::size_t kMostRemoved = 5;

/// Seconds. Rounding of sums of arrivals: a robot that arrives exactly as before may make
/// room for others.
constexpr double kArrivalToleranceS = 1e-9;

/// Robots that are out of the plan until put_back().
class Removal {
 public:
  Removal(const std::vector<AgentIndex>& robots, PartialPlan& plan) : plan_(plan) {
    for (const AgentIndex robot : robots) taken_.push_back(plan.take_out(robot));
  }

  const Trajectory& before(std::size_t i) const { return taken_[i].trajectory; }

  /// The first `entered` of them are in the plan again, with other trajectories.
  void put_back(std::size_t entered) {
    while (entered > 0) plan_.take_out(taken_[--entered].agent);
    for (PartialPlan::Taken& taken : taken_) plan_.put_back(std::move(taken));
  }

 private:
  PartialPlan& plan_;
  std::vector<PartialPlan::Taken> taken_;
};

/// The latest arrival of robots[planned] with which the plan may still become better, if
/// those after it were as fast as possible.
double latest_arrival_s(const Round& round, const PartialPlan& plan, const std::vector<AgentIndex>& robots,
                        const Removal& removal, std::size_t planned) {
  double left_s = 0;            // of the flowtime that these robots had together
  double least_makespan_s = 0;  // whatever robots[planned] does
  for (std::size_t i = 0; i < robots.size(); ++i) {
    left_s += removal.before(i).arrival_s();
    if (i == planned) continue;
    const double arrival_s =
        i < planned ? plan.trajectory(robots[i]).arrival_s() : round.fastest_s[robots[i]];
    left_s -= arrival_s;
    least_makespan_s = std::max(least_makespan_s, arrival_s);
  }
  for (AgentIndex agent = 0; agent < round.instance.agents.size(); ++agent) {
    if (plan.is_planned(agent)) {
      least_makespan_s = std::max(least_makespan_s, plan.trajectory(agent).arrival_s());
    }
  }
  const Objective& objective = round.objective;
  if (objective.flowtime_weight == 0) return round.cost.makespan_s;
  const double makespan_gain_s = std::max(round.cost.makespan_s - least_makespan_s, 0.0);
  return left_s + objective.makespan_weight / objective.flowtime_weight * makespan_gain_s +
         kArrivalToleranceS;
}

}  // namespace

PlanCost cost_of(const Instance& instance, const PartialPlan& plan) {
  PlanCost cost;
  for (AgentIndex agent = 0; agent < instance.agents.size(); ++agent) {
    const double arrival_s = plan.trajectory(agent).arrival_s();
    cost.flowtime_s += arrival_s;
    cost.makespan_s = std::max(cost.makespan_s, arrival_s);
  }
  return cost;
}

Attempt try_neighbourhood(const Round& round, PartialPlan& plan, Random random) {
  Attempt attempt;
  attempt.rule = static_cast<RemovalRule>(round.roulette.draw(random));
  const std::size_t most = kFewestRemoved + random.below(kMostRemoved - kFewestRemoved + 1);
  attempt.robots = choose_neighbourhood(
      attempt.rule, {round.instance, plan, round.fastest_s, round.fastest_paths}, most, random);
  random.shuffle(attempt.robots);

  Removal removal(attempt.robots, plan);
  for (std::size_t i = 0; i < attempt.robots.size(); ++i) {
    SearchLimits limits = round.limits;
    limits.latest_arrival_s = latest_arrival_s(round, plan, attempt.robots, removal, i);
    Expected<Trajectory, PlanFailure> found = plan.find(attempt.robots[i], limits, attempt.work);
    if (!found) {
      attempt.was_cut_short = found.error() != PlanFailure::kNoPath;
      break;
    }
    plan.insert(attempt.robots[i], *found);
    attempt.found.push_back(std::move(*found));
  }
  if (attempt.found.size() == attempt.robots.size()) {
    const PlanCost cost = cost_of(round.instance, plan);
    attempt.is_better = is_better(round.objective, cost, round.cost);
    const auto value = [&](const PlanCost& of) { return round.objective.of(of.flowtime_s, of.makespan_s); };
    if (attempt.is_better) attempt.gain = value(round.cost) - value(cost);
  }
  removal.put_back(attempt.found.size());
  return attempt;
}

bool take_over(const Round& round, const Attempt& attempt, const std::vector<AgentIndex>& changed,
               PartialPlan& plan, PlanCost& cost) {
  PLANNER_ASSERT(attempt.is_better);
  Removal removal(attempt.robots, plan);
  std::size_t entered = 0;
  const auto fits = [&](AgentIndex other) {
    return plan.still_fits(attempt.robots[entered], attempt.found[entered], other);
  };
  while (entered < attempt.robots.size() && std::all_of(changed.begin(), changed.end(), fits)) {
    plan.insert(attempt.robots[entered], attempt.found[entered]);
    ++entered;
  }
  if (entered == attempt.robots.size()) {
    const PlanCost now = cost_of(round.instance, plan);
    if (is_better(round.objective, now, cost)) {
      cost = now;
      return true;
    }
  }
  removal.put_back(entered);
  return false;
}

}  // namespace sipplab
