#include "planner/improve/static_times.hpp"

#include <algorithm>
#include <cmath>
#include <memory>
#include <queue>

#include "planner/grid/neighbourhood.hpp"
#include "planner/grid/step_table.hpp"
#include "sipplab/geometry.hpp"

namespace sipplab {
namespace {

/// A possible turning point of a path.
struct Corner {
  Cell cell;
  double from_start = kForever;  ///< length of the shortest path known, in cells
  double to_goal = 0;            ///< straight
  bool is_settled = false;
};

/// Cells that some path shorter than `longest` could pass, the start first: those of an ellipse about the
/// ends.
std::vector<Corner> cells_of_ellipse(const GridMap& map, const LineOfSight& line_of_sight, Cell from, Cell to,
                                     double longest) {
  std::vector<Corner> corners = {{from, 0, distance(from, to)}};
  // First and last coordinate of the ellipse in one direction, within the map; `across`: distance of the ends
  // in the other.
  const auto extent = [longest](double one, double other, double across, std::int32_t side) {
    const double middle = (one + other) / 2;
    const double half = std::sqrt(std::max(longest * longest - across * across, 0.0)) / 2;
    return std::pair{static_cast<std::int32_t>(std::max(std::floor(middle - half), 0.0)),
                     static_cast<std::int32_t>(std::min(std::ceil(middle + half), side - 1.0))};
  };
  const auto [left, right] = extent(from.x, to.x, from.y - to.y, map.width());
  const auto [top, bottom] = extent(from.y, to.y, from.x - to.x, map.height());
  for (std::int32_t y = top; y <= bottom; ++y) {
    for (std::int32_t x = left; x <= right; ++x) {
      const Cell cell{x, y};
      if (cell == from || cell == to || !line_of_sight.is_legal(cell)) continue;
      const double to_goal = distance(cell, to);
      if (distance(from, cell) + to_goal < longest) corners.push_back({cell, kForever, to_goal});
    }
  }
  return corners;
}

struct OpenCell {
  double f;
  std::size_t index;

  friend bool operator>(const OpenCell& a, const OpenCell& b) {
    return a.f != b.f ? a.f > b.f : a.index > b.index;
  }
};
using OpenCells = std::priority_queue<OpenCell, std::vector<OpenCell>, std::greater<>>;

}  // namespace

double shortest_any_angle_cells(const GridMap& map, const LineOfSight& line_of_sight, Cell from, Cell to,
                                double longest, std::size_t most_work) {
  if (line_of_sight.is_clear(from, to)) return distance(from, to);
  std::vector<Corner> corners = cells_of_ellipse(map, line_of_sight, from, to, longest);
  OpenCells open;
  open.push({corners[0].to_goal, 0});
  double shortest = longest;
  std::size_t work = 0;
  while (!open.empty()) {
    const OpenCell least = open.top();
    open.pop();
    if (least.f >= shortest) break;
    Corner& here = corners[least.index];
    if (here.is_settled) continue;
    here.is_settled = true;
    work += corners.size();
    if (work > most_work) return least.f;
    if (here.from_start + here.to_goal < shortest && line_of_sight.is_clear(here.cell, to)) {
      shortest = here.from_start + here.to_goal;
    }
    for (std::size_t i = 1; i < corners.size(); ++i) {
      Corner& next = corners[i];
      if (next.is_settled) continue;
      const double path = here.from_start + distance(here.cell, next.cell);
      if (path >= next.from_start || path + next.to_goal >= shortest) continue;
      if (!line_of_sight.is_clear(here.cell, next.cell)) continue;
      next.from_start = path;
      open.push({path + next.to_goal, i});
    }
  }
  return shortest;
}

double shortest_grid_cells(const GridMap& map, const LineOfSight& line_of_sight, Cell from, Cell to, int k) {
  StepTable steps(line_of_sight, map.cell_count(), k);
  std::vector<double> from_start(map.cell_count(), kForever);
  OpenCells open;
  from_start[map.index(from)] = 0;
  open.push({neighbourhood_distance(from, to, k), map.index(from)});
  std::vector<bool> settled(map.cell_count());
  while (!open.empty()) {
    const std::size_t index = open.top().index;
    open.pop();
    if (settled[index]) continue;
    settled[index] = true;
    const Cell here = map.cell(index);
    if (here == to) return from_start[index];
    const std::uint32_t clear = steps.clear_steps(here, index);
    const std::span<const Cell> all = neighbourhood(k);
    for (std::size_t i = 0; i < all.size(); ++i) {
      if ((clear >> i & 1) == 0) continue;
      const Cell next{here.x + all[i].x, here.y + all[i].y};
      const double path = from_start[index] + distance(here, next);
      if (path >= from_start[map.index(next)]) continue;
      from_start[map.index(next)] = path;
      open.push({path + neighbourhood_distance(next, to, k), map.index(next)});
    }
  }
  return kForever;
}

namespace {

/// Lines of sight of one thread: they keep their answers.
class LinesOfSight {
 public:
  explicit LinesOfSight(const GridMap& map) : map_(map) {}

