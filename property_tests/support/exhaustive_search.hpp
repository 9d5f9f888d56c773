// Earliest arrival of one robot on a 2^k neighbourhood among disks with known paths: a
// slow search in which every time comes from bisection. Shares nothing with
// planner/reservation and planner/search.
#pragma once

#include <optional>
#include <vector>

#include "planner/geometry/moving_disk.hpp"
#include "property_tests/support/exact_line_of_sight.hpp"
#include "sipplab/grid_map.hpp"

namespace sipplab {

/// Displacements to the 2^k neighbours, k >= 2, in the order of their angles: the four
/// units, then, k - 2 times, the sum of each two that stand next to each other.
std::vector<Cell> mediant_neighbourhood(int k);

/// What a robot with a heading starts with, ends with and turns by, in degrees.
struct Turning {
  double start_deg = 0;
  std::optional<double> goal_deg;
  double deg_per_s = 180;
};

struct LoneRobot {
  Cell start;
  Cell goal;
  Fraction radius;
  double speed = 1;
  int connectedness = 2;
  std::optional<Turning> turning = std::nullopt;  ///< none: headings do not count
  double wait_before_move_s = 0;
  double extra_reach_cells = 0;  ///< that a moving robot keeps beyond the radii
  double extra_time_s = 0;       ///< that it keeps before and after others, moving or not
};

/// A place that the robot may come within reach of only while it is within the same reach
/// of `pardoned`: a start that is protected for ever, seen by a robot whose goal overlaps it.
struct Forbidden {
  Vec2 place;
  double reach;
  Vec2 pardoned;
};

/// How far, in cells, the move leads on within reach of the place and out of reach of what
/// is pardoned; negative if it does not come to that, by how far it misses.
double intrusion_cells(const Forbidden& forbidden, Vec2 from, Vec2 to);

/// How contacts count. Robots that give way to each other move by slacks of 1e-9 s, so
/// that among several of them what ought to be a contact may be an overlap or a gap.
enum class Contacts {
  kAllowed,  ///< slots of zero width count, and what nearly is one
  kAvoided,  ///< where a contact is left out, so is what is nearly one
};

/// When the robot can be at its goal for good, at the earliest, the turn to its goal heading
/// done; nothing if it never can. Every heading of arrival is a label of its own. Exact to some 1e-8 s per
/// move.
std::optional<double> earliest_arrival_s(const GridMap& map, const std::vector<MovingDisk>& disks,
                                         const LoneRobot& robot, const std::vector<Forbidden>& forbidden = {},
                                         Contacts contacts = Contacts::kAllowed);

}  // namespace sipplab
