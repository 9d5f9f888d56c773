// Whether any two bodies come too close, and how close the closest two come.
#pragma once

#include <cstddef>
#include <limits>
#include <vector>

#include "planner/validator/body_track.hpp"
#include "sipplab/grid_map.hpp"

namespace sipplab {

/// Cells. Bodies that stay farther apart than this all the time are not compared.
inline constexpr double kClearanceReachCells = 1;

struct BodyConflict {
  std::size_t first = 0;   ///< position among the bodies
  std::size_t second = 0;  ///< a later one
  double time_s = 0;       ///< when the overlap is deepest
  double depth_cells = 0;
};

struct Separation {
  /// One for each pair of bodies in conflict, at its deepest; by time, then bodies.
  std::vector<BodyConflict> conflicts;
  /// Least clearance of all pairs compared, at most kClearanceReachCells; infinity
  /// if there is no pair.
  double min_clearance_cells = std::numeric_limits<double>::infinity();
};

/// Compares all pairs of bodies for all time, except pairs of bodies that are both
/// at or after position `robots` (obstacles give way to no robot), and except if a
/// body is so far outside the map that no robot belongs there. Conflicts are
/// overlaps deeper than `tolerance_cells`. Stops early when `max_conflicts` pairs
/// are found; the clearance is then that of the pairs compared so far.
///
/// Sweeps over time within buckets of space: with motions spread over the map,
/// O(m log m) for m motions.
Separation check_separation(const GridMap& map, const std::vector<BodyTrack>& bodies, std::size_t robots,
                            double tolerance_cells, std::size_t max_conflicts);

}  // namespace sipplab
