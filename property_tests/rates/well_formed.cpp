// A breadth-first search per robot; see well_formed.hpp.
#include "property_tests/rates/well_formed.hpp"

#include <algorithm>
#include <array>
#include <queue>
#include <vector>

#include "planner/core/tolerances.hpp"
#include "planner/instance/reachability.hpp"

namespace sipplab {
namespace {

/// Distance of a place to a straight move between cells.
double to_move(Cell from, Cell to, Vec2 place) {
  const Vec2 path = centre(to) - centre(from);
  const Vec2 apart = place - centre(from);
  const double whole = squared_norm(path);
  const double part = whole > 0 ? std::clamp(dot(apart, path) / whole, 0.0, 1.0) : 0.0;
  return norm(apart - path * part);
}

/// Whether the robot's body keeps clear of the others' starts and goals on a move.
bool is_clear(const Instance& instance, AgentIndex agent, Cell from, Cell to) {
  for (AgentIndex other = 0; other < instance.agents.size(); ++other) {
    if (other == agent) continue;
    const Agent& body = instance.agents[other];
    const double contact_cells = instance.agents[agent].radius_cells + body.radius_cells;
    const double nearest_cells =
        std::min(to_move(from, to, centre(body.start)), to_move(from, to, centre(body.goal)));
    if (nearest_cells < contact_cells - kTouchDepthCells) return false;
  }
  return true;
}

bool has_clear_path(const Instance& instance, AgentIndex agent) {
  const GridMap& map = instance.map;
  const Agent& robot = instance.agents[agent];
  if (!is_clear(instance, agent, robot.start, robot.start)) return false;
  const std::vector<std::uint32_t> standing = standing_components(map, robot.radius_cells);
  std::vector<bool> seen(map.cell_count(), false);
  std::queue<Cell> waiting;
  waiting.push(robot.start);
  seen[map.index(robot.start)] = true;
  while (!waiting.empty()) {
    const Cell cell = waiting.front();
    waiting.pop();
    if (cell == robot.goal) return true;
    constexpr std::array<Cell, 4> kSteps = {Cell{1, 0}, Cell{0, 1}, Cell{-1, 0}, Cell{0, -1}};
    for (const Cell step : kSteps) {
      const Cell next{cell.x + step.x, cell.y + step.y};
      if (!map.contains(next) || seen[map.index(next)] || standing[map.index(next)] == 0) continue;
      if (!is_clear(instance, agent, cell, next)) continue;
      seen[map.index(next)] = true;
      waiting.push(next);
    }
  }
  return false;
}

}  // namespace

bool is_well_formed(const Instance& instance) {
  if (!instance.obstacles.empty()) return false;
  for (AgentIndex i = 0; i < instance.agents.size(); ++i) {
    if (!has_clear_path(instance, i)) return false;
  }
  return true;
}

}  // namespace sipplab
