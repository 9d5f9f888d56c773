#include "planner/complete/goal_distances.hpp"

#include <utility>

namespace sipplab {

GoalDistances::GoalDistances(const FreeGrid& grid, std::vector<CellId> goals)
    : grid_(grid), goals_(std::move(goals)), searches_(goals_.size()) {
  for (RobotId robot = 0; robot < goals_.size(); ++robot) {
    Search& search = searches_[robot];
    search.codes.resize(grid.size() / kCellsPerByte + 1);
    search.layer = {goals_[robot]};
    search.set_code(goals_[robot], 1);
  }
}

std::optional<std::uint32_t> GoalDistances::first_distance(RobotId robot, CellId cell) {
  Search& search = searches_[robot];
  while (search.code(cell) == kUnseen) {
    if (!grow(search)) return std::nullopt;
  }
  return search.depth;
}

bool GoalDistances::grow(Search& search) {
  std::vector<CellId>& next_layer = search.next_layer;
  next_layer.clear();
  const unsigned code = 1 + (search.depth + 1) % 3;
  for (const CellId cell : search.layer) {
    for (const CellId next : grid_.neighbours(cell)) {
      if (search.code(next) != kUnseen) continue;
      search.set_code(next, code);
      next_layer.push_back(next);
    }
  }
  if (next_layer.empty()) return false;
  std::swap(search.layer, next_layer);
  ++search.depth;
  return true;
}

}  // namespace sipplab
