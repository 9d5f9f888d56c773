// How deep a moving disk overlaps blocked cells, or the outside of the grid.
#pragma once

#include "sipplab/geometry.hpp"
#include "sipplab/grid_map.hpp"

namespace sipplab {

/// Distance between a straight segment and a closed unit square around a cell's
/// centre; 0 if they meet. `at` is the place on the segment, from 0 (its first
/// end) to 1, where the distance is least; where the segment runs through the
/// square, the middle of that part.
struct SegmentDistance {
  double distance_cells = 0;
  double at = 0;
};
SegmentDistance distance_to_square(Vec2 from, Vec2 to, Vec2 square_centre);

/// The deepest overlap of a disk that sweeps along a segment with a blocked cell
/// or with the outside of the grid; depth_cells <= 0 when there is none.
struct StaticOverlap {
  double depth_cells = 0;
  double at = 0;  ///< place on the segment, 0 to 1
  bool outside = false;
  Cell blocked;  ///< the cell; meaningless when outside
};

/// Looks at the cells near the segment only.
StaticOverlap deepest_static_overlap(const GridMap& map, Cell from, Cell to, double radius_cells);

}  // namespace sipplab
