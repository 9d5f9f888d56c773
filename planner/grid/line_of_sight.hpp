// Which straight moves a disk can make between cell centres without entering a
// blocked cell: "line of sight for a disk".
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "planner/core/arena.hpp"
#include "sipplab/error.hpp"
#include "sipplab/grid_map.hpp"

namespace sipplab {

/// The run of columns [first, last] that the swept disk overlaps in one row of cells.
struct CellRun {
  std::int32_t first = 0;
  std::int32_t last = -1;  ///< less than `first` if the run is empty
};

/// Cells of row `row` that a disk of `radius` overlaps by more than kTouchDepthCells while
/// it moves from (0, 0) to `displacement`.
CellRun swept_run(Cell displacement, double radius, std::int32_t row);

/// The runs of all rows that a disk of one radius sweeps, for displacements with no
/// negative component; others follow by reflection. Kept from their first use on.
class SweptRuns {
 public:
  /// For displacements longer than this many cells in either direction the runs are computed
  /// each time: they are rare, and the table must stay small (when full, 28 MiB for a radius of
  /// 0.5 and 64 MiB for the largest).
  static constexpr std::int32_t kLongestKept = 192;

  /// `reach`: rows above and below the move that the disk can overlap. `longest`: no displacement
  /// that is asked for is longer in either direction, so none needs room.
  SweptRuns(double radius, std::int32_t reach, std::int32_t longest);

  /// Runs for rows -reach..displacement.y + reach, in order. Valid until the next call.
  /// REQUIRES: displacement.x >= 0 and displacement.y >= 0.
  std::span<const CellRun> of(Cell displacement);

 private:
  void append(Cell displacement, ArenaVector<CellRun>& runs) const;

  double radius_;
  std::int32_t longest_kept_;
  std::int32_t reach_;
  Arena arena_;
  ArenaVector<std::uint32_t> begins_;  ///< into kept_, by displacement; 0: not computed yet
  ArenaVector<CellRun> kept_;
  ArenaVector<CellRun> scratch_;
};

/// Line of sight over one map for disks of one radius.
///
/// The swept area of a move is a capsule. In each row of cells it covers one run of
/// cells, whose ends follow in closed form from the capsule's extent in that row. The
/// runs of a displacement are kept from its first use on; prefix sums of blocked
/// cells decide a row in two look-ups. For one thread at a time.
class LineOfSight {
 public:
  /// `radius_cells` > 0. O(cells).
  LineOfSight(const GridMap& map, double radius_cells);

  /// Whether a disk resting at `cell` overlaps no blocked cell and lies inside the
  /// grid. Touching is allowed (kTouchDepthCells). O(1).
  bool is_legal(Cell cell) const { return map_contains(cell) && legal_[index(cell)] != 0; }

  /// Whether the disk can move straight from one to the other.
  ///  (1) is_clear(a, b) == is_clear(b, a);
  ///  (2) is_clear(a, a) holds wherever is_legal(a);
  ///  (3) true if and only if no blocked cell is closer to the segment than the radius
  ///      minus kTouchDepthCells.
  ///
  /// REQUIRES: is_legal(from) and is_legal(to). O(rows between the two); O(1) if the
  /// rectangle around the move holds no blocked cell.
  bool is_clear(Cell from, Cell to) const {
    if (is_open_) return true;
    const std::uint64_t ends = static_cast<std::uint64_t>(index(from)) << 32 | index(to);
    std::uint64_t& known = known_[(ends * kHashFactor) >> (64 - kKnownBits)];
    if (known >> 1 != ends) known = ends << 1 | (is_clear_anew(from, to) ? 1U : 0U);
    return (known & 1) != 0;
  }

  /// Whether the disk can move anywhere in the rectangle between the two cells: stronger than
  /// is_clear(). REQUIRES: is_legal(from) and is_legal(to). O(1).
  bool is_open_between(Cell from, Cell to) const {
    PLANNER_ASSERT(is_legal(from) && is_legal(to));
    if (is_open_) return true;
    // Both ends lie inside the grid, and so does all between them: the rectangle is convex.
    return !is_blocked_in(std::min(from.x, to.x) - reach_, std::max(from.x, to.x) + reach_,
                          std::min(from.y, to.y) - reach_, std::max(from.y, to.y) + reach_);
  }

  double radius_cells() const { return radius_; }

 private:
  bool map_contains(Cell cell) const {
    return cell.x >= 0 && cell.y >= 0 && cell.x < width_ && cell.y < height_;
  }
  std::size_t index(Cell cell) const {
    return static_cast<std::size_t>(cell.y) * static_cast<std::size_t>(width_) +
           static_cast<std::size_t>(cell.x);
  }
  /// Whether columns x0..x1 of rows y0..y1, ends included, hold a blocked cell.
  /// All lie inside the grid.
  bool is_blocked_in(std::int32_t x0, std::int32_t x1, std::int32_t y0, std::int32_t y1) const {
    const auto stride = static_cast<std::size_t>(width_) + 1;
    const std::int32_t* above = &summed_[static_cast<std::size_t>(y0) * stride];
    const std::int32_t* below = &summed_[(static_cast<std::size_t>(y1) + 1) * stride];
    return below[x1 + 1] - below[x0] - above[x1 + 1] + above[x0] != 0;
  }
  bool is_clear_anew(Cell from, Cell to) const;
  bool is_blocked_in_row(std::int32_t x0, std::int32_t x1, std::int32_t y) const;

  /// Answers that are kept: searches ask about the same few hundred pairs of cells again and again.
  static constexpr int kKnownBits = 11;
  static constexpr std::uint64_t kHashFactor = 0x9e3779b97f4a7c15u;  // 2^64 over the golden ratio

  bool is_open_;  ///< no cell of the map is blocked
  std::int32_t width_;
  std::int32_t height_;
  double radius_;
  std::int32_t reach_;                ///< cells beside its own that the disk can overlap
  std::vector<std::int32_t> summed_;  ///< blocked cells above and left: (width + 1) x (height + 1)
  std::vector<std::int32_t> in_row_;  ///< blocked cells to the left: (width + 1) x height
  std::vector<std::uint8_t> legal_;
  mutable SweptRuns runs_;
  mutable std::vector<std::uint64_t>
      known_;  ///< pairs of cells, by hash; the lowest bit is the answer of is_clear()
};

}  // namespace sipplab
