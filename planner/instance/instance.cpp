// The rules an instance has to keep, and its hash; see instance.hpp.
#include "sipplab/instance.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <string_view>

#include "planner/core/tolerances.hpp"
#include "planner/instance/disk_lookup.hpp"
#include "planner/solution/digest.hpp"

namespace sipplab {
namespace {

/// Seconds. Ends of obstacles' motions: at this time a double resolves 2e-9 s. Robots that wait for an
/// obstacle much longer lose the slack that tells contacts from overlaps.
constexpr double kMaxObstacleTimeS = 1e7;
/// Relative error that rounding of times may cause in the speed of an obstacle's motion: some ulp of 1e3 s
/// over a thousandth of a second.
constexpr double kSpeedRounding = 1e-9;
/// Cells. An obstacle may come from beyond the grid, but not from farther away
/// than the widest grid.
constexpr std::int32_t kMaxObstacleDistance = static_cast<std::int32_t>(GridMap::kMaxSide);

std::string text(Cell cell) { return fmt::format("({}, {})", cell.x, cell.y); }

std::string label(std::string_view kind, const std::string& id, std::size_t position) {
  return fmt::format("{} {}", kind, id.empty() ? std::to_string(position) : id);
}

struct Rule {
  std::string what;
  std::string expected;
};
using Broken = std::optional<Rule>;

bool in_range(double value, double least, double most) { return value >= least && value <= most; }

Broken check_radius(double radius_cells) {
  if (in_range(radius_cells, kMinRadiusCells, kMaxRadiusCells)) return std::nullopt;
  return Rule{fmt::format("radius {}", radius_cells),
              fmt::format("a number from {} to {}", kMinRadiusCells, kMaxRadiusCells)};
}

Broken check_heading(std::string_view which, double heading_deg) {
  if (heading_deg >= 0 && heading_deg < 360) return std::nullopt;
  return Rule{fmt::format("{} heading {}", which, heading_deg), "a number from 0 to less than 360"};
}

Broken check_numbers(const Agent& agent) {
  if (Broken broken = check_radius(agent.radius_cells)) return broken;
  if (!in_range(agent.speed_cells_per_s, kMinSpeedCellsPerS, kMaxSpeedCellsPerS)) {
    return Rule{fmt::format("speed {}", agent.speed_cells_per_s),
                fmt::format("a number from {} to {}", kMinSpeedCellsPerS, kMaxSpeedCellsPerS)};
  }
  if (!in_range(agent.rotation_speed, kMinRotationSpeed, kMaxRotationSpeed)) {
    return Rule{fmt::format("rotation speed {}", agent.rotation_speed),
                fmt::format("a number from {} to {}", kMinRotationSpeed, kMaxRotationSpeed)};
  }
  if (Broken broken = check_heading("start", agent.start_heading_deg)) return broken;
  return agent.goal_heading_deg ? check_heading("goal", *agent.goal_heading_deg) : std::nullopt;
}

/// The first blocked cell that a body at rest overlaps, row by row.
/// REQUIRES: the body lies inside the grid.
std::optional<Cell> find_blocked_cell(const GridMap& map, Cell cell, double radius_cells) {
  const auto reach = static_cast<std::int32_t>(std::ceil(radius_cells));
  // A coordinate's distance to the nearest point of a unit square `offset` cells away.
  const auto gap = [](std::int32_t offset) {
    return std::max(0.0, std::abs(static_cast<double>(offset)) - 0.5);
  };
  for (std::int32_t y = std::max(0, cell.y - reach); y <= std::min(map.height() - 1, cell.y + reach); ++y) {
    for (std::int32_t x = std::max(0, cell.x - reach); x <= std::min(map.width() - 1, cell.x + reach); ++x) {
      if (!map.is_blocked({x, y})) continue;
      if (norm({gap(x - cell.x), gap(y - cell.y)}) < radius_cells - kTouchDepthCells) return Cell{x, y};
    }
  }
  return std::nullopt;
}

/// `which` is "start" or "goal".
Broken check_place(const GridMap& map, std::string_view which, Cell cell, double radius_cells) {
  if (!map.contains(cell)) {
    return Rule{fmt::format("{} {} is outside the grid", which, text(cell)),
                fmt::format("a cell of the {} x {} grid", map.width(), map.height())};
  }
  if (map.is_blocked(cell)) return Rule{fmt::format("{} {} is blocked", which, text(cell)), "a free cell"};

  const double to_border_cells =
      0.5 + std::min({cell.x, cell.y, map.width() - 1 - cell.x, map.height() - 1 - cell.y});
  if (to_border_cells < radius_cells - kTouchDepthCells) {
    return Rule{fmt::format("body of radius {} at {} {} leaves the grid", radius_cells, which, text(cell)),
                "a body inside the grid"};
  }
  if (const auto blocked = find_blocked_cell(map, cell, radius_cells)) {
    return Rule{fmt::format("body of radius {} at {} {} overlaps blocked cell {}", radius_cells, which,
                            text(cell), text(*blocked)),
                "a body on free cells"};
  }
  return std::nullopt;
}

Broken check_path(const Trajectory& trajectory, const GridMap& map) {
  const auto far_away = [&](Cell cell) {
    const auto off = [](std::int32_t coordinate, std::int32_t side) {
      return coordinate < -kMaxObstacleDistance || coordinate > side + kMaxObstacleDistance;
    };
    return off(cell.x, map.width()) || off(cell.y, map.height());
  };
  const auto too_far = [&](Cell cell) {
    return Rule{fmt::format("position {} is far outside the grid", text(cell)),
                fmt::format("at most {} cells from it", kMaxObstacleDistance)};
  };
  if (far_away(trajectory.start)) return too_far(trajectory.start);

  Cell place = trajectory.start;
  double time_s = 0;
  for (std::size_t i = 0; i < trajectory.motions.size(); ++i) {
    const TimedMotion& motion = trajectory.motions[i];
    if (motion.from != place) {
      return Rule{fmt::format("motion {} begins at {}", i, text(motion.from)),
                  fmt::format("{}, where the obstacle is", text(place))};
    }
    if (!(motion.begin_s == time_s)) {
      return Rule{fmt::format("motion {} begins at time {}", i, motion.begin_s),
                  fmt::format("time {}", time_s)};
    }
    if (!(motion.end_s > motion.begin_s && motion.end_s <= kMaxObstacleTimeS)) {
      return Rule{fmt::format("motion {} ends at time {}", i, motion.end_s),
                  fmt::format("a time after {} and up to {}", motion.begin_s, kMaxObstacleTimeS)};
    }
    if (far_away(motion.to)) return too_far(motion.to);
    const double speed = distance(motion.from, motion.to) / (motion.end_s - motion.begin_s);
    if (!(speed <= kMaxSpeedCellsPerS * (1 + kSpeedRounding))) {
      return Rule{fmt::format("motion {} has speed {}", i, speed),
                  fmt::format("at most {}", kMaxSpeedCellsPerS)};
    }
    place = motion.to;
    time_s = motion.end_s;
  }
  return std::nullopt;
}

std::optional<InstanceError> find_agent_error(const Instance& instance, DiskLookup& starts) {
  const std::vector<Agent>& agents = instance.agents;
  DiskLookup goals;
  for (AgentIndex i = 0; i < agents.size(); ++i) {
    const Agent& agent = agents[i];
    const auto error = [&](const Rule& rule) {
      return InstanceError{i, std::nullopt, label("agent", agent.id, i) + ": " + rule.what, rule.expected};
    };
    if (const Broken broken = check_numbers(agent)) return error(*broken);

    const auto settle = [&](std::string_view which, Cell cell, DiskLookup& others) -> Broken {
      if (Broken broken = check_place(instance.map, which, cell, agent.radius_cells)) return broken;
      if (const auto other = others.find_overlap(cell, agent.radius_cells)) {
        return Rule{fmt::format("{} {} overlaps the {} of {}", which, text(cell), which,
                                label("agent", agents[*other].id, *other)),
                    fmt::format("{}s that at most touch", which)};
      }
      others.add(i, cell, agent.radius_cells);
      return std::nullopt;
    };
    if (const Broken broken = settle("start", agent.start, starts)) return error(*broken);
    if (const Broken broken = settle("goal", agent.goal, goals)) return error(*broken);
  }
  return std::nullopt;
}

}  // namespace

double largest_radius_cells(const Instance& instance) {
  double largest = 0;
  for (const Agent& agent : instance.agents) largest = std::max(largest, agent.radius_cells);
  return largest;
}

std::optional<InstanceError> find_error(const Instance& instance) {
  DiskLookup starts;
  if (auto error = find_agent_error(instance, starts)) return error;

  for (std::size_t i = 0; i < instance.obstacles.size(); ++i) {
    const DynamicObstacle& obstacle = instance.obstacles[i];
    const auto error = [&](std::optional<AgentIndex> agent, const Rule& rule) {
      return InstanceError{agent, i, label("obstacle", obstacle.id, i) + ": " + rule.what, rule.expected};
    };
    if (const Broken broken = check_radius(obstacle.radius_cells)) return error(std::nullopt, *broken);
    if (const Broken broken = check_path(obstacle.trajectory, instance.map))
      return error(std::nullopt, *broken);
    if (const auto agent = starts.find_overlap(obstacle.trajectory.start, obstacle.radius_cells)) {
      return error(*agent,
                   {fmt::format("stands at {} on the start of {} at time 0", text(obstacle.trajectory.start),
                                label("agent", instance.agents[*agent].id, *agent)),
                    "a place that no start overlaps"});
    }
  }
  return std::nullopt;
}

std::string content_hash(const Instance& instance) {
  Digest digest("sipplab instance 1");
  digest.add(static_cast<std::uint64_t>(instance.map.width()));
  digest.add(static_cast<std::uint64_t>(instance.map.height()));
  std::string cells(instance.map.cell_count(), '.');
  for (std::size_t i = 0; i < cells.size(); ++i) {
    if (instance.map.is_blocked(instance.map.cell(i))) cells[i] = '@';
  }
  digest.add(cells);

  digest.add(static_cast<std::uint64_t>(instance.agents.size()));
  for (const Agent& agent : instance.agents) {
    digest.add(agent.start);
    digest.add(agent.goal);
    digest.add(agent.radius_cells);
    digest.add(agent.speed_cells_per_s);
    digest.add(agent.start_heading_deg);
    digest.add(static_cast<std::uint64_t>(agent.goal_heading_deg.has_value()));
    digest.add(agent.goal_heading_deg.value_or(0));
    digest.add(agent.rotation_speed);
  }
  digest.add(static_cast<std::uint64_t>(instance.obstacles.size()));
  for (const DynamicObstacle& obstacle : instance.obstacles) {
    digest.add(obstacle.radius_cells);
    digest.add(obstacle.trajectory);
  }
  return digest.hex();
}

}  // namespace sipplab
