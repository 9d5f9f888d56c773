// Earliest arrival of one robot on a 2^k neighbourhood among disks with known ways: a
// slow search in which every time comes from bisection. Shares nothing with
// planner/reservation and planner/search.
#pragma once

#include <optional>
#include <vector>

#include "planner/geometry/moving_disk.hpp"
#include "planner/grid/grid_map.hpp"
#include "property_tests/support/exact_line_of_sight.hpp"

namespace sipplab {

/// Displacements to the 2^k neighbours, k >= 2, in the order of their angles: the four
/// units, then, k - 2 times, the sum of each two that stand next to each other.
std::vector<Cell> mediant_neighbourhood(int k);

struct LoneRobot {
  Cell start;
  Cell goal;
  Fraction radius;
  double speed = 1;
  int connectedness = 2;
};

/// When the robot can be at its goal for good, at the earliest; nothing where it never
/// can. Slots of zero width count. Exact to some 1e-8 s per move.
std::optional<double> earliest_arrival_s(const GridMap& map, const std::vector<MovingDisk>& disks,
                                         const LoneRobot& robot);

}  // namespace sipplab
