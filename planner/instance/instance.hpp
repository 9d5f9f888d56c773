// A problem: a map, the agents on it, and obstacles that move on their own. Read this file first: everything
// else refers to an Instance.
#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "planner/core/expected.hpp"
#include "planner/grid/grid_map.hpp"
#include "planner/instance/agent.hpp"
#include "planner/solution/trajectory.hpp"

namespace sipplab {

/// Position of an agent in Instance::agents.
using AgentIndex = std::size_t;

/// A disk with a given trajectory that gives way to no robot. After its last motion it
/// rests for ever. It may stand on blocked cells.
struct DynamicObstacle {
  std::string id;
  double radius_cells = kDefaultRadiusCells;
  Trajectory trajectory;

  friend bool operator==(const DynamicObstacle&, const DynamicObstacle&) = default;
};

struct Instance {
  GridMap map;
  std::vector<Agent> agents;
  std::vector<DynamicObstacle> obstacles;

  friend bool operator==(const Instance&, const Instance&) = default;
};

/// Of all agents; 0 if there are none.
double largest_radius_cells(const Instance& instance);

/// Why an instance is not valid.
struct InstanceError {
  std::optional<AgentIndex> agent;  ///< the later one if two are at odds
  std::optional<std::size_t> obstacle;
  std::string what;      ///< "agent 3: start (4, 7) is blocked"
  std::string expected;  ///< "a free cell"
};

/// The first rule that the instance breaks, agents in input order: every number
/// finite and in range; the body on free cells inside the grid at start and goal;
/// no two starts in collision, no two goals in collision; obstacles' trajectories
/// contiguous, and none on a start at time 0. O(agents + cells near them).
std::optional<InstanceError> find_error(const Instance& instance);

/// 32 hexadecimal digits over map, agents and obstacles (not over ids): equal
/// for equal problems, whatever file they came from (XXH3, 128 bits).
std::string content_hash(const Instance& instance);

}  // namespace sipplab
