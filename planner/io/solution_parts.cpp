// What readers of several formats share; see solution_parts.hpp.
#include "planner/io/solution_parts.hpp"

#include "planner/io/text.hpp"

namespace sipplab {

TrajectoryCollector::TrajectoryCollector(const Instance& instance)
    : instance_(instance), trajectories_(instance.agents.size()), taken_(instance.agents.size(), false) {
  for (AgentIndex i = 0; i < instance.agents.size(); ++i) {
    trajectories_[i].start = instance.agents[i].start;
    if (!agent_of_id_.emplace(instance.agents[i].id, i).second) ids_repeat_ = true;
  }
}

std::string TrajectoryCollector::add(const std::optional<std::string>& id, std::size_t position,
                                     Trajectory trajectory, const std::optional<Cell>& stated_start) {
  AgentIndex agent = position;
  if (id && !ids_repeat_) {
    const auto found = agent_of_id_.find(*id);
    if (found == agent_of_id_.end()) return "robot " + in_quotes(*id) + " that the instance does not have";
    agent = found->second;
  } else if (position >= trajectories_.size()) {
    return "trajectory " + std::to_string(position) + " for an instance of " +
           std::to_string(trajectories_.size()) + " robots";
  } else if (id && *id != instance_.agents[position].id) {
    return "robot " + in_quotes(*id) + " where the instance has " + in_quotes(instance_.agents[position].id);
  }
  if (taken_[agent]) return "a second trajectory of robot " + in_quotes(instance_.agents[agent].id);
  taken_[agent] = true;
  const Cell begin =
      trajectory.motions.empty() ? instance_.agents[agent].start : trajectory.motions.front().from;
  trajectory.start = stated_start.value_or(begin);
  trajectories_[agent] = std::move(trajectory);
  return {};
}

std::optional<AgentIndex> TrajectoryCollector::missing() const {
  for (AgentIndex i = 0; i < taken_.size(); ++i) {
    if (!taken_[i]) return i;
  }
  return std::nullopt;
}

}  // namespace sipplab
