// Directions between cells: see heading.hpp.
#include "planner/grid/heading.hpp"

#include <cstdint>
#include <numeric>

#include "sipplab/error.hpp"

namespace sipplab {

double heading_deg(Cell from, Cell to) {
  PLANNER_ASSERT(from != to);
  constexpr double kEighthTurnDeg = kFullTurnDeg / 8;
  constexpr double kDegPerRadian = 57.295779513082323;
  // In lowest terms, so that one direction always gives the same numbers.
  const std::int64_t columns = std::int64_t{to.x} - from.x;
  const std::int64_t rows = std::int64_t{from.y} - to.y;
  const std::int64_t divisor = std::gcd(columns, rows);
  const std::int64_t right = columns / divisor;
  const std::int64_t up = rows / divisor;
  if (up == 0) return right > 0 ? 0 : kHalfTurnDeg;
  if (right == 0) return up > 0 ? 2 * kEighthTurnDeg : 6 * kEighthTurnDeg;
  if (right == up) return right > 0 ? kEighthTurnDeg : 5 * kEighthTurnDeg;
  if (right == -up) return right > 0 ? 7 * kEighthTurnDeg : 3 * kEighthTurnDeg;
  const double degrees = std::atan2(static_cast<double>(up), static_cast<double>(right)) * kDegPerRadian;
  return degrees < 0 ? degrees + kFullTurnDeg : degrees;
}

}  // namespace sipplab
