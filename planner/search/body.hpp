// What a search knows about robots of one radius on one map.
#pragma once

#include <algorithm>
#include <cstdint>
#include <map>

#include "planner/grid/line_of_sight.hpp"
#include "planner/grid/neighbourhood.hpp"
#include "planner/grid/static_distances.hpp"
#include "planner/grid/step_table.hpp"
#include "sipplab/instance.hpp"

namespace sipplab {

/// Which moves and bounds a search uses.
struct BodyOptions {
  bool any_angle = true;
  int connectedness = 2;         ///< 2^k neighbours
  bool static_distances = true;  ///< whether excess_cells() is used
};

class Body {
 public:
  /// The map must outlive the body. O(cells).
  Body(const GridMap& map, double radius_cells, BodyOptions options)
      : line_of_sight(map, radius_cells),
        own_steps_(static_cast<std::uint32_t>(
            (std::uint64_t{1} << neighbourhood(options.connectedness).size()) - 1)),
        steps_(line_of_sight, map.cell_count(), static_connectedness(options)),
        distances_(map, line_of_sight, steps_, static_connectedness(options)),
        connectedness_(options.connectedness),
        static_connectedness_(static_connectedness(options)) {}
  Body(const Body&) = delete;  // its parts refer to each other
  Body& operator=(const Body&) = delete;

  /// Bit i is set if step i of the neighbourhood leads to a legal cell in line of sight. REQUIRES: the cell
  /// is legal; `index` is its row-major index.
  std::uint32_t clear_steps(Cell cell, std::size_t index) {
    return steps_.clear_steps(cell, index) & own_steps_;
  }

  /// See StaticDistances.
  void set_goal(Cell goal, Cell towards) { distances_.set_goal(goal, towards); }
  Cell turning_point(Cell cell) { return distances_.turning_point(cell); }

  /// What the map's obstacles add to the robot's path from the cell to its goal, in cells. Straight distance
  /// plus the excess never exceeds the shortest path by steps. REQUIRES: options.static_distances.
  double excess_cells(Cell cell) { return distances_.excess_cells(cell); }

  /// A lower bound on the path by steps from the cell to the goal, in cells. `excess` is excess_cells(cell).
  double least_steps_cells(Cell cell, Cell goal, double excess) const {
    return std::max(neighbourhood_distance(cell, goal, connectedness_),
                    neighbourhood_distance(cell, goal, static_connectedness_) + excess);
  }

  const LineOfSight line_of_sight;

 private:
  static constexpr int kOctile = 3;
  /// Octile paths are closer to any-angle paths than Manhattan ones, and never longer.
  static int static_connectedness(BodyOptions options) {
    return options.any_angle && options.static_distances ? std::max(options.connectedness, kOctile)
                                                         : options.connectedness;
  }

  std::uint32_t own_steps_;
  StepTable steps_;  ///< of own_steps_, and more if octile distances need them
  StaticDistances distances_;
  int connectedness_;
  int static_connectedness_;  ///< of distances_
};

/// By radius.
using Bodies = std::map<double, Body>;

/// One for each radius of the instance, which must outlive them. O(radii * cells).
inline Bodies bodies_of(const Instance& instance, BodyOptions options) {
  Bodies bodies;
  for (const Agent& agent : instance.agents) {
    bodies.try_emplace(agent.radius_cells, instance.map, agent.radius_cells, options);
  }
  return bodies;
}

}  // namespace sipplab
