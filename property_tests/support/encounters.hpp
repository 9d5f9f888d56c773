// Robots and obstacles that meet, drawn from lattices on which contact is common:
// cell centres, times in eighths of a second, radii and speeds such as 1/2, 1 and 2.
#pragma once

#include <rapidcheck.h>

#include <cstdint>
#include <initializer_list>
#include <iosfwd>
#include <utility>
#include <vector>

#include "planner/geometry/moving_disk.hpp"
#include "sipplab/grid_map.hpp"
#include "sipplab/solution.hpp"

namespace sipplab {

/// One of the values, simpler ones first: failures shrink towards the front.
template <class Value>
rc::Gen<Value> any_of(std::initializer_list<Value> values) {
  const std::vector<Value> all(values);
  return rc::gen::map(rc::gen::inRange<std::size_t>(0, all.size()),
                      [all](std::size_t index) { return all[index]; });
}

/// (column, row).
std::ostream& operator<<(std::ostream& out, Cell cell);

/// Columns 0 .. width - 1, rows 0 .. height - 1.
rc::Gen<Cell> any_cell(std::int32_t width, std::int32_t height);
/// From very small to several cells, 1/2 above all.
rc::Gen<double> any_radius();
/// 1 above all; up to twice as fast and down to a quarter.
rc::Gen<double> any_speed();
/// k/8 seconds, k = 0 .. 8 * limit.
rc::Gen<double> any_eighths(int limit);

/// A move and one obstacle, moving or at rest.
struct Encounter {
  Cell from;  ///< the mover's; differs from `to`
  Cell to;
  double speed = 1;
  double radius = 0.5;
  Cell obstacle_from;
  Cell obstacle_to;  ///< the same as obstacle_from: it rests for rest_s
  double obstacle_speed = 1;
  double obstacle_radius = 0.5;
  double begin_s = 0;  ///< when the obstacle begins to move or to rest
  double rest_s = 1;   ///< may be kForever

  Move move() const;
  MovingDisk obstacle() const;
  double reach() const { return radius + obstacle_radius; }
};
std::ostream& operator<<(std::ostream& out, const Encounter& encounter);

/// On maps of up to 60 cells a side, at times up to 1e4 s, with speeds from 1e-3.
rc::Gen<Encounter> any_encounter();
rc::Gen<std::vector<Encounter>> any_encounters();

/// An obstacle's walk: straight motions, each at its own speed, and waits.
struct Walk {
  struct Step {
    Cell to;                ///< where the walk is already: wait
    double speed = 1;       ///< of a motion
    double wait_s = 0.125;  ///< of a wait
  };
  Cell start;
  std::vector<Step> steps;
  double begin_s = 0;  ///< stands at its start before
  double radius = 0.5;

  Trajectory trajectory() const;
};
std::ostream& operator<<(std::ostream& out, const Walk& walk);

/// Within the columns and rows given.
rc::Gen<Walk> any_walk(std::int32_t width, std::int32_t height);

/// The motions of a trajectory and the rest at its end, as disks.
std::vector<MovingDisk> disks_of(const Trajectory& trajectory, double radius);

}  // namespace sipplab
