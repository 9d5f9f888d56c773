#include "planner/grid/free_grid.hpp"

#include "planner/grid/neighbourhood.hpp"

namespace sipplab {

FreeGrid::FreeGrid(const GridMap& map)
    : width_(static_cast<std::size_t>(map.width())), ids_(map.cell_count(), kNoCell) {
  for (std::size_t index = 0; index < map.cell_count(); ++index) {
    const Cell cell = map.cell(index);
    if (map.is_blocked(cell)) continue;
    ids_[index] = static_cast<CellId>(cells_.size());
    cells_.push_back(cell);
  }
  begins_.reserve(cells_.size() + 1);
  for (const Cell cell : cells_) {
    begins_.push_back(static_cast<std::uint32_t>(neighbours_.size()));
    for (const Cell step : neighbourhood(kMinConnectedness)) {
      const Cell next{cell.x + step.x, cell.y + step.y};
      if (map.contains(next) && !map.is_blocked(next)) neighbours_.push_back(id(next));
    }
  }
  begins_.push_back(static_cast<std::uint32_t>(neighbours_.size()));
}

}  // namespace sipplab
