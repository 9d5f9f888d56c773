// Swept disks against the map; see static_clearance.hpp.
#include "planner/validator/static_clearance.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>

namespace sipplab {
namespace {

struct Range {
  double begin = 0;
  double end = 1;
};

/// Cuts `part` of the line from + (to - from) * s to where |coordinate - middle| <= half.
void cut_to_slab(double from, double to, double middle, double half, Range& part) {
  const double path = to - from;
  if (path == 0) {
    if (std::abs(from - middle) > half) part = {1, 0};
    return;
  }
  const double one = (middle - half - from) / path;
  const double other = (middle + half - from) / path;
  part.begin = std::max(part.begin, std::min(one, other));
  part.end = std::min(part.end, std::max(one, other));
}

double distance_point_to_square(Vec2 point, Vec2 middle) {
  return norm(
      {std::max(0.0, std::abs(point.x - middle.x) - 0.5), std::max(0.0, std::abs(point.y - middle.y) - 0.5)});
}

/// The cells from `low` to `high` of a side of `count` cells, in whole numbers.
struct CellSpan {
  std::int32_t first = 0;
  std::int32_t last = -1;
};
CellSpan cells_within(double low, double high, std::int32_t count) {
  const double first = std::max(0.0, std::ceil(low));
  const double last = std::min(static_cast<double>(count - 1), std::floor(high));
  if (!(first <= last)) return {};
  return {static_cast<std::int32_t>(first), static_cast<std::int32_t>(last)};
}

/// How far a disk around `place` reaches beyond the grid; negative inside.
double depth_outside(const GridMap& map, Vec2 place, double radius_cells) {
  const double to_border_cells =
      std::min({place.x + 0.5, place.y + 0.5, map.width() - 0.5 - place.x, map.height() - 0.5 - place.y});
  return radius_cells - to_border_cells;
}

}  // namespace

SegmentDistance distance_to_square(Vec2 from, Vec2 to, Vec2 square_centre) {
  Range inside;
  cut_to_slab(from.x, to.x, square_centre.x, 0.5, inside);
  cut_to_slab(from.y, to.y, square_centre.y, 0.5, inside);
  if (inside.begin <= inside.end) return {0, (inside.begin + inside.end) / 2};

  // Apart, so one of the closest points is an end of the segment or a corner.
  SegmentDistance least{distance_point_to_square(from, square_centre), 0};
  const auto take = [&](double distance_cells, double at) {
    if (distance_cells < least.distance_cells) least = {distance_cells, at};
  };
  take(distance_point_to_square(to, square_centre), 1);
  const Vec2 path = to - from;
  const double squared_length = squared_norm(path);
  if (squared_length > 0) {
    constexpr std::array<Vec2, 4> kCorners{Vec2{-0.5, -0.5}, Vec2{0.5, -0.5}, Vec2{-0.5, 0.5},
                                           Vec2{0.5, 0.5}};
    for (const Vec2 offset : kCorners) {
      const Vec2 corner = square_centre + offset;
      const double at = std::clamp(dot(corner - from, path) / squared_length, 0.0, 1.0);
      take(norm(from + path * at - corner), at);
    }
  }
  return least;
}

StaticOverlap deepest_static_overlap(const GridMap& map, Cell from_cell, Cell to_cell, double radius_cells) {
  const Vec2 from = centre(from_cell);
  const Vec2 to = centre(to_cell);
  StaticOverlap deepest{0, 0, false, {}};

  // A disk is farthest outside a rectangle at one of the ends of a straight move.
  const double outside_at_from = depth_outside(map, from, radius_cells);
  const double outside_at_to = depth_outside(map, to, radius_cells);
  if (std::max(outside_at_from, outside_at_to) > 0) {
    const bool first = outside_at_from >= outside_at_to;
    deepest = {first ? outside_at_from : outside_at_to, first ? 0.0 : 1.0, true, {}};
  }

  const double reach = radius_cells + 0.5;
  const CellSpan rows =
      cells_within(std::min(from.y, to.y) - reach, std::max(from.y, to.y) + reach, map.height());
  for (std::int32_t y = rows.first; y <= rows.last; ++y) {
    // The part of the line that passes near this row bounds the columns.
    Range part;
    cut_to_slab(from.y, to.y, y, reach, part);
    if (part.begin > part.end) continue;
    const double x_begin = from.x + (to.x - from.x) * part.begin;
    const double x_end = from.x + (to.x - from.x) * part.end;
    const CellSpan columns =
        cells_within(std::min(x_begin, x_end) - reach, std::max(x_begin, x_end) + reach, map.width());
    for (std::int32_t x = columns.first; x <= columns.last; ++x) {
      if (!map.is_blocked({x, y})) continue;
      const SegmentDistance near = distance_to_square(from, to, centre({x, y}));
      const double depth_cells = radius_cells - near.distance_cells;
      if (depth_cells > deepest.depth_cells) deepest = {depth_cells, near.at, false, {x, y}};
    }
  }
  return deepest;
}

}  // namespace sipplab
