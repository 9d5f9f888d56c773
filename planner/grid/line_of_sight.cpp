#include "planner/grid/line_of_sight.hpp"

#include <algorithm>
#include <cmath>

#include "planner/core/tolerances.hpp"

namespace sipplab {
namespace {

/// The capsule around a segment from the origin to (dx, dy), dx >= 0 and dy >= 0, and its right boundary: an
/// arc around the origin, a line parallel to the segment, and an arc around the end, in the order of growing
/// y.
class Capsule {
 public:
  Capsule(Cell displacement, double radius) : dx_(displacement.x), dy_(displacement.y), radius_(radius) {
    const double length = norm({dx_, dy_});
    if (length > 0) drop_ = radius * dx_ / length;
    if (dy_ > 0) slope_ = dx_ / dy_, aside_ = radius * dy_ / length;
  }

  /// The run of columns that it overlaps in a row of cells.
  CellRun run(std::int32_t row) const {
    const double low = row - kHalfCell;
    const double high = row + kHalfCell;
    if (low >= dy_ + radius_ - kTouchDepthCells || high <= -radius_ + kTouchDepthCells) return {};
    // The capsule is symmetric under a half turn about the segment's midpoint.
    const double left = dx_ - right_over(dy_ - high, dy_ - low);
    const double right = right_over(low, high);
    // A cell from c - 0.5 to c + 0.5 is overlapped when left < c + 0.5 and c - 0.5 < right.
    return {-ceil_of(kHalfCell - left - kTouchDepthCells) + 1,
            ceil_of(right - kTouchDepthCells + kHalfCell) - 1};
  }

 private:
  static constexpr double kHalfCell = 0.5;

  /// Saves the function call that std::ceil is on old processors.
  static std::int32_t ceil_of(double x) {
    const auto whole = static_cast<std::int32_t>(x);
    return whole + (x > whole ? 1 : 0);
  }
  /// The greatest x over heights in [low, high]. The boundary is concave in y and greatest at y = dy.
  double right_over(double low, double high) const {
    if (dy_ < low) return right_at(std::max(low, -radius_));
    if (dy_ > high) return right_at(std::min(high, dy_ + radius_));
    return dx_ + radius_;
  }
  double right_at(double y) const {
    if (y >= dy_ - drop_) return dx_ + half_chord(y - dy_);
    if (y <= -drop_) return half_chord(y);
    return (y + drop_) * slope_ + aside_;
  }
  double half_chord(double from_centre) const {
    return std::sqrt(std::max(0.0, radius_ * radius_ - from_centre * from_centre));
  }

  double dx_;
  double dy_;
  double radius_;
  double drop_ = 0;   ///< how far below the arcs' centres the line begins and ends
  double slope_ = 0;  ///< of the line, in x for each y
  double aside_ = 0;  ///< where the line is at y = -drop
};

}  // namespace

CellRun swept_run(Cell displacement, double radius, std::int32_t row) {
  // Mirrored so that no component is negative.
  const CellRun run = Capsule({std::abs(displacement.x), std::abs(displacement.y)}, radius)
                          .run(displacement.y < 0 ? -row : row);
  return displacement.x < 0 ? CellRun{-run.last, -run.first} : run;
}

SweptRuns::SweptRuns(double radius, std::int32_t reach, std::int32_t longest)
    : radius_(radius),
      longest_kept_(std::min(longest, kLongestKept)),
      reach_(reach),
      begins_(arena_),
      kept_(arena_),
      scratch_(arena_) {
  begins_.assign(static_cast<std::size_t>((longest_kept_ + 1) * (longest_kept_ + 1)), 0);
  kept_.push_back({});
}

std::span<const CellRun> SweptRuns::of(Cell displacement) {
  const auto rows = static_cast<std::size_t>(displacement.y + 2 * reach_ + 1);
  if (displacement.x > longest_kept_ || displacement.y > longest_kept_) {
    scratch_.clear();
    append(displacement, scratch_);
    return {scratch_.data(), scratch_.size()};
  }
  std::uint32_t& begin =
      begins_[static_cast<std::size_t>(displacement.y * (longest_kept_ + 1) + displacement.x)];
  if (begin == 0) {
    begin = static_cast<std::uint32_t>(kept_.size());
    append(displacement, kept_);
  }
  return {kept_.data() + begin, rows};
}

void SweptRuns::append(Cell displacement, ArenaVector<CellRun>& runs) const {
  const Capsule capsule(displacement, radius_);
  for (std::int32_t row = -reach_; row <= displacement.y + reach_; ++row) runs.push_back(capsule.run(row));
}

LineOfSight::LineOfSight(const GridMap& map, double radius_cells)
    : is_open_(map.blocked_count() == 0),
      width_(map.width()),
      height_(map.height()),
      radius_(radius_cells),
      reach_(static_cast<std::int32_t>(std::ceil(radius_cells - 0.5 - kTouchDepthCells))),
      runs_(radius_cells, reach_, std::max(map.width(), map.height())),
      known_(is_open_ ? 0 : std::size_t{1} << kKnownBits, UINT64_MAX) {
  const auto stride = static_cast<std::size_t>(width_) + 1;
  summed_.assign(stride * (static_cast<std::size_t>(height_) + 1), 0);
  in_row_.assign(stride * static_cast<std::size_t>(height_), 0);
  for (std::int32_t y = 0; y < height_; ++y) {
    std::int32_t in_row = 0;
    for (std::int32_t x = 0; x < width_; ++x) {
      in_row += map.is_blocked({x, y}) ? 1 : 0;
      const std::size_t here = static_cast<std::size_t>(y) * stride + static_cast<std::size_t>(x) + 1;
      in_row_[here] = in_row;
      summed_[here + stride] = summed_[here] + in_row;
    }
  }
  legal_.assign(map.cell_count(), 0);
  const std::span<const CellRun> at_rest = runs_.of({0, 0});
  for (std::int32_t y = reach_; y < height_ - reach_; ++y) {
    for (std::int32_t x = reach_; x < width_ - reach_; ++x) {
      bool free = true;
      std::int32_t row = y - reach_;
      for (const CellRun run : at_rest) {
        free = free && (run.last < run.first || !is_blocked_in_row(x + run.first, x + run.last, row));
        ++row;
      }
      legal_[index({x, y})] = free ? 1 : 0;
    }
  }
}

bool LineOfSight::is_blocked_in_row(std::int32_t x0, std::int32_t x1, std::int32_t y) const {
  const std::int32_t* row = &in_row_[static_cast<std::size_t>(y) * (static_cast<std::size_t>(width_) + 1)];
  return row[x1 + 1] != row[x0];
}

bool LineOfSight::is_clear_anew(Cell from, Cell to) const {
  if (is_open_between(from, to)) return true;
  const auto [left, right] = std::minmax({from.x, to.x});
  const auto [top, bottom] = std::minmax({from.y, to.y});
  // The runs are for a move to the right and downwards: mirror them.
  const std::int32_t down = to.y < from.y ? -1 : 1;
  const bool to_the_right = to.x >= from.x;
  std::int32_t y = from.y - down * reach_;
  for (const CellRun run : runs_.of({right - left, bottom - top})) {
    if (run.last >= run.first) {
      const bool blocked = to_the_right ? is_blocked_in_row(from.x + run.first, from.x + run.last, y)
                                        : is_blocked_in_row(from.x - run.last, from.x - run.first, y);
      if (blocked) return false;
    }
    y += down;
  }
  return true;
}

}  // namespace sipplab
