#include "property_tests/support/plain_twins.hpp"

#include <algorithm>
#include <queue>
#include <unordered_map>
#include <utility>

#include "planner/geometry/collision_interval.hpp"
#include "planner/grid/line_of_sight.hpp"
#include "planner/grid/neighbourhood.hpp"
#include "property_tests/support/interval_set.hpp"

namespace sipplab {

std::vector<SafeInterval> PlainTable::safe_intervals(Cell cell, double radius_cells) const {
  IntervalSet safe;
  for (const MovingDisk& disk : disks) {
    const OpenInterval unsafe = collision_interval(centre(cell), disk, radius_cells + disk.radius);
    if (unsafe.empty()) continue;
    safe.remove_open({unsafe.begin_s - time_margin_s, unsafe.end_s + time_margin_s});
  }
  return {safe.intervals().begin(), safe.intervals().end()};
}

double PlainTable::earliest_departure(const Move& move, double radius_cells, double from_s,
                                      double until_s) const {
  double departure_s = from_s;
  bool moved = true;
  while (moved && departure_s <= until_s && departure_s < kForever) {
    moved = false;
    for (const MovingDisk& disk : disks) {
      OpenInterval unsafe = unsafe_departures(move, disk, radius_cells + disk.radius);
      if (unsafe.empty()) continue;
      unsafe = {unsafe.begin_s - time_margin_s, unsafe.end_s + time_margin_s};
      if (!unsafe.contains(departure_s)) continue;
      departure_s = unsafe.end_s;
      moved = true;
    }
  }
  return departure_s;
}

std::optional<double> plain_arrival_s(const GridMap& map, const PlainTable& table, const Agent& agent,
                                      int k) {
  struct State {
    Cell cell;
    SafeInterval interval;
    double arrival_s = kForever;
  };
  const LineOfSight sight(map, agent.radius_cells);
  std::vector<State> states;
  std::unordered_map<std::size_t, std::pair<std::size_t, std::size_t>> states_of_cell;
  const auto states_of = [&](Cell cell) {
    const auto [found, is_new] = states_of_cell.try_emplace(map.index(cell));
    if (is_new) {
      found->second.first = states.size();
      for (const SafeInterval& interval : table.safe_intervals(cell, agent.radius_cells)) {
        states.push_back({cell, interval});
      }
      found->second.second = states.size();
    }
    return found->second;
  };
  using Arrival = std::pair<double, std::size_t>;
  std::priority_queue<Arrival, std::vector<Arrival>, std::greater<>> open;
  const auto [start, start_end] = states_of(agent.start);
  if (start == start_end || states[start].interval.begin_s > 0) return std::nullopt;
  states[start].arrival_s = 0;
  open.emplace(0, start);
  while (!open.empty()) {
    const auto [arrival_s, id] = open.top();
    open.pop();
    const State here = states[id];
    if (arrival_s > here.arrival_s) continue;
    if (here.cell == agent.goal && here.interval.end_s == kForever) return arrival_s;
    for (const Cell step : neighbourhood(k)) {
      const Cell cell{here.cell.x + step.x, here.cell.y + step.y};
      if (!sight.is_legal(cell) || !sight.is_clear(here.cell, cell)) continue;
      const Move move(Displacement(centre(here.cell), centre(cell)), agent.speed_cells_per_s);
      const auto [first, last] = states_of(cell);
      for (std::size_t next = first; next != last; ++next) {
        const SafeInterval& stay = states[next].interval;
        const double from_s = std::max(arrival_s, stay.begin_s - move.duration);
        const double until_s = std::min(here.interval.end_s, stay.end_s - move.duration);
        if (from_s > until_s) continue;
        const double departure_s = table.earliest_departure(move, agent.radius_cells, from_s, until_s);
        if (departure_s > until_s || departure_s == kForever) continue;
        const double then_s = std::max(departure_s + move.duration, stay.begin_s);
        if (then_s >= states[next].arrival_s) continue;
        states[next].arrival_s = then_s;
        open.emplace(then_s, next);
      }
    }
  }
  return std::nullopt;
}

}  // namespace sipplab
