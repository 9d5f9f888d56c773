// Directions as AA-SIPP(m) counts them: degrees from 0 to less than 360, 0 towards
// growing x, counter-clockwise as a viewer sees it, so that 90 is towards smaller y.
#pragma once

#include <algorithm>
#include <cmath>

#include "sipplab/grid_map.hpp"

namespace sipplab {

inline constexpr double kHalfTurnDeg = 180;
inline constexpr double kFullTurnDeg = 360;

/// The direction from one cell to another. The same number for all pairs of cells with the
/// same direction, and exact for multiples of 45 degrees. REQUIRES: from != to.
double heading_deg(Cell from, Cell to);

/// The smaller angle between two headings, 0 to 180 degrees.
inline double turn_deg(double from_deg, double to_deg) {
  const double apart = std::abs(from_deg - to_deg);
  return std::min(apart, kFullTurnDeg - apart);
}

}  // namespace sipplab
