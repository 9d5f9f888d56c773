#include "property_tests/support/pebble_search.hpp"

#include <algorithm>
#include <set>
#include <vector>

namespace sipplab {
namespace {

using Arrangement = std::vector<Cell>;

std::vector<Arrangement> neighbours(const GridMap& map, const Arrangement& from) {
  std::vector<Arrangement> reached;
  for (std::size_t robot = 0; robot < from.size(); ++robot) {
    for (const Cell step : {Cell{1, 0}, Cell{-1, 0}, Cell{0, 1}, Cell{0, -1}}) {
      const Cell to{from[robot].x + step.x, from[robot].y + step.y};
      if (!map.contains(to) || map.is_blocked(to)) continue;
      if (std::find(from.begin(), from.end(), to) != from.end()) continue;
      reached.push_back(from);
      reached.back()[robot] = to;
    }
  }
  return reached;
}

}  // namespace

PlanCase within_complete_model(PlanCase plan_case) {
  plan_case.instance.obstacles.clear();
  for (Agent& agent : plan_case.instance.agents) {
    agent.radius_cells = std::min(agent.radius_cells, kDefaultRadiusCells);
    agent.speed_cells_per_s = plan_case.instance.agents.front().speed_cells_per_s;
  }
  return plan_case;
}

bool pebble_search_is_small(const Instance& instance) {
  const std::size_t free_cells = instance.map.cell_count() - instance.map.blocked_count();
  double arrangements = 1;
  for (std::size_t i = 0; i < instance.agents.size(); ++i) {
    arrangements *= static_cast<double>(free_cells) - static_cast<double>(i);
  }
  return arrangements <= kMostArrangements;
}

PebbleSearch search_by_pebbles(const Instance& instance) {
  Arrangement starts;
  Arrangement goals;
  for (const Agent& agent : instance.agents) {
    starts.push_back(agent.start);
    goals.push_back(agent.goal);
  }
  std::set<Arrangement> seen{starts};
  std::vector<Arrangement> open{starts};
  while (!open.empty()) {
    const Arrangement from = std::move(open.back());
    open.pop_back();
    if (from == goals) return {true, seen.size()};
    for (Arrangement& to : neighbours(instance.map, from)) {
      if (seen.insert(to).second) open.push_back(std::move(to));
    }
  }
  return {false, seen.size()};
}

bool is_solvable_by_pebbles(const Instance& instance) { return search_by_pebbles(instance).is_solvable; }

}  // namespace sipplab
