// One iteration of large neighbourhood search, tried on a plan that is restored afterwards.
#pragma once

#include <cstdint>
#include <vector>

#include "planner/improve/neighbourhoods.hpp"
#include "planner/improve/objective.hpp"
#include "planner/prioritized/partial_plan.hpp"

namespace sipplab {

/// What an attempt depends on besides the plan.
struct Round {
  const Instance& instance;
  const Objective& objective;
  const RuleRoulette& roulette;
  const std::vector<double>& fastest_s;          ///< by robot: arrivals on fastest_paths
  const std::vector<Trajectory>& fastest_paths;  ///< by robot, alone on the map
  PlanCost cost;                                 ///< of the plan
  SearchLimits limits;
};

/// Some robots, planned again in this order.
struct Attempt {
  RemovalRule rule = RemovalRule::kRandom;
  std::vector<AgentIndex> robots;
  std::vector<Trajectory> found;  ///< by position in `robots`; fewer if one found no path
  double gain = 0;                ///< by which the objective falls; 0 if it does not
  bool is_better = false;         ///< all found a path, and the plan is better with these
  bool was_cut_short = false;     ///< by a limit: its outcome is unknown
  std::uint64_t seen = 0;         ///< attempts that were settled before it
  SearchStatistics work;
};

PlanCost cost_of(const Instance& instance, const PartialPlan& plan);

/// Destroys the paths of some robots, repairs them, and restores the plan. The same plan, round
/// and random numbers give the same attempt. REQUIRES: all robots are planned.
Attempt try_neighbourhood(const Round& round, PartialPlan& plan, Random random);

/// Puts the trajectories of an attempt into a plan of cost `cost`, and updates the cost, if they
/// fit those of the robots in `changed`, which came in after the attempt was made, and if the
/// plan becomes better. Otherwise the plan stays as it was and the answer is false.
/// REQUIRES: attempt.is_better; none of its robots is in `changed`.
bool take_over(const Round& round, const Attempt& attempt, const std::vector<AgentIndex>& changed,
               PartialPlan& plan, PlanCost& cost);

}  // namespace sipplab
