// Distances over the 2^k neighbourhoods against Dijkstra's algorithm, on an empty grid and among obstacles.
#include "planner/grid/neighbourhood.hpp"

#include <rapidcheck.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <functional>
#include <limits>
#include <queue>
#include <utility>
#include <vector>

#include "planner/grid/static_distances.hpp"
#include "property_tests/support/encounters.hpp"
#include "property_tests/support/exhaustive_search.hpp"
#include "property_tests/support/property.hpp"
#include "sipplab/grid_map.hpp"

namespace sipplab::neighbourhood_laws {
namespace {

/// Rounding of sums of square roots.
constexpr double kRoundingCells = 1e-9;
/// Of the length of a path, that static distances lose by rounding each step down.
constexpr double kLostOfSteps = 0x1p-22;
/// Cells from the middle of the grid to its border, and farthest displacement looked at:
/// a shortest path does not leave the rectangle around it by more than one step.
constexpr std::int32_t kHalfSide = 16;
constexpr std::int32_t kFarthest = 12;

/// Lengths of shortest paths from a cell over steps that `may_step(from, to)`; infinity if there is none.
template <class MayStep>
std::vector<double> shortest_paths(const GridMap& map, Cell from, int k, MayStep&& may_step) {
  std::vector<double> length(map.cell_count(), std::numeric_limits<double>::infinity());
  using Entry = std::pair<double, std::size_t>;
  std::priority_queue<Entry, std::vector<Entry>, std::greater<>> queue;
  length[map.index(from)] = 0;
  queue.emplace(0, map.index(from));
  while (!queue.empty()) {
    const auto [here, index] = queue.top();
    queue.pop();
    if (here > length[index]) continue;
    const Cell cell = map.cell(index);
    for (const Cell step : mediant_neighbourhood(k)) {
      const Cell next{cell.x + step.x, cell.y + step.y};
      if (!map.contains(next) || !may_step(cell, next)) continue;
      const double there = here + distance(cell, next);
      if (there >= length[map.index(next)]) continue;
      length[map.index(next)] = there;
      queue.emplace(there, map.index(next));
    }
  }
  return length;
}

/// By k.
std::vector<std::vector<double>> shortest_paths_of_all(const GridMap& map, Cell from) {
  std::vector<std::vector<double>> paths(kMaxConnectedness + 1);
  for (int k = kMinConnectedness; k <= kMaxConnectedness; ++k) {
    paths[static_cast<std::size_t>(k)] = shortest_paths(map, from, k, [](Cell, Cell) { return true; });
  }
  return paths;
}

/// A small map with a wall here and there, for a disk that some of its cells have room for.
struct Maze {
  GridMap map{1, 1};
  double radius = 0.5;
  std::vector<Cell> legal;
};

Maze any_maze() {
  Maze maze;
  maze.map = GridMap(*rc::gen::inRange(1, 11), *rc::gen::inRange(1, 11));
  maze.radius = *any_of({0.5, 0.5, 0.2, 0.4, 0.7, 1.0});
  const std::size_t blocked = maze.map.cell_count() * *rc::gen::inRange(std::size_t{0}, std::size_t{5}) / 10;
  for (std::size_t i = 0; i < blocked; ++i) {
    maze.map.set_blocked(*any_cell(maze.map.width(), maze.map.height()), true);
  }
  const LineOfSight line_of_sight(maze.map, maze.radius);
  for (std::size_t index = 0; index < maze.map.cell_count(); ++index) {
    const Cell cell = maze.map.cell(index);
    if (line_of_sight.is_legal(cell)) maze.legal.push_back(cell);
  }
  return maze;
}

/// Static distances over a maze.
struct MazeDistances {
  Maze maze = any_maze();
  int k = *rc::gen::inRange(kMinConnectedness, kMaxConnectedness + 1);
  LineOfSight line_of_sight{maze.map, maze.radius};
  StepTable steps{line_of_sight, maze.map.cell_count(), k};
  StaticDistances distances{maze.map, line_of_sight, steps, k};

