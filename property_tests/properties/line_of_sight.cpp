// Line of sight for a disk against whole numbers.
#include "planner/grid/line_of_sight.hpp"

#include <rapidcheck.h>

#include <algorithm>
#include <cstdint>
#include <ostream>
#include <vector>

#include "property_tests/support/encounters.hpp"
#include "property_tests/support/exact_line_of_sight.hpp"
#include "property_tests/support/property.hpp"
#include "property_tests/support/shown.hpp"

namespace sipplab::line_of_sight_laws {
namespace {

rc::Gen<Fraction> any_fraction() {
  return rc::gen::resize(rc::kNominalSize, any_of<Fraction>({{1, 2},
                                                             {1, 2},
                                                             {1, 4},
                                                             {3, 10},
                                                             {2, 5},
                                                             {7, 10},
                                                             {9, 10},
                                                             {7, 5},
                                                             {1, 1},
                                                             {3, 2},
                                                             {5, 2},
                                                             {1, 50}}));
}

/// Columns and rows up to `side`, in all four directions.
rc::Gen<Cell> any_displacement(std::int32_t side) {
  return rc::gen::map(any_cell(2 * side + 1, 2 * side + 1), [side](Cell cell) {
    return Cell{cell.x - side, cell.y - side};
  });
}

struct World {
  std::int32_t width = 8;
  std::int32_t height = 8;
  Fraction radius;
  std::vector<Cell> blocked;

  GridMap map() const {
    GridMap map(width, height);
    for (const Cell cell : blocked) {
      if (map.contains(cell)) map.set_blocked(cell, true);
    }
    return map;
  }
};

std::ostream& operator<<(std::ostream& out, const World& world) {
  out << world.width << " x " << world.height << " cells, radius " << world.radius << ", blocked:";
  for (const Cell cell : world.blocked) out << " " << cell;
  return out;
}

rc::Gen<World> any_world() {
  constexpr std::int32_t kSide = 12;
  const auto any_side = rc::gen::resize(rc::kNominalSize, rc::gen::inRange<std::int32_t>(1, kSide + 1));
  const auto any_blocked = rc::gen::mapcat(
      rc::gen::resize(rc::kNominalSize,
                      rc::gen::weightedOneOf<std::size_t>({{3, rc::gen::inRange<std::size_t>(0, 6)},
                                                           {1, rc::gen::inRange<std::size_t>(6, 30)}})),
      [](std::size_t count) { return rc::gen::container<std::vector<Cell>>(count, any_cell(kSide, kSide)); });
  return rc::gen::build<World>(rc::gen::set(&World::width, any_side), rc::gen::set(&World::height, any_side),
                               rc::gen::set(&World::radius, any_fraction()),
                               rc::gen::set(&World::blocked, any_blocked));
}

/// Legal cells of the map by the line of sight, each checked against whole numbers.
std::vector<Cell> check_legal(const GridMap& map, const LineOfSight& line_of_sight, Fraction radius) {
  std::vector<Cell> legal;
  for (std::int32_t y = -1; y <= map.height(); ++y) {
    for (std::int32_t x = -1; x <= map.width(); ++x) {
      RC_LOG() << "at " << Cell{x, y} << std::endl;
      RC_ASSERT(line_of_sight.is_legal({x, y}) == exactly_legal(map, radius, {x, y}));
      if (line_of_sight.is_legal({x, y})) legal.push_back({x, y});
    }
  }
  return legal;
}

void agrees_on_all_pairs(const World& world) {
  const GridMap map = world.map();
  const LineOfSight line_of_sight(map, world.radius.value());
  const std::vector<Cell> legal = check_legal(map, line_of_sight, world.radius);
  int clear = 0;
  int hidden = 0;
  for (const Cell from : legal) {
    for (const Cell to : legal) {
      if (from > to) continue;
      RC_LOG() << from << " to " << to << std::endl;
      const bool is_clear = line_of_sight.is_clear(from, to);
      RC_ASSERT(is_clear == exactly_clear(map, world.radius, from, to));
      RC_ASSERT(line_of_sight.is_clear(to, from) == is_clear);
      RC_ASSERT(is_clear || from != to);
      (is_clear ? clear : hidden) += 1;
    }
  }
  RC_CLASSIFY(legal.empty(), "no legal cell");
  RC_CLASSIFY(hidden > 0, "some pairs hidden");
  RC_CLASSIFY(hidden > clear, "most pairs hidden");
}

/// Rows that the swept disk can reach and one more on either side.
void agrees_on_all_rows(Cell displacement, Fraction radius) {
  const auto margin = static_cast<std::int32_t>(radius.value()) + 3;
  const auto [left, right] = std::minmax({0, displacement.x});
  const auto [top, bottom] = std::minmax({0, displacement.y});
  for (std::int32_t row = top - margin; row <= bottom + margin; ++row) {
    RC_LOG() << "row " << row << std::endl;
    const CellRun run = swept_run(displacement, radius.value(), row);
    std::vector<std::int32_t> columns;
    for (std::int32_t x = run.first; x <= run.last; ++x) columns.push_back(x);
    RC_ASSERT(columns == exactly_swept({0, 0}, displacement, radius, row, left - margin, right + margin));
  }
}

const PropertyRoom room("line_of_sight", [] {
  bool passed = true;

  passed &= property("is_legal and is_clear (1)(2)(3): agree with whole numbers, cell by cell",
                     [] { agrees_on_all_pairs(*any_world()); });

  passed &= property("swept_run: the cells that whole numbers say, on short paths", [] {
    constexpr int kPaths = 50;
    for (int i = 0; i < kPaths; ++i) {
      const Fraction radius = *any_fraction();
      agrees_on_all_rows(*any_displacement(12), radius);
    }
  });

  passed &= property("swept_run: the cells that whole numbers say, on long paths", [] {
    const Fraction radius = *any_fraction();
    agrees_on_all_rows(*any_displacement(150), radius);
  });

  return passed;
});

}  // namespace
}  // namespace sipplab::line_of_sight_laws
