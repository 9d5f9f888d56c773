// What a search knows of a robot's radius alone, on one map.
#pragma once

#include <map>

#include "planner/grid/line_of_sight.hpp"
#include "planner/grid/step_table.hpp"
#include "planner/instance/instance.hpp"

namespace sipplab {

struct Body {
  Body(const GridMap& map, double radius_cells, int connectedness)
      : line_of_sight(map, radius_cells), steps(line_of_sight, map.cell_count(), connectedness) {}
  Body(const Body&) = delete;  // its table knows where its line of sight is
  Body& operator=(const Body&) = delete;

  LineOfSight line_of_sight;
  StepTable steps;
};

/// By radius.
using Bodies = std::map<double, Body>;

/// One for each radius of the instance, which must outlive them. O(radii * cells).
inline Bodies bodies_of(const Instance& instance, int connectedness) {
  Bodies bodies;
  for (const Agent& agent : instance.agents) {
    bodies.try_emplace(agent.radius_cells, instance.map, agent.radius_cells, connectedness);
  }
  return bodies;
}

}  // namespace sipplab
