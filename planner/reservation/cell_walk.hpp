// The cells under the straight way of a move, one by one.
#pragma once

#include <cstddef>
#include <cstdlib>

#include "planner/geometry/moving_disk.hpp"
#include "planner/grid/grid_map.hpp"

namespace sipplab {

/// A cell under a move, with the span of seconds after departure in which the mover's
/// centre is in its square.
struct CellVisit {
  std::size_t cell;  ///< row-major
  double enter_s;
  double leave_s;
};

/// Lists the visits of a move in order; each begins where the one before it ends. Where the
/// way runs through the corner of four cells, one of those beside it may be visited for no
/// time at all. Made as they are asked for, because most queries end after the first few.
class CellWalk {
 public:
  /// REQUIRES: the move joins two different cell centres of the map.
  CellWalk(const GridMap& map, const Move& move) : map_width_(map.width()), duration_s_(move.duration) {
    const Cell from{static_cast<std::int32_t>(move.way.from.x), static_cast<std::int32_t>(move.way.from.y)};
    const Cell to{static_cast<std::int32_t>(move.way.to.x), static_cast<std::int32_t>(move.way.to.y)};
    cell_ = static_cast<std::ptrdiff_t>(map.index(from));
    last_cell_ = static_cast<std::ptrdiff_t>(map.index(to));
    column_step_ = to.x > from.x ? 1 : -1;
    row_step_ = to.y > from.y ? map_width_ : -map_width_;
    if (to.x != from.x) column_s_ = move.duration / std::abs(to.x - from.x);
    if (to.y != from.y) row_s_ = move.duration / std::abs(to.y - from.y);
    leaves_column_s_ = kHalfCell * column_s_;
    leaves_row_s_ = kHalfCell * row_s_;
  }

  bool done() const { return done_; }

  /// REQUIRES: !done().
  CellVisit next() {
    const auto cell = static_cast<std::size_t>(cell_);
    const double enter_s = enter_s_;
    if (cell_ == last_cell_) {
      done_ = true;
      return {cell, enter_s, duration_s_};
    }
    if (leaves_column_s_ <= leaves_row_s_) {
      cell_ += column_step_;
      enter_s_ = leaves_column_s_;
      leaves_column_s_ += column_s_;
    } else {
      cell_ += row_step_;
      enter_s_ = leaves_row_s_;
      leaves_row_s_ += row_s_;
    }
    return {cell, enter_s, enter_s_};
  }

 private:
  static constexpr double kHalfCell = 0.5;

  std::ptrdiff_t map_width_;
  double duration_s_;
  std::ptrdiff_t cell_ = 0;
  std::ptrdiff_t last_cell_ = 0;
  std::ptrdiff_t column_step_ = 0;
  std::ptrdiff_t row_step_ = 0;
  double enter_s_ = 0;
  // Seconds from one column (row) of cells to the next, and until the next is entered.
  double column_s_ = kForever;
  double row_s_ = kForever;
  double leaves_column_s_ = 0;
  double leaves_row_s_ = 0;
  bool done_ = false;
};

}  // namespace sipplab
