// How close two moving points come. The validator's own geometry: it minimises a
// distance, which is a parabola in time, and shares no formula with the planner.
#pragma once

#include <limits>
#include <optional>

#include "sipplab/geometry.hpp"

namespace sipplab {

/// A point that moves at constant velocity over the closed time span
/// [begin_s, end_s]; the end may be infinite for a point at rest.
struct LinearMotion {
  double begin_s = 0;
  double end_s = std::numeric_limits<double>::infinity();
  Vec2 from;  ///< position at begin_s, in cells
  Vec2 velocity_cells_per_s;

  bool is_rest() const { return velocity_cells_per_s == Vec2{}; }
  Vec2 at(double time_s) const { return is_rest() ? from : from + velocity_cells_per_s * (time_s - begin_s); }
};

struct Approach {
  double time_s = 0;  ///< the first time at which the distance is least
  double distance_cells = std::numeric_limits<double>::infinity();
};

/// Least distance of two points over [begin_s, end_s].
/// REQUIRES: begin_s <= end_s, within the time span of both.
Approach closest_approach(const LinearMotion& a, const LinearMotion& b, double begin_s, double end_s);

/// The same over the time that the two spans share; nothing when they share none.
std::optional<Approach> closest_approach(const LinearMotion& a, const LinearMotion& b);

/// The same with a point that never moves.
/// REQUIRES: begin_s <= end_s, within the time span of the motion.
Approach closest_approach(const LinearMotion& motion, Vec2 place, double begin_s, double end_s);

}  // namespace sipplab