  const LineOfSight& of(double radius_cells) {
    auto known = std::find_if(all_.begin(), all_.end(),
                              [&](const auto& other) { return other->radius_cells() == radius_cells; });
    if (known == all_.end()) known = all_.insert(known, std::make_unique<LineOfSight>(map_, radius_cells));
    return **known;
  }

 private:
  const GridMap& map_;
  std::vector<std::unique_ptr<LineOfSight>> all_;  ///< one for each radius
};

}  // namespace

std::vector<double> static_times_s(const Instance& instance, bool any_angle, int connectedness,
                                   const std::vector<double>& solo_cells, const SearchLimits& limits,
                                   std::size_t most_work_of_all) {
  const std::size_t robots = instance.agents.size();
  const std::size_t most_work =
      std::min(kMostStaticWork, most_work_of_all / std::max<std::size_t>(robots, 1));
  LinesOfSight lines_of_sight(instance.map);
  std::vector<double> times_s(robots);
  for (AgentIndex i = 0; i < robots; ++i) {
    const Agent& agent = instance.agents[i];
    const LineOfSight& sight = lines_of_sight.of(agent.radius_cells);
    const double straight = distance(agent.start, agent.goal);
    double cells = straight;
    if (!limits.is_over()) {
      cells = any_angle ? shortest_any_angle_cells(instance.map, sight, agent.start, agent.goal,
                                                   solo_cells[i], most_work)
                        : shortest_grid_cells(instance.map, sight, agent.start, agent.goal, connectedness);
    }
    // Who cannot get there at all has the bound of a straight line.
    times_s[i] = (cells == kForever ? straight : cells) / agent.speed_cells_per_s;
  }
  return times_s;
}

double gap(double cost_s, double bound_s) { return cost_s > bound_s ? (cost_s - bound_s) / cost_s : 0.0; }

LowerBound lower_bound(const std::vector<double>& static_times_s) {
  LowerBound bound;
  for (const double time_s : static_times_s) {
    bound.flowtime_s += time_s;
    bound.makespan_s = std::max(bound.makespan_s, time_s);
  }
  return bound;
}

LowerBound lower_bound(const Instance& instance, bool any_angle, int connectedness, std::size_t most_work) {
  const std::size_t robots = std::max<std::size_t>(instance.agents.size(), 1);
  if (instance.map.cell_count() > most_work / robots) {
    std::vector<double> times_s;
    for (const Agent& agent : instance.agents) {
      times_s.push_back((any_angle ? distance(agent.start, agent.goal)
                                   : neighbourhood_distance(agent.start, agent.goal, connectedness)) /
                        agent.speed_cells_per_s);
    }
    return lower_bound(times_s);
  }
  LinesOfSight lines_of_sight(instance.map);
  std::vector<double> solo_cells;
  for (const Agent& agent : instance.agents) {
    const LineOfSight& sight = lines_of_sight.of(agent.radius_cells);
    double cells = distance(agent.start, agent.goal);
    if (any_angle && !sight.is_clear(agent.start, agent.goal)) {
      cells = shortest_grid_cells(instance.map, sight, agent.start, agent.goal, connectedness);
    }
    solo_cells.push_back(cells);  // kForever: no steps; a large body may still have a path
  }
  std::vector<double> times_s = static_times_s(instance, any_angle, connectedness, solo_cells, {}, most_work);
  return lower_bound(times_s);
}

}  // namespace sipplab
