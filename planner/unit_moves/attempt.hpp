// One iteration of large neighbourhood search: a few robots planned again by unit moves around all others.
#pragma once

#include <cstdint>
#include <vector>

#include "planner/core/roulette.hpp"
#include "planner/unit_moves/neighbourhoods.hpp"
#include "planner/unit_moves/route_search.hpp"
#include "planner/unit_moves/timetable.hpp"
#include "sipplab/improve.hpp"
#include "sipplab/single_agent_planner.hpp"

namespace sipplab {

/// How many robots at most are planned again at once.
inline constexpr std::size_t kUnitSizes[] = {1, 2, 4, 8, 16};
/// A rule and a size.
inline constexpr std::size_t kUnitWays = kUnitRules * std::size(kUnitSizes);

/// What a plan costs, in ticks.
struct UnitCost {
  std::int64_t flowtime = 0;
  Tick makespan = 0;
};

/// What an attempt depends on besides the plan.
struct UnitRound {
  const Objective& objective;
  const Roulette<kUnitWays>& paths;
  UnitCost cost;     ///< of the plan
  double worst = 0;  ///< what a plan may cost by the objective, in ticks
};

/// Some robots, planned again in this order.
struct UnitAttempt {
  std::size_t path = 0;
  std::vector<RobotId> robots;
  std::vector<Route> found;    ///< by position in `robots`; fewer if one found no route
  bool is_accepted = false;    ///< all found a route, and the plan is good enough with these
  double gain = 0;             ///< by which the objective falls, in ticks; not below 0
  bool was_cut_short = false;  ///< by a limit: there is nothing else
  SearchStatistics work;
};

/// A plan, and what one thread needs to try changes of it.
class UnitWorker {
 public:
  /// All must outlive this.
  UnitWorker(const UnitMoves& moves, SharedDistances& distances, const std::vector<Route>& plan);

  const Timetable& plan() const { return plan_; }
  UnitCost cost() const;

  /// Plans some robots again, and restores the plan. The same plan, round and random numbers give the same
  /// attempt. REQUIRES: there are robots.
  UnitAttempt attempt(const UnitRound& round, Random random);

  /// Puts the routes of an attempt into the plan, if they fit it and the plan costs no more than
  /// `round.worst` with them; then `cost`, which is its cost, is updated and the routes before are the
  /// answer. Otherwise the plan stays as it was and the answer is empty. REQUIRES: attempt.is_accepted.
  std::vector<Route> take_over(const UnitRound& round, const UnitAttempt& attempt, UnitCost& cost);

  /// Gives robots other routes. REQUIRES: all fit together.
  void replace(const std::vector<RobotId>& robots, const std::vector<Route>& routes);

 private:
  UnitCost cost_with(const UnitCost& cost, const UnitAttempt& attempt,
                     const std::vector<Route>& before) const;
  Tick latest_of_others() const;
  void plan_again(const UnitRound& round, const std::vector<Route>& before, UnitAttempt& attempt);
  std::vector<Route> remove(const std::vector<RobotId>& robots);
  void put_back(const UnitAttempt& attempt, std::size_t entered, std::vector<Route> before);

  SharedDistances& distances_;
  Timetable plan_;
  RouteSearch search_;
  UnitNeighbourhoods neighbourhoods_;
};

double value(const Objective& objective, const UnitCost& cost);

/// Whether one is strictly better than the other.
bool is_better(const Objective& objective, const UnitCost& one, const UnitCost& other);

}  // namespace sipplab
