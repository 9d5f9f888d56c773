// Line of sight for a disk in whole numbers: every blocked cell against the move, one by
// one. Shares nothing with planner/grid but the map.
#pragma once

#include <cstdint>
#include <vector>

#include "sipplab/grid_map.hpp"

namespace sipplab {

/// A radius, in cells.
struct Fraction {
  std::int64_t numerator = 1;
  std::int64_t denominator = 2;

  double value() const { return static_cast<double>(numerator) / static_cast<double>(denominator); }
};

/// Whether the open disk overlaps the open square of `blocked` somewhere on its straight
/// move between two cell centres. Exact. REQUIRES: coordinates up to 1,000, radii of at
/// most two digits; then no product leaves 64 bits.
bool exactly_overlaps(Cell from, Cell to, Fraction radius, Cell blocked);

/// Whether the disk fits inside the grid at `cell` and overlaps no blocked cell.
bool exactly_legal(const GridMap& map, Fraction radius, Cell cell);

/// Whether the disk can move straight from one to the other.
/// REQUIRES: exactly_legal at both.
bool exactly_clear(const GridMap& map, Fraction radius, Cell from, Cell to);

/// The columns from `first` to `last` whose cells in `row` are overlapped on the way.
std::vector<std::int32_t> exactly_swept(Cell from, Cell to, Fraction radius, std::int32_t row,
                                        std::int32_t first, std::int32_t last);

}  // namespace sipplab
