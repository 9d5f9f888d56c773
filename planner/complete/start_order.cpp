#include "planner/complete/start_order.hpp"

#include <algorithm>
#include <cstddef>
#include <functional>
#include <limits>
#include <queue>
#include <span>
#include <unordered_map>

namespace sipplab {
namespace {

/// Seconds. Rounding of arrivals: a robot that comes near a start only when the guarantee ends breaks it by
/// less.
constexpr double kSameTimeS = 1e-9;

/// `later` comes near the start of `earlier` from some time on, so it has to come later in
/// the order.
struct Crossing {
  double from_s = 0;
  RobotId earlier = 0;
  RobotId later = 0;
};

/// Sorted by time. `pardon_goals`: robots whose goal is the start are left out.
std::vector<Crossing> crossings(const Instance& instance, const Visits& visits,
                                const std::vector<double>& arrivals_s, double until_s, bool pardon_goals) {
  std::unordered_map<CellId, RobotId> start_of;
  for (RobotId robot = 0; robot < visits.robots(); ++robot) {
    start_of.emplace(visits[visits.first_of(robot)].cell, robot);
  }
  std::vector<Crossing> found;
  for (RobotId robot = 0; robot < visits.robots(); ++robot) {
    const Agent& agent = instance.agents[robot];
    const double unit_move_s = 1 / agent.speed_cells_per_s;
    CellId goal = kNoCell;
    for (VisitId id = visits.first_of(robot); id != kNoVisit; id = visits[id].after) goal = visits[id].cell;
    for (VisitId id = visits[visits.first_of(robot)].after; id != kNoVisit; id = visits[id].after) {
      const auto owner = start_of.find(visits[id].cell);
      if (owner == start_of.end() || owner->second == robot) continue;
      if (pardon_goals && visits[id].cell == goal) continue;
      // The robot comes from a neighbour and is too near once it is within the two radii.
      const double reach_cells = agent.radius_cells + instance.agents[owner->second].radius_cells;
      const double from_s = arrivals_s[id] - reach_cells * unit_move_s;
      if (from_s < until_s - kSameTimeS) found.push_back({from_s, owner->second, robot});
    }
  }
  std::stable_sort(found.begin(), found.end(),
                   [](const Crossing& a, const Crossing& b) { return a.from_s < b.from_s; });
  return found;
}

/// The first order, in the order of input, that keeps these apart; shorter than the number of
/// robots if there is none (Kahn 1962).
std::vector<AgentIndex> sorted_order(std::size_t robots, std::span<const Crossing> kept) {
  std::vector<std::uint32_t> waits_for(robots, 0);
  std::vector<std::vector<RobotId>> released_by(robots);
  for (const Crossing& crossing : kept) {
    ++waits_for[crossing.later];
    released_by[crossing.earlier].push_back(crossing.later);
  }
  std::priority_queue<RobotId, std::vector<RobotId>, std::greater<>> ready;
  for (RobotId robot = 0; robot < robots; ++robot) {
    if (waits_for[robot] == 0) ready.push(robot);
  }
  std::vector<AgentIndex> order;
  while (!ready.empty()) {
    const RobotId robot = ready.top();
    ready.pop();
    order.push_back(robot);
    for (const RobotId other : released_by[robot]) {
      if (--waits_for[other] == 0) ready.push(other);
    }
  }
  return order;
}

}  // namespace

StartOrder longest_kept_order(const Instance& instance, const Visits& visits,
                              const std::vector<double>& arrivals_s, double wanted_s) {
  const std::size_t robots = visits.robots();
  constexpr double kForEver = std::numeric_limits<double>::infinity();
  if (wanted_s == kForEver) {
    std::vector<AgentIndex> order =
        sorted_order(robots, crossings(instance, visits, arrivals_s, kForEver, true));
    if (order.size() == robots) return {std::move(order), kForEver};
  }
  const std::vector<Crossing> all = crossings(instance, visits, arrivals_s, wanted_s, false);
  const auto order_of_first = [&](std::size_t count) {
    return sorted_order(robots, std::span(all).first(count));
  };
  // The first crossings can be kept apart up to some number of them: bisection.
  std::size_t possible = 0;
  std::size_t impossible = all.size() + 1;
  while (impossible - possible > 1) {
    const std::size_t middle = possible + (impossible - possible) / 2;
    (order_of_first(middle).size() == robots ? possible : impossible) = middle;
  }
  if (possible == all.size()) return {order_of_first(possible), wanted_s};
  // Those that begin only when the guarantee ends need not be kept apart.
  const double kept_s = std::max(0.0, all[possible].from_s);
  const auto first_after =
      std::partition_point(all.begin(), all.begin() + static_cast<std::ptrdiff_t>(possible),
                           [&](const Crossing& crossing) { return crossing.from_s < kept_s - kSameTimeS; });
  return {order_of_first(static_cast<std::size_t>(first_after - all.begin())), kept_s};
}

}  // namespace sipplab
