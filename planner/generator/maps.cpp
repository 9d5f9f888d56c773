#include "planner/generator/maps.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <functional>
#include <numeric>
#include <utility>
#include <vector>

namespace sipplab {
namespace {

std::size_t blocked_cells(const MapSpec& spec, const GridMap& map) {
  return static_cast<std::size_t>(std::floor(spec.density * static_cast<double>(map.cell_count()) + 0.5));
}

/// Cells to either side over which noise is smoothed, and how often: lumps of about five cells. (Sums of
/// that many 16-bit numbers fit.)
constexpr std::int32_t kSmoothCells = 2;
constexpr int kSmoothRounds = 2;
constexpr std::uint32_t kMostNoise = UINT16_MAX;

/// Sums along lines of `count` values, `step` apart; those beyond the ends are `outside`.
void smooth_line(std::uint32_t* values, std::int32_t count, std::size_t step, std::uint32_t outside,
                 std::vector<std::uint32_t>& line) {
  const auto size = static_cast<std::size_t>(count);
  line.assign(size + 2 * kSmoothCells, outside);
  for (std::size_t i = 0; i < size; ++i) line[i + kSmoothCells] = values[i * step];
  for (std::size_t i = 0; i < size; ++i) {
    values[i * step] =
        std::accumulate(line.begin() + static_cast<std::ptrdiff_t>(i),
                        line.begin() + static_cast<std::ptrdiff_t>(i + 2 * kSmoothCells + 1), 0u);
  }
}

/// The squares between walls, row by row, and the walls between two of them.
class Squares {
 public:
  explicit Squares(const MapSpec& spec)
      : spec_(spec), period_(spec.gap_cells + 1), columns_(count(spec.width)), rows_(count(spec.height)) {}

  std::size_t size() const { return static_cast<std::size_t>(columns_) * static_cast<std::size_t>(rows_); }

  /// Where the wall between two squares is: its first cell and its last one.
  struct Wall {
    std::uint32_t one = 0;
    std::uint32_t other = 0;
    Cell first;
    Cell last;
  };

  std::vector<std::uint32_t> walls() const {
    std::vector<std::uint32_t> walls;
    for (std::uint32_t square = 0; square < size(); ++square) {
      if (column(square) + 1 < columns_) walls.push_back(2 * square);
      if (row(square) + 1 < rows_) walls.push_back(2 * square + 1);
    }
    return walls;
  }

  Wall wall(std::uint32_t id) const {
    const std::uint32_t square = id / 2;
    const std::int32_t x = column(square) * period_;
    const std::int32_t y = row(square) * period_;
    const Cell end{std::min(x + spec_.gap_cells, spec_.width), std::min(y + spec_.gap_cells, spec_.height)};
    if (id % 2 == 0) return {square, square + 1, {end.x, y}, {end.x, end.y - 1}};
    return {square, square + static_cast<std::uint32_t>(columns_), {x, end.y}, {end.x - 1, end.y}};
  }

 private:
  /// Those that are cut off by the end of the map included.
  std::int32_t count(std::int32_t cells) const { return (cells + period_ - 1) / period_; }
  std::int32_t column(std::uint32_t square) const { return static_cast<std::int32_t>(square) % columns_; }
  std::int32_t row(std::uint32_t square) const { return static_cast<std::int32_t>(square) / columns_; }

