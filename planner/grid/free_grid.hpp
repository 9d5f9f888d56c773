// The free cells of a map, numbered one after the other, and their four neighbours.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "sipplab/grid_map.hpp"

namespace sipplab {

/// Number of a free cell, counted from 0 in row-major order.
using CellId = std::uint32_t;
inline constexpr CellId kNoCell = UINT32_MAX;
/// Position of a robot among those on the grid.
using RobotId = std::uint32_t;

class FreeGrid {
 public:
  /// O(cells).
  explicit FreeGrid(const GridMap& map);

  std::size_t size() const { return cells_.size(); }
  Cell cell(CellId id) const { return cells_[id]; }
  /// kNoCell for a blocked one. REQUIRES: the cell is on the map.
  CellId id(Cell cell) const {
    return ids_[static_cast<std::size_t>(cell.y) * width_ + static_cast<std::size_t>(cell.x)];
  }
  /// Free cells to the right, below, to the left and above, in this order.
  std::span<const CellId> neighbours(CellId id) const {
    return {neighbours_.data() + begins_[id], begins_[id + 1] - begins_[id]};
  }

 private:
  std::size_t width_;
  std::vector<Cell> cells_;
  std::vector<CellId> ids_;  ///< by GridMap::index
  std::vector<std::uint32_t> begins_;
  std::vector<CellId> neighbours_;
};

}  // namespace sipplab
