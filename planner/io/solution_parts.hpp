// What the readers of the solution formats share.
#pragma once

#include <cstddef>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "sipplab/solution_io.hpp"

namespace sipplab {

/// A writer that can tell every solution.
template <std::string (*write)(const Instance&, const SolutionDocument&)>
Expected<std::string, std::string> always(const Instance& instance, const SolutionDocument& document) {
  return write(instance, document);
}

/// Puts trajectories in the order of the instance's agents. They are told by id;
/// by position where ids repeat or are left out.
class TrajectoryCollector {
 public:
  explicit TrajectoryCollector(const Instance& instance);

  /// Empty when the trajectory was taken, else what is wrong: no such agent, or one that has a trajectory
  /// already. It begins at `stated_start`, else where its first motion does; a robot without either stays at
  /// its start.
  std::string add(const std::optional<std::string>& id, std::size_t position, Trajectory trajectory,
                  const std::optional<Cell>& stated_start);
  /// The first agent without a trajectory, if there is one.
  std::optional<AgentIndex> missing() const;
  Solution take() { return Solution{std::move(trajectories_)}; }

 private:
  const Instance& instance_;
  std::map<std::string, AgentIndex> agent_of_id_;
  bool ids_repeat_ = false;
  std::vector<Trajectory> trajectories_;
  std::vector<bool> taken_;
};

}  // namespace sipplab
