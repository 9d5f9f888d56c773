// The map: unit cells, each blocked or free. A robot's body may neither overlap
// a blocked cell nor leave the grid.
#pragma once

#include <compare>
#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "sipplab/error.hpp"
#include "sipplab/geometry.hpp"

namespace sipplab {

/// A cell of the grid; the origin is in the upper left corner.
struct Cell {
  std::int32_t x = 0;  ///< column
  std::int32_t y = 0;  ///< row

  friend auto operator<=>(const Cell&, const Cell&) = default;
};

constexpr Vec2 centre(Cell cell) { return {static_cast<double>(cell.x), static_cast<double>(cell.y)}; }

/// Distance between two cell centres, in cells.
inline double distance(Cell a, Cell b) { return norm(centre(a) - centre(b)); }

class GridMap {
 public:
  /// Cells along one side. The largest published grid maps have 1,024 to 4,096.
  static constexpr std::int64_t kMaxSide = 8192;

  /// Empty if a map of this size can be made, else a message: what is wrong with
  /// it and what was expected.
  static std::string check_size(std::int64_t width, std::int64_t height);

  /// All cells free. REQUIRES: check_size(width, height) is empty.
  GridMap(std::int32_t width, std::int32_t height);
  /// One cell, free: the smallest map.
  GridMap() : GridMap(1, 1) {}

  std::int32_t width() const { return width_; }
  std::int32_t height() const { return height_; }
  std::size_t cell_count() const {
    return static_cast<std::size_t>(width_) * static_cast<std::size_t>(height_);
  }
  std::size_t blocked_count() const;

  bool contains(Cell cell) const { return cell.x >= 0 && cell.y >= 0 && cell.x < width_ && cell.y < height_; }
  /// Row-major. REQUIRES: contains(cell).
  std::size_t index(Cell cell) const {
    PLANNER_ASSERT(contains(cell));
    return static_cast<std::size_t>(cell.y) * static_cast<std::size_t>(width_) +
           static_cast<std::size_t>(cell.x);
  }
  Cell cell(std::size_t index) const {
    const auto width = static_cast<std::size_t>(width_);
    return {static_cast<std::int32_t>(index % width), static_cast<std::int32_t>(index / width)};
  }

  /// REQUIRES: contains(cell).
  bool is_blocked(Cell cell) const { return blocked_[index(cell)] != 0; }
  void set_blocked(Cell cell, bool blocked) { blocked_[index(cell)] = blocked ? 1 : 0; }

  friend bool operator==(const GridMap&, const GridMap&) = default;

 private:
  std::int32_t width_;
  std::int32_t height_;
  std::vector<std::uint8_t> blocked_;
};

}  // namespace sipplab
