// A cell of the grid: column and row, origin in the upper left corner.
#pragma once

#include <compare>
#include <cstdint>

#include "planner/geometry/vec2.hpp"

namespace sipplab {

struct Cell {
  std::int32_t x = 0;  ///< column
  std::int32_t y = 0;  ///< row

  friend auto operator<=>(const Cell&, const Cell&) = default;
};

constexpr Vec2 centre(Cell cell) { return {static_cast<double>(cell.x), static_cast<double>(cell.y)}; }

/// Distance between two cell centres, in cells.
inline double distance(Cell a, Cell b) { return norm(centre(a) - centre(b)); }

}  // namespace sipplab