  const MapSpec& spec_;
  std::int32_t period_;
  std::int32_t columns_;
  std::int32_t rows_;
};

std::uint32_t root(std::vector<std::uint32_t>& parents, std::uint32_t square) {
  while (parents[square] != square) square = parents[square] = parents[parents[square]];
  return square;
}

void block(GridMap& map, Cell first, Cell last, bool blocked) {
  for (std::int32_t y = first.y; y <= last.y; ++y) {
    for (std::int32_t x = first.x; x <= last.x; ++x) map.set_blocked({x, y}, blocked);
  }
}

}  // namespace

GridMap random_map(const MapSpec& spec, Random random) {
  GridMap map(spec.width, spec.height);
  std::vector<std::uint32_t> cells(map.cell_count());
  std::iota(cells.begin(), cells.end(), 0u);
  random.shuffle(cells);
  for (std::size_t i = 0; i < blocked_cells(spec, map); ++i) map.set_blocked(map.cell(cells[i]), true);
  return map;
}

GridMap caves_map(const MapSpec& spec, Random random) {
  GridMap map(spec.width, spec.height);
  std::vector<std::uint32_t> noise(map.cell_count());
  for (std::uint32_t& value : noise) value = static_cast<std::uint32_t>(random.below(kMostNoise + 1));
  std::vector<std::uint32_t> line;
  std::uint32_t outside = kMostNoise;
  const auto width = static_cast<std::size_t>(spec.width);
  for (int round = 0; round < kSmoothRounds; ++round) {
    for (std::size_t begin = 0; begin < noise.size(); begin += width) {
      smooth_line(noise.data() + begin, spec.width, 1, outside, line);
    }
    outside *= 2 * kSmoothCells + 1;
    for (std::size_t x = 0; x < width; ++x) {
      smooth_line(noise.data() + x, spec.height, width, outside, line);
    }
    outside *= 2 * kSmoothCells + 1;
  }
  const std::size_t blocked = blocked_cells(spec, map);
  if (blocked == 0) return map;
  std::vector<std::uint32_t> sorted = noise;
  const auto least = sorted.begin() + static_cast<std::ptrdiff_t>(blocked - 1);
  std::nth_element(sorted.begin(), least, sorted.end(), std::greater<>());
  // Of cells that are as noisy as the last one that is blocked, the first ones.
  auto as_noisy = blocked - static_cast<std::size_t>(std::count_if(
                                sorted.begin(), least, [&](std::uint32_t value) { return value > *least; }));
  for (std::size_t i = 0; i < noise.size(); ++i) {
    const bool is_last = noise[i] == *least && as_noisy > 0;
    as_noisy -= is_last;
    if (is_last || noise[i] > *least) map.set_blocked(map.cell(i), true);
  }
  return map;
}

GridMap walled_map(const MapSpec& spec, Random random) {
  GridMap map(spec.width, spec.height);
  for (std::int32_t x = spec.gap_cells; x < spec.width; x += spec.gap_cells + 1) {
    block(map, {x, 0}, {x, spec.height - 1}, true);
  }
  for (std::int32_t y = spec.gap_cells; y < spec.height; y += spec.gap_cells + 1) {
    block(map, {0, y}, {spec.width - 1, y}, true);
  }
  const Squares squares(spec);
  std::vector<std::uint32_t> walls = squares.walls();
  random.shuffle(walls);
  // A spanning tree (Kruskal 1956).
  std::vector<std::uint32_t> parents(squares.size());
  std::iota(parents.begin(), parents.end(), 0u);
  for (const std::uint32_t id : walls) {
    const Squares::Wall wall = squares.wall(id);
    const std::uint32_t one = root(parents, wall.one);
    const std::uint32_t other = root(parents, wall.other);
    const bool is_maze = spec.kind == MapSpec::Kind::kMaze;
    if (one == other && (is_maze || random.one_in(2))) continue;
    parents[one] = other;
    if (is_maze) {
      block(map, wall.first, wall.last, false);
      continue;
    }
    const std::int32_t cells = wall.last.x - wall.first.x + wall.last.y - wall.first.y + 1;
    const auto at = static_cast<std::int32_t>(random.below(static_cast<std::uint64_t>(cells)));
    const bool is_upright = wall.first.x == wall.last.x;
    map.set_blocked({wall.first.x + (is_upright ? 0 : at), wall.first.y + (is_upright ? at : 0)}, false);
  }
  return map;
}

GridMap shelves_map(const MapSpec& spec) {
  GridMap map(spec.width, spec.height);
  block(map, {0, 0}, {spec.width - 1, 0}, true);
  block(map, {0, spec.height - 1}, {spec.width - 1, spec.height - 1}, true);
  block(map, {0, 0}, {0, spec.height - 1}, true);
  block(map, {spec.width - 1, 0}, {spec.width - 1, spec.height - 1}, true);
  const Shelves& shelves = spec.shelves;
  for (std::int32_t row = 0; row < shelves.rows; ++row) {
    const std::int32_t y = 1 + spec.gap_cells + row * (shelves.width + spec.gap_cells);
    for (std::int32_t column = 0; column < shelves.columns; ++column) {
      const std::int32_t x = 1 + shelves.space_beside() + column * (shelves.length + spec.gap_cells);
      block(map, {x, y}, {x + shelves.length - 1, y + shelves.width - 1}, true);
    }
  }
  return map;
}

GridMap warehouse_map() {
  constexpr std::int32_t kWidth = 35;
  constexpr std::int32_t kHeight = 21;
  GridMap map(kWidth, kHeight);
  for (const std::int32_t y : {2, 6, 10, 14, 18}) {
    for (const std::int32_t first_x : {7, 18}) block(map, {first_x, y}, {first_x + 9, y}, true);
  }
  return map;
}

}  // namespace sipplab
