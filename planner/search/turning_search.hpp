// SIPP and AA-SIPP for one robot that has a heading, stands before it moves, or keeps more
// room than its body needs. Follows [YA17], section 3, on (x, y, heading).
#pragma once

#include <vector>

#include "planner/instance/motion_rules.hpp"
#include "planner/search/body.hpp"
#include "planner/search/open_list.hpp"
#include "planner/search/single_agent_planner.hpp"
#include "planner/search/sipp_node.hpp"

namespace sipplab {

struct TurningOptions {
  /// Try to reach each successor straight from the parent of the expanded state as well.
  bool any_angle = true;
  /// 2^k neighbours, k = 2..5.
  int connectedness = 2;
  MotionRules rules;
  double weight = 1;    ///< of the heuristic, as in SippOptions
  bool detours = true;  ///< as in SippOptions
};

/// A state is a cell, one of its safe intervals, the heading of arrival and the time of
/// arrival. States of one cell and interval are kept side by side: (heading a, time s)
/// dominates (heading b, time t) only where s plus the turn from a to b is at most t, for
/// then the robot can turn in place and be at least as well off. An earlier arrival with
/// another heading by itself does not.
///
/// Differs from the published AA-SIPP(m): departures are exact, not tried in steps; the
/// straight way to the goal is tried from each expanded state; OPEN is ordered by a bound
/// that knows of turns and delays.
class TurningSearch final : public SingleAgentPlanner {
 public:
  /// The instance must outlive the search. REQUIRES: !find_error(instance).
  TurningSearch(const Instance& instance, TurningOptions options);

  /// Turns are motions of their own in the trajectory, each right after the arrival; the
  /// last one is to the goal heading, and the robot has arrived when it is done.
  Expected<Trajectory, PlanFailure> plan(AgentIndex agent, ReservationTable& reservations,
                                         const SearchLimits& limits, SearchStatistics& statistics) override;

  /// Of travelling, turning and standing, as if the robot were alone on an empty map.
  double lower_bound_s(AgentIndex agent) const override;

 private:
  struct State {
    Cell cell;
    double heading_deg = 0;
    double arrival_s = 0;
    double departure_s = 0;  ///< when the parent is left to arrive then
    NodeId parent = kNoNode;
    NodeId next = kNoNode;  ///< among the states of the same stay
    double stay_end_s = 0;  ///< of the safe interval
    bool dominated = false;
  };
  /// A safe interval of a cell, and the states in it that no other one dominates.
  struct Stay {
    SafeInterval interval;
    NodeId first = kNoNode;
  };
  /// The stays of one cell, consecutive. Laid out when a search first comes to the cell.
  struct CellStays {
    std::uint32_t search = 0;  ///< number of the search that laid them out
    std::uint32_t first = 0;
    std::uint32_t last = 0;  ///< one past
  };
  void begin(const Agent& agent, ReservationTable& reservations);
  CellStays stays_of(Cell cell);
  double turn_s(double from_deg, double to_deg) const;
  /// At most what a way by steps from here to the end of the plan takes; not weighted.
  double to_goal_s(Cell cell, double heading_deg);
  bool is_goal(const State& state) const;

  void expand(NodeId id, SearchStatistics& statistics);
  /// Adds states of `cell` that are reached straight from state `from`.
  void reach(NodeId from, Cell cell, SearchStatistics& statistics);
  /// Adds the goal, reached straight and without delay from state `from`, where that is safe.
  void shoot(NodeId from, SearchStatistics& statistics);
  /// The same for one stay, departing at `latest_departure_s` or before.
  void reach(NodeId from, Cell cell, std::uint32_t stay, double latest_departure_s,
             SearchStatistics& statistics);
  bool is_dominated(const Stay& stay, double heading_deg, double arrival_s) const;
  /// Takes the states out of the stay that the new one dominates, and puts it in.
  void add(Stay& stay, const State& state);
  Trajectory reconstruct(NodeId goal) const;

  const Instance& instance_;
  TurningOptions options_;
  Bodies bodies_;

  // The search under way.
  const Agent* agent_ = nullptr;
  Body* body_ = nullptr;
  ReservationTable* reservations_ = nullptr;
  std::uint32_t search_ = 0;
  std::vector<CellStays> cell_stays_;
  std::vector<Stay> stays_;
  std::vector<State> states_;
  Arena arena_;
  OpenList open_{arena_};
};

}  // namespace sipplab