  /// REQUIRES: some cell is legal.
  Cell any_place() const { return *rc::gen::elementOf(maze.legal); }
  std::vector<double> paths_from(Cell cell) const {
    return shortest_paths(maze.map, cell, k, [&](Cell from, Cell to) {
      return line_of_sight.is_legal(to) && line_of_sight.is_clear(from, to);
    });
  }
};

Cell any_far_cell() {
  constexpr std::int32_t kSide = 8192;
  return *any_cell(kSide, kSide);
}

bool nearly(double a, double b) { return std::abs(a - b) <= kRoundingCells * (1 + std::abs(b)); }

const PropertyRoom room("neighbourhood", [] {
  bool passed = true;

  passed &= property("neighbourhood_distance: is what Dijkstra's algorithm finds on an empty grid", [] {
    static const GridMap kMap(2 * kHalfSide + 1, 2 * kHalfSide + 1);
    static const Cell kMiddle{kHalfSide, kHalfSide};
    static const std::vector<std::vector<double>> kPaths = shortest_paths_of_all(kMap, kMiddle);
    const Cell drawn = *any_cell(2 * kFarthest + 1, 2 * kFarthest + 1);
    const Cell to{drawn.x + kHalfSide - kFarthest, drawn.y + kHalfSide - kFarthest};
    for (int k = kMinConnectedness; k <= kMaxConnectedness; ++k) {
      const double expected = kPaths[static_cast<std::size_t>(k)][kMap.index(to)];
      RC_ASSERT(nearly(neighbourhood_distance(kMiddle, to, k), expected));
      RC_ASSERT(nearly(neighbourhood_distance(to, kMiddle, k), expected));
    }
  });

  passed &=
      property("excess_cells: what Dijkstra's algorithm finds among obstacles beyond the empty grid", [] {
        MazeDistances drawn;
        auto& [maze, k, line_of_sight, steps, distances] = drawn;
        RC_PRE(!maze.legal.empty());
        // Some goals come again, with what is known of them.
        const std::vector<Cell> goals{drawn.any_place(), drawn.any_place()};
        bool longer = false;
        for (int round = 0; round < 3; ++round) {
          const Cell goal = *rc::gen::elementOf(goals);
          const std::vector<double> paths = drawn.paths_from(goal);
          distances.set_goal(goal, drawn.any_place());
          for (int i = 0; i < 5; ++i) {
            const Cell cell = drawn.any_place();
            const double path = paths[maze.map.index(cell)];
            const double excess = distances.excess_cells(cell);
            if (path == std::numeric_limits<double>::infinity()) {
              RC_ASSERT(excess == path);
            } else {
              const double found = neighbourhood_distance(cell, goal, k) + excess;
              RC_ASSERT(nearly(found, path) || (found < path && found > path * (1 - kLostOfSteps)));
              RC_ASSERT(excess == 0 || excess > kRoundingCells);
              longer = longer || excess > 0;
            }
          }
        }
        RC_CLASSIFY(longer, "some paths longer than on the empty grid");
      });

  passed &= property("turning_point: in sight, and on a shortest path that turns", [] {
    MazeDistances drawn;
    auto& [maze, k, line_of_sight, steps, distances] = drawn;
    RC_PRE(!maze.legal.empty());
    const Cell goal = drawn.any_place();
    const std::vector<double> to_goal = drawn.paths_from(goal);
    distances.set_goal(goal, drawn.any_place());
    int turns = 0;
    for (int i = 0; i < 5; ++i) {
      const Cell cell = drawn.any_place();
      const Cell turn = distances.turning_point(cell);
      const double path = to_goal[maze.map.index(cell)];
      if (turn == cell) {
        RC_ASSERT(path == std::numeric_limits<double>::infinity() || line_of_sight.is_clear(cell, goal));
        continue;
      }
      ++turns;
      RC_ASSERT(line_of_sight.is_clear(cell, turn));
      const std::vector<double> to_turn = drawn.paths_from(turn);
      RC_ASSERT(turn != goal);
      RC_ASSERT(nearly(to_turn[maze.map.index(cell)] + to_goal[maze.map.index(turn)], path));
    }
    RC_CLASSIFY(turns > 0, "some turn");
  });

  passed &= property("neighbourhood: each of the 2^k directions that halving sectors gives, once", [] {
    const int k = *rc::gen::inRange(kMinConnectedness, kMaxConnectedness + 1);
    const auto given = neighbourhood(k);
    std::vector<Cell> steps(given.begin(), given.end());
    std::vector<Cell> expected = mediant_neighbourhood(k);
    const auto before = [](Cell a, Cell b) { return std::pair(a.x, a.y) < std::pair(b.x, b.y); };
    std::sort(steps.begin(), steps.end(), before);
    std::sort(expected.begin(), expected.end(), before);
    RC_ASSERT(steps == expected);
  });

  passed &= property("neighbourhood_distance: one step never saves more than its length", [] {
    const Cell from = any_far_cell();
    const Cell to = any_far_cell();
    const int k = *rc::gen::inRange(kMinConnectedness, kMaxConnectedness + 1);
    const double whole = neighbourhood_distance(from, to, k);
    for (const Cell step : neighbourhood(k)) {
      const Cell next{from.x + step.x, from.y + step.y};
      RC_ASSERT(whole <= distance(from, next) + neighbourhood_distance(next, to, k) + kRoundingCells);
    }
  });

  passed &= property("neighbourhood_distance: more neighbours shorten paths, down to the straight line", [] {
    const Cell from = any_far_cell();
    const Cell to = any_far_cell();
    double shorter = distance(from, to);
    for (int k = kMaxConnectedness; k >= kMinConnectedness; --k) {
      const double path = neighbourhood_distance(from, to, k);
      RC_ASSERT(path >= shorter - kRoundingCells);
      RC_ASSERT(path == neighbourhood_distance(to, from, k));
      shorter = path;
    }
    RC_ASSERT(neighbourhood_distance(from, from, kMaxConnectedness) == 0);
  });

  return passed;
});

}  // namespace
}  // namespace sipplab::neighbourhood_laws
