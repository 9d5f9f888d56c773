// Unit moves between the free cells of a map, by direction, and how closely robots follow each other, in
// whole parts of a move.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "planner/grid/free_grid.hpp"
#include "planner/retime/unit_schedule.hpp"

namespace sipplab {

/// Time, in units of 1 / kTicksPerMove of a move.
using Tick = std::int32_t;
inline constexpr Tick kMoveTicks = kTicksPerMove;
/// Later than any time of a plan; sums with such times still fit.
inline constexpr Tick kNever = INT32_MAX / 2;

using Direction = std::uint8_t;
inline constexpr Direction kDirections = 4;
/// Of a robot that begins or ends where it is.
inline constexpr Direction kNowhere = kDirections;

class UnitMoves {
 public:
  /// The grid must outlive this. Lags are those of disks of this reach: see unit_schedule(). O(cells).
  UnitMoves(const FreeGrid& grid, double reach_cells);

  const FreeGrid& grid() const { return grid_; }
  /// kNoCell if there is no free cell.
  CellId next(CellId cell, Direction direction) const { return next_[cell][direction]; }
  /// REQUIRES: the two are neighbours.
  Direction direction(CellId from, CellId to) const;
  /// How long after a robot sets off from a cell the next one may arrive there.
  Tick lag(Direction left, Direction entered) const { return lags_[left][entered]; }
  /// That of robots that go the same way: no lag is less.
  Tick least_lag() const { return lags_[0][0]; }

 private:
  const FreeGrid& grid_;
  std::vector<std::array<CellId, kDirections>> next_;
  std::array<std::array<Tick, kDirections + 1>, kDirections + 1> lags_{};
};

}  // namespace sipplab
