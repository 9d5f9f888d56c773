// A plan under construction or under repair: some robots have trajectories, the others
// wait to be planned around them.
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "planner/prioritized/priority_order.hpp"
#include "planner/prioritized/start_guard.hpp"
#include "planner/prioritized/start_precedence.hpp"
#include "planner/reservation/reservation_table.hpp"
#include "sipplab/instance.hpp"
#include "sipplab/single_agent_planner.hpp"
#include "sipplab/solution.hpp"

namespace sipplab {

/// Robots enter and leave it in any sequence. Its trajectories are free of conflicts. As long as each comes
/// from find(), some order keeps the guarantee of start-safe intervals: see StartPrecedence.
class PartialPlan {
 public:
  /// No robot is planned yet. Instance and planner must outlive it.
  /// REQUIRES: !find_error(instance), ssi_s >= 0.
  PartialPlan(const Instance& instance, double ssi_s, SingleAgentPlanner& planner);

  /// A trajectory for a robot that is not planned: around all planned ones, off the starts of the others, and
  /// off the starts of those that must come after it in the order.
  Expected<Trajectory, PlanFailure> find(AgentIndex agent, const SearchLimits& limits,
                                         SearchStatistics& statistics);

  /// REQUIRES: the robot is not planned; the trajectory is in conflict with none.
  void insert(AgentIndex agent, Trajectory trajectory);
  /// What take_out() took, to be put back as it was.
  struct Taken {
    AgentIndex agent;
    Trajectory trajectory;
    std::uint64_t inserted;
  };
  /// REQUIRES: the robot is planned.
  Taken take_out(AgentIndex agent);
  /// REQUIRES: the robot is not planned; its trajectory is in conflict with none.
  void put_back(Taken taken);

  bool is_planned(AgentIndex agent) const { return trajectories_[agent].has_value(); }
  /// REQUIRES: the robot is planned.
  const Trajectory& trajectory(AgentIndex agent) const { return *trajectories_[agent]; }
  std::size_t planned() const { return planned_; }
  /// Planned robots whose trajectories are in conflict with this one, in input order.
  std::vector<AgentIndex> conflicts(AgentIndex agent, const Trajectory& trajectory) const;

  /// Whether the guarantee of start-safe intervals could still be kept with this trajectory.
  /// REQUIRES: the robot is not planned.
  bool keeps_guarantee(AgentIndex agent, const Trajectory& trajectory) {
    return !precedence_.closes_cycle(agent, trajectory);
  }
  /// Whether a trajectory found while `other` was not planned may still be inserted now that it is.
  /// REQUIRES: `agent` is not planned, `other` is.
  bool still_fits(AgentIndex agent, const Trajectory& trajectory, AgentIndex other);

  /// REQUIRES: all robots are planned.
  Solution solution() const;
  /// A final order of all robots that keeps the guarantee, near the sequence in which they were inserted
  /// last; none if there is no such order.
  std::optional<PriorityOrder> order() const;

 private:
  void enter(AgentIndex agent, Trajectory trajectory, std::uint64_t inserted);
  bool are_in_conflict(AgentIndex agent, const Trajectory& trajectory, AgentIndex other) const;

  const Instance& instance_;
  SingleAgentPlanner& planner_;
  ReservationTable reservations_;
  StartGuard starts_;
  StartPrecedence precedence_;
  std::vector<std::optional<Trajectory>> trajectories_;
  std::vector<std::vector<ReservationTable::DiskId>> disks_;  ///< by robot: its trajectory's
  std::vector<std::uint64_t> inserted_;                       ///< by robot: when, counted in insertions
  std::uint64_t insertions_ = 0;
  std::size_t planned_ = 0;
};

}  // namespace sipplab
