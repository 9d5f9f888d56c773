#include "planner/unit_moves/unit_moves.hpp"

#include "sipplab/error.hpp"

namespace sipplab {
namespace {

constexpr std::array<Cell, kDirections> kSteps = {Cell{1, 0}, Cell{0, 1}, Cell{-1, 0}, Cell{0, -1}};

}  // namespace

UnitMoves::UnitMoves(const FreeGrid& grid, double reach_cells) : grid_(grid), next_(grid.size()) {
  for (CellId cell = 0; cell < grid.size(); ++cell) {
    next_[cell].fill(kNoCell);
    const Cell here = grid.cell(cell);
    for (const CellId neighbour : grid.neighbours(cell)) {
      const Cell there = grid.cell(neighbour);
      for (Direction direction = 0; direction < kDirections; ++direction) {
        const Cell step = kSteps[direction];
        if (there == Cell{here.x + step.x, here.y + step.y}) next_[cell][direction] = neighbour;
      }
    }
  }
  for (Direction left = 0; left < kDirections; ++left) {
    for (Direction entered = 0; entered < kDirections; ++entered) {
      lags_[left][entered] = follow_ticks(kSteps[left], kSteps[entered], reach_cells);
    }
  }
}

Direction UnitMoves::direction(CellId from, CellId to) const {
  Direction direction = 0;
  while (next_[from][direction] != to) ++direction;
  PLANNER_ASSERT(direction < kDirections);
  return direction;
}

}  // namespace sipplab
