#include "planner/retime/steps.hpp"

#include <algorithm>
#include <cstdlib>

#include "planner/retime/unit_schedule.hpp"

namespace sipplab {
namespace {

/// Adds the unit moves of a straight motion along a row or column; false for any other one.
bool add_unit_moves(const Instance& instance, const FreeGrid& grid, const TimedMotion& motion,
                    VisitCollector& collector) {
  const std::int32_t columns = motion.to.x - motion.from.x;
  const std::int32_t rows = motion.to.y - motion.from.y;
  if (columns != 0 && rows != 0) return false;
  const std::int32_t cells = std::abs(columns) + std::abs(rows);
  const auto time_at = [&](std::int32_t cell) {
    return motion.begin_s + (motion.end_s - motion.begin_s) * cell / cells;
  };
  for (std::int32_t i = 1; i <= cells; ++i) {
    const Cell cell{motion.from.x + columns / cells * i, motion.from.y + rows / cells * i};
    if (!instance.map.contains(cell) || instance.map.is_blocked(cell)) return false;
    collector.add_move(grid.id(cell), time_at(i - 1), time_at(i));
  }
  return true;
}

}  // namespace

std::optional<std::vector<std::vector<Cell>>> discrete_steps(const Instance& instance,
                                                             const Solution& solution) {
  const FreeGrid grid(instance.map);
  VisitCollector collector(grid.size());
  for (const Trajectory& trajectory : solution.trajectories) {
    if (!instance.map.contains(trajectory.start) || instance.map.is_blocked(trajectory.start))
      return std::nullopt;
    collector.add_robot(grid.id(trajectory.start));
    for (const TimedMotion& motion : trajectory.motions) {
      if (!motion.is_wait() && !add_unit_moves(instance, grid, motion, collector)) return std::nullopt;
    }
  }
  const std::optional<Visits> visits = std::move(collector).take();
  if (!visits) return std::nullopt;
  const std::vector<std::int64_t> steps = unit_steps(grid, *visits);
  if (steps.size() != visits->size()) return std::nullopt;  // two robots that change places
  std::vector<std::vector<Cell>> cells(visits->robots());
  for (RobotId robot = 0; robot < visits->robots(); ++robot) {
    std::vector<Cell>& path = cells[robot];
    for (VisitId id = visits->first_of(robot); id != kNoVisit; id = (*visits)[id].after) {
      while (static_cast<std::int64_t>(path.size()) < steps[id]) path.push_back(path.back());
      path.push_back(grid.cell((*visits)[id].cell));
    }
  }
  return cells;
}

}  // namespace sipplab
