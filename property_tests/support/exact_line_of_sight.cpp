// Exact distances of segments and squares; see exact_line_of_sight.hpp.
#include "property_tests/support/exact_line_of_sight.hpp"

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdlib>

namespace sipplab {
namespace {

/// All coordinates doubled, so that corners of cells are whole numbers.
struct Point {
  std::int64_t x;
  std::int64_t y;
};

Point doubled(Cell cell) { return {2 * std::int64_t{cell.x}, 2 * std::int64_t{cell.y}}; }
std::int64_t dot(Point a, Point b) { return a.x * b.x + a.y * b.y; }
std::int64_t cross(Point a, Point b) { return a.x * b.y - a.y * b.x; }
Point minus(Point a, Point b) { return {a.x - b.x, a.y - b.y}; }

/// Compares the square root of numerator / denominator, in half cells, with the radius.
bool is_less(std::int64_t numerator, std::int64_t denominator, Fraction radius) {
  return numerator * radius.denominator * radius.denominator <
         4 * radius.numerator * radius.numerator * denominator;
}

/// Squared distance of a point to the square around `centre`.
std::int64_t squared_to_square(Point point, Point centre) {
  const std::int64_t x = std::max<std::int64_t>(0, std::abs(point.x - centre.x) - 1);
  const std::int64_t y = std::max<std::int64_t>(0, std::abs(point.y - centre.y) - 1);
  return x * x + y * y;
}

std::array<Point, 4> corners_of(Point centre) {
  return {{{centre.x - 1, centre.y - 1},
           {centre.x + 1, centre.y - 1},
           {centre.x - 1, centre.y + 1},
           {centre.x + 1, centre.y + 1}}};
}

/// Whether segment and square have a point in common: no line parallel to a side of the
/// square or to the segment separates them.
bool meet(Point from, Point to, Point centre) {
  if (std::max(from.x, to.x) < centre.x - 1 || std::min(from.x, to.x) > centre.x + 1) return false;
  if (std::max(from.y, to.y) < centre.y - 1 || std::min(from.y, to.y) > centre.y + 1) return false;
  const Point path = minus(to, from);
  bool left = false;
  bool right = false;
  for (const Point corner : corners_of(centre)) {
    const std::int64_t side = cross(path, minus(corner, from));
    left = left || side >= 0;
    right = right || side <= 0;
  }
  return left && right;
}

}  // namespace

bool exactly_overlaps(Cell from_cell, Cell to_cell, Fraction radius, Cell blocked) {
  const Point from = doubled(from_cell);
  const Point to = doubled(to_cell);
  const Point centre = doubled(blocked);
  if (meet(from, to, centre)) return true;
  // Apart, they are nearest at an end of the segment or at a corner of the square.
  if (is_less(squared_to_square(from, centre), 1, radius)) return true;
  if (is_less(squared_to_square(to, centre), 1, radius)) return true;
  const Point path = minus(to, from);
  const std::int64_t length_squared = dot(path, path);
  for (const Point corner : corners_of(centre)) {
    const std::int64_t along = dot(path, minus(corner, from));
    if (along <= 0 || along >= length_squared) continue;
    const std::int64_t aside = cross(path, minus(corner, from));
    if (is_less(aside * aside, length_squared, radius)) return true;
  }
  return false;
}

bool exactly_legal(const GridMap& map, Fraction radius, Cell cell) {
  const auto fits = [&](std::int64_t to_border_in_half_cells) {
    return to_border_in_half_cells * radius.denominator >= 2 * radius.numerator;
  };
  if (!map.contains(cell)) return false;
  if (!fits(2 * cell.x + 1) || !fits(2 * (map.width() - cell.x) - 1)) return false;
  if (!fits(2 * cell.y + 1) || !fits(2 * (map.height() - cell.y) - 1)) return false;
  return exactly_clear(map, radius, cell, cell);
}

bool exactly_clear(const GridMap& map, Fraction radius, Cell from, Cell to) {
  for (std::size_t i = 0; i < map.cell_count(); ++i) {
    if (map.is_blocked(map.cell(i)) && exactly_overlaps(from, to, radius, map.cell(i))) return false;
  }
  return true;
}

std::vector<std::int32_t> exactly_swept(Cell from, Cell to, Fraction radius, std::int32_t row,
                                        std::int32_t first, std::int32_t last) {
  std::vector<std::int32_t> columns;
  for (std::int32_t x = first; x <= last; ++x) {
    if (exactly_overlaps(from, to, radius, {x, row})) columns.push_back(x);
  }
  return columns;
}

}  // namespace sipplab
