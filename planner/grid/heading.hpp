// Directions as AA-SIPP(m) counts them: degrees from 0 to less than 360, 0 towards
// growing x, counter-clockwise as a viewer sees it, so that 90 is towards smaller y.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <vector>

#include "sipplab/error.hpp"
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

/// Remembers heading_deg() by displacement. For one thread at a time.
class Headings {
 public:
  /// heading_deg(from, to), to the last bit. REQUIRES: from != to.
  double deg(Cell from, Cell to) const {
    PLANNER_ASSERT(from != to);
    const std::uint32_t columns = static_cast<std::uint32_t>(to.x) - static_cast<std::uint32_t>(from.x);
    const std::uint32_t rows = static_cast<std::uint32_t>(to.y) - static_cast<std::uint32_t>(from.y);
    const std::uint64_t displacement = std::uint64_t{columns} << 32 | rows;
    Known& known = known_[(displacement * kHashFactor) >> (64 - kKnownBits)];
    if (known.displacement != displacement) known = {displacement, heading_deg(from, to)};
    return known.deg;
  }

 private:
  struct Known {
    std::uint64_t displacement = 0;  ///< that of no two cells, at first
    double deg = 0;
  };
  /// 64 KiB. On maps of 32 x 32 cells there are 3,969 displacements.
  static constexpr int kKnownBits = 12;
  static constexpr std::uint64_t kHashFactor = 0x9e3779b97f4a7c15;  ///< 2^64 / the golden ratio

  mutable std::vector<Known> known_ = std::vector<Known>(std::size_t{1} << kKnownBits);
};

}  // namespace sipplab
