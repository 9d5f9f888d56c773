#include "property_tests/support/steps_between.hpp"

#include <deque>
#include <vector>

namespace sipplab {

std::optional<int> steps_between(const GridMap& map, Cell from, Cell to) {
  std::vector<int> steps(map.cell_count(), -1);
  std::deque<Cell> queue{from};
  steps[map.index(from)] = 0;
  while (!queue.empty()) {
    const Cell cell = queue.front();
    queue.pop_front();
    if (cell == to) return steps[map.index(cell)];
    for (const Cell step : {Cell{1, 0}, Cell{-1, 0}, Cell{0, 1}, Cell{0, -1}}) {
      const Cell next{cell.x + step.x, cell.y + step.y};
      if (!map.contains(next) || map.is_blocked(next) || steps[map.index(next)] >= 0) continue;
      steps[map.index(next)] = steps[map.index(cell)] + 1;
      queue.push_back(next);
    }
  }
  return std::nullopt;
}

}  // namespace sipplab
