#include "planner/prioritized/partial_plan.hpp"

#include <algorithm>
#include <numeric>
#include <utility>

#include "planner/prioritized/conflict.hpp"
#include "sipplab/error.hpp"

namespace sipplab {

PartialPlan::PartialPlan(const Instance& instance, double ssi_s, SingleAgentPlanner& planner)
    : instance_(instance),
      planner_(planner),
      reservations_(instance.map, askers_of(instance)),
      starts_(instance, ssi_s, reservations_),
      precedence_(instance, ssi_s),
      trajectories_(instance.agents.size()),
      disks_(instance.agents.size()),
      inserted_(instance.agents.size()) {
  for (const DynamicObstacle& obstacle : instance.obstacles) {
    reservations_.add(obstacle.trajectory, obstacle.radius_cells);
  }
  for (AgentIndex agent = 0; agent < instance.agents.size(); ++agent) starts_.protect(agent);
}

Expected<Trajectory, PlanFailure> PartialPlan::find(AgentIndex agent, const SearchLimits& limits,
                                                    SearchStatistics& statistics) {
  PLANNER_ASSERT(!is_planned(agent));
  const std::vector<AgentIndex>& followers = precedence_.followers(agent);
  for (const AgentIndex follower : followers) starts_.protect(follower);
  starts_.begin(agent);
  Expected<Trajectory, PlanFailure> trajectory = planner_.plan(agent, reservations_, limits, statistics);
  starts_.end();
  starts_.protect(agent);
  for (const AgentIndex follower : followers) {
    if (is_planned(follower)) starts_.lift(follower);
  }
  return trajectory;
}

void PartialPlan::insert(AgentIndex agent, Trajectory trajectory) {
  enter(agent, std::move(trajectory), ++insertions_);
}

void PartialPlan::put_back(Taken taken) { enter(taken.agent, std::move(taken.trajectory), taken.inserted); }

void PartialPlan::enter(AgentIndex agent, Trajectory trajectory, std::uint64_t inserted) {
  PLANNER_ASSERT(!is_planned(agent));
  starts_.lift(agent);
  disks_[agent] = reservations_.add(trajectory, instance_.agents[agent].radius_cells);
  precedence_.set(agent, trajectory);
  trajectories_[agent] = std::move(trajectory);
  inserted_[agent] = inserted;
  ++planned_;
}

PartialPlan::Taken PartialPlan::take_out(AgentIndex agent) {
  PLANNER_ASSERT(is_planned(agent));
  for (const ReservationTable::DiskId disk : disks_[agent]) reservations_.remove(disk);
  precedence_.reset(agent);
  starts_.protect(agent);
  --planned_;
  Taken taken{agent, std::move(*trajectories_[agent]), inserted_[agent]};
  trajectories_[agent].reset();
  return taken;
}

bool PartialPlan::are_in_conflict(AgentIndex agent, const Trajectory& trajectory, AgentIndex other) const {
  return sipplab::are_in_conflict(instance_.agents[agent], trajectory, instance_.agents[other].radius_cells,
                                  *trajectories_[other]);
}

std::vector<AgentIndex> PartialPlan::conflicts(AgentIndex agent, const Trajectory& trajectory) const {
  std::vector<AgentIndex> found;
  for (AgentIndex other = 0; other < trajectories_.size(); ++other) {
    if (other == agent || !is_planned(other)) continue;
    if (are_in_conflict(agent, trajectory, other)) found.push_back(other);
  }
  return found;
}

bool PartialPlan::still_fits(AgentIndex agent, const Trajectory& trajectory, AgentIndex other) {
  return !are_in_conflict(agent, trajectory, other) && keeps_guarantee(agent, trajectory);
}

Solution PartialPlan::solution() const {
  PLANNER_ASSERT(planned_ == trajectories_.size());
  Solution solution;
  for (const std::optional<Trajectory>& trajectory : trajectories_) {
    solution.trajectories.push_back(*trajectory);
  }
  return solution;
}

std::optional<PriorityOrder> PartialPlan::order() const {
  PriorityOrder preferred(trajectories_.size());
  std::iota(preferred.begin(), preferred.end(), AgentIndex{0});
  std::stable_sort(preferred.begin(), preferred.end(),
                   [this](AgentIndex a, AgentIndex b) { return inserted_[a] < inserted_[b]; });
  return precedence_.order(preferred);
}

}  // namespace sipplab
