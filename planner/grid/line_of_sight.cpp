#include "planner/grid/line_of_sight.hpp"

#include <algorithm>
#include <cmath>

#include "planner/core/tolerances.hpp"

namespace sipplab {
namespace {

/// The capsule around a segment from the origin to (dx, dy), dx >= 0 and dy >= 0.
struct Capsule {
  double dx;
  double dy;
  double radius;
  double length;

  /// The greatest x of the capsule at height y, for y within its extent. The right
  /// boundary is an arc around the origin, a line parallel to the segment, and an arc
  /// around the end, in the order of growing y.
  double right_at(double y) const {
    const double drop = length > 0 ? radius * dx / length : 0;
    if (y >= dy - drop) return dx + half_chord(y - dy);
    if (y <= -drop) return half_chord(y);
    return (y + drop) * dx / dy + radius * dy / length;
  }

  /// The greatest x over heights in [low, high]. The boundary is concave in y and
  /// greatest at y = dy.
  double right_over(double low, double high) const {
    low = std::max(low, -radius);
    high = std::min(high, dy + radius);
    if (dy < low) return right_at(low);
    if (dy > high) return right_at(high);
    return dx + radius;
  }

 private:
  double half_chord(double from_centre) const {
    return std::sqrt(std::max(0.0, radius * radius - from_centre * from_centre));
  }
};

}  // namespace

CellRun swept_run(Cell displacement, double radius, std::int32_t row) {
  // Mirror so that both components are positive.
  const bool mirror_x = displacement.x < 0;
  const std::int32_t mirrored_row = displacement.y < 0 ? -row : row;
  const double dx = std::abs(displacement.x);
  const double dy = std::abs(displacement.y);
  const Capsule capsule{dx, dy, radius, norm({dx, dy})};

  const double low = mirrored_row - 0.5;
  const double high = mirrored_row + 0.5;
  if (low >= dy + radius - kTouchDepthCells || high <= -radius + kTouchDepthCells) return {};
  const double right = capsule.right_over(low, high);
  // The capsule is its own image under a half turn about the segment's middle.
  const double left = dx - capsule.right_over(dy - high, dy - low);
  // A cell from c - 0.5 to c + 0.5 is overlapped when left < c + 0.5 and c - 0.5 < right.
  const auto first = static_cast<std::int32_t>(std::floor(left + kTouchDepthCells - 0.5)) + 1;
  const auto last = static_cast<std::int32_t>(std::ceil(right - kTouchDepthCells + 0.5)) - 1;
  return mirror_x ? CellRun{-last, -first} : CellRun{first, last};
}

SweptRuns::SweptRuns(double radius, std::int32_t reach, std::int32_t longest)
    : radius_(radius),
      longest_kept_(std::min(longest, kLongestKept)),
      reach_(reach),
      begins_(static_cast<std::size_t>((longest_kept_ + 1) * (longest_kept_ + 1)), 0),
      kept_(1) {}

std::span<const CellRun> SweptRuns::of(Cell displacement) {
  const auto rows = static_cast<std::size_t>(displacement.y + 2 * reach_ + 1);
  if (displacement.x > longest_kept_ || displacement.y > longest_kept_) {
    scratch_.clear();
    append(displacement, scratch_);
    return scratch_;
  }
  std::uint32_t& begin =
      begins_[static_cast<std::size_t>(displacement.y * (longest_kept_ + 1) + displacement.x)];
  if (begin == 0) {
    begin = static_cast<std::uint32_t>(kept_.size());
    append(displacement, kept_);
  }
  return std::span(kept_).subspan(begin, rows);
}

void SweptRuns::append(Cell displacement, std::vector<CellRun>& runs) const {
  for (std::int32_t row = -reach_; row <= displacement.y + reach_; ++row) {
    runs.push_back(swept_run(displacement, radius_, row));
  }
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
  for (std::int32_t y = reach_; y < height_ - reach_; ++y) {
    for (std::int32_t x = reach_; x < width_ - reach_; ++x) {
      bool free = true;
      std::int32_t row = y - reach_;
      for (const CellRun run : runs_.of({0, 0})) {
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
  // The runs are those of a way to the right and downwards: mirror what they mean.
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
