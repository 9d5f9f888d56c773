// Symmetric scenes; see symmetry.hpp.
#include "property_tests/support/symmetry.hpp"

#include <cmath>

namespace sipplab {
namespace {

/// 0 to less than 360 again.
double wrapped(double heading_deg) {
  const double degrees = std::fmod(heading_deg, 360);
  return degrees < 0 ? degrees + 360 : degrees;
}

template <class MapCell, class MapHeading>
void move_cells(Trajectory& trajectory, const MapCell& map_cell, const MapHeading& map_heading) {
  trajectory.start = map_cell(trajectory.start);
  for (TimedMotion& motion : trajectory.motions) {
    motion.from = map_cell(motion.from);
    motion.to = map_cell(motion.to);
    if (motion.turn_to_deg) motion.turn_to_deg = map_heading(*motion.turn_to_deg);
  }
}

template <class MapCell, class MapHeading>
Scene moved(const Scene& scene, GridMap map, const MapCell& map_cell, const MapHeading& map_heading) {
  for (std::size_t i = 0; i < scene.instance.map.cell_count(); ++i) {
    const Cell cell = scene.instance.map.cell(i);
    map.set_blocked(map_cell(cell), scene.instance.map.is_blocked(cell));
  }
  Scene result = scene;
  result.instance.map = map;
  for (Agent& agent : result.instance.agents) {
    agent.start = map_cell(agent.start);
    agent.goal = map_cell(agent.goal);
    agent.start_heading_deg = map_heading(agent.start_heading_deg);
    if (agent.goal_heading_deg) agent.goal_heading_deg = map_heading(*agent.goal_heading_deg);
  }
  for (DynamicObstacle& obstacle : result.instance.obstacles) {
    move_cells(obstacle.trajectory, map_cell, map_heading);
  }
  for (Trajectory& trajectory : result.solution.trajectories) {
    move_cells(trajectory, map_cell, map_heading);
  }
  return result;
}

void slow(Trajectory& trajectory, double factor) {
  for (TimedMotion& motion : trajectory.motions) {
    motion.begin_s *= factor;
    motion.end_s *= factor;
  }
}

}  // namespace

Scene rotated(const Scene& scene) {
  const GridMap& map = scene.instance.map;
  return moved(
      scene, GridMap(map.height(), map.width()),
      [&](Cell cell) {
        return Cell{map.height() - 1 - cell.y, cell.x};
      },
      [](double heading_deg) { return wrapped(heading_deg - 90); });
}

Scene reflected(const Scene& scene) {
  const GridMap& map = scene.instance.map;
  return moved(
      scene, GridMap(map.width(), map.height()),
      [&](Cell cell) {
        return Cell{map.width() - 1 - cell.x, cell.y};
      },
      [](double heading_deg) { return wrapped(180 - heading_deg); });
}

Scene slowed(const Scene& scene, double factor) {
  Scene result = scene;
  for (Agent& agent : result.instance.agents) {
    agent.speed_cells_per_s /= factor;
    agent.rotation_speed /= factor;
  }
  for (DynamicObstacle& obstacle : result.instance.obstacles) slow(obstacle.trajectory, factor);
  for (Trajectory& trajectory : result.solution.trajectories) slow(trajectory, factor);
  return result;
}

Scene without_agent(const Scene& scene, AgentIndex agent) {
  Scene result = scene;
  const auto offset = static_cast<std::ptrdiff_t>(agent);
  result.instance.agents.erase(result.instance.agents.begin() + offset);
  if (agent < result.solution.trajectories.size()) {
    result.solution.trajectories.erase(result.solution.trajectories.begin() + offset);
  }
  return result;
}

std::vector<AgentIndex> without_agent(const std::vector<AgentIndex>& order, AgentIndex agent) {
  std::vector<AgentIndex> rest;
  for (const AgentIndex other : order) {
    if (other != agent) rest.push_back(other > agent ? other - 1 : other);
  }
  return rest;
}

}  // namespace sipplab
