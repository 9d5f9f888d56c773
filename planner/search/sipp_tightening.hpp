// What Sipp does with a path once it is found: joins straight motions, pulls the path tight, and makes a
// trajectory of its stops. The members of Sipp that deal with stops; sipp_search.cpp instantiates them.
#pragma once

#include <algorithm>

#include "planner/grid/neighbourhood.hpp"
#include "planner/search/sipp_search.hpp"

namespace sipplab {

template <class Motion>
std::optional<Trajectory> Sipp<Motion>::tighten(AgentIndex agent, const Trajectory& given,
                                                Reservations& reservations) {
  if (Motion::kTurns) return std::nullopt;
  auto* const table = dynamic_cast<ReservationTable*>(&reservations);
  PLANNER_ASSERT(table != nullptr);
  begin(instance_.agents[agent], *table);
  std::optional<Stops> stops = stops_of(given);
  if (!stops) return std::nullopt;
  for (std::size_t to = 1; to < stops->size(); ++to) {
    if (!move((*stops)[to - 1], (*stops)[to], (*stops)[to].arrival_s)) return std::nullopt;
  }
  constexpr int kRounds = 2;
  for (int round = 0; options_.any_angle && round < kRounds; ++round) {
    join_lines(*stops);
    pull_tight(*stops);
  }
  join_lines(*stops);
  return reconstruct(*stops);
}

template <class Motion>
std::optional<typename Sipp<Motion>::Stops> Sipp<Motion>::stops_of(const Trajectory& trajectory) {
  Stops stops;
  const auto add = [&](Cell cell, double departure_s, double arrival_s) {
    for (const SafeInterval& interval : reservations_->safe_intervals(cell, agent_->radius_cells)) {
      if (interval.end_s < arrival_s) continue;
      if (interval.begin_s > arrival_s) return false;
      Node& stop = stops.emplace_back();
      stop.x = static_cast<std::int16_t>(cell.x);
      stop.y = static_cast<std::int16_t>(cell.y);
      stop.interval = interval;
      stop.departure_s = departure_s;
      stop.arrival_s = arrival_s;
      return true;
    }
    return false;
  };
  if (!add(trajectory.start, 0, 0)) return std::nullopt;
  for (const TimedMotion& motion : trajectory.motions) {
    if (!motion.is_wait() && !add(motion.to, motion.begin_s, motion.end_s)) return std::nullopt;
  }
  return stops;
}

template <class Motion>
Trajectory Sipp<Motion>::finish(NodeId goal) {
  Stops stops = stops_to(goal);
  if (options_.any_angle) join_lines(stops);
  if (options_.any_angle && options_.elastic) {
    for (int round = 0; round < (options_.weight > 1 ? 2 : 1); ++round) {  // weighted, there is more to gain
      pull_tight(stops);
      join_lines(stops);
    }
  }
  return reconstruct(stops);
}

template <class Motion>
typename Sipp<Motion>::Stops Sipp<Motion>::stops_to(NodeId goal) const {
  Stops stops;
  for (NodeId id = goal; id != kNoNode; id = nodes_[id].parent) stops.push_back(nodes_[id]);
  std::reverse(stops.begin(), stops.end());
  return stops;
}

template <class Motion>
void Sipp<Motion>::join_lines(Stops& stops) {
  std::size_t size = 0;
  for (std::size_t i = 0; i < stops.size(); ++i) {
    Node stop = stops[i];
    if (size >= 2 && stop.departure_s == stops[size - 1].arrival_s &&
        lies_between(stops[size - 2], stops[size - 1], stop)) {
      stop.departure_s = stops[--size].departure_s;
    }
    stops[size++] = stop;
  }
  stops.resize(size);
}

template <class Motion>
void Sipp<Motion>::pull_tight(Stops& stops) {
  constexpr std::size_t kFarthestStop = 8;  // straight moves are tried to this next stop and nearer ones
  constexpr int kStepsAside = 3;            // turning points are moved to one of 2^3 neighbours
  // Seconds: an arrival counts as earlier if it gains this much.
  constexpr double kWorthS = 1e-6;
  // Turning points are moved if the time from the stop before to the one after is at most this many times
  // that of travel: a robot that waits gains nothing from another turning point. (Trials on the paper's
  // instances: all turning points twice cost 15 % of the instructions instead of 5, for as much flowtime.)
  constexpr double kMostWaiting = 1.05;
  for (std::size_t i = 0; i + 2 < stops.size(); ++i) {
    std::size_t k = std::min(stops.size() - 1, i + kFarthestStop);
    while (k >= i + 2 && !reroute(stops, i, k, nullptr, stops[k].arrival_s)) --k;
  }
  for (std::size_t i = 1; i + 1 < stops.size(); ++i) {
    const Cell turning_point = stops[i].cell();
    const double path_s =
        seconds(distance(stops[i - 1].cell(), turning_point) + distance(turning_point, stops[i + 1].cell()));
    if (stops[i + 1].arrival_s - stops[i - 1].arrival_s > kMostWaiting * path_s) continue;
    for (const Cell step : neighbourhood(kStepsAside)) {
      Node beside = stops[i];
      beside.x = static_cast<std::int16_t>(turning_point.x + step.x);
      beside.y = static_cast<std::int16_t>(turning_point.y + step.y);
      reroute(stops, i - 1, i + 1, &beside, stops[i + 1].arrival_s - kWorthS);
    }
  }
}

template <class Motion>
bool Sipp<Motion>::reroute(Stops& stops, std::size_t i, std::size_t k, Node* via, double latest_s) {
  Node last = stops[k];
  const Node* from = &stops[i];
  if (via != nullptr) {
    if (!body_->line_of_sight.is_legal(via->cell())) return false;
    const double by_s = latest_s - seconds(distance(via->cell(), last.cell()));
    const auto enters = [&](const SafeInterval& interval) {
      via->interval = interval;
      return move(*from, *via, by_s, &edge_blocker_);
    };
    if (!std::ranges::any_of(reservations_->safe_intervals(via->cell(), agent_->radius_cells), enters)) {
      return false;
    }
    from = via;
  }
  if (!move(*from, last, latest_s, &shot_blocker_)) return false;
  if constexpr (Motion::kTurns) {  // with another heading it may depart later although it came sooner
    const auto done_s = [&](const Node& stop) {
      return stop.arrival_s + motion_.standing_s(agent_->goal, motion_.heading(stop));
    };
    Node next = k + 1 < stops.size() ? stops[k + 1] : last;
    if (k + 1 < stops.size() ? !move(last, next, next.arrival_s) : done_s(last) > done_s(stops[k])) {
      return false;
    }
  }
  stops[k] = last;
  if (via != nullptr) {
    stops[i + 1] = *via;
  } else {
    stops.erase(stops.begin() + static_cast<std::ptrdiff_t>(i) + 1,
                stops.begin() + static_cast<std::ptrdiff_t>(k));
  }
  // Later stops are left as early as is safe.
  for (std::size_t to = i + (via != nullptr ? 3 : 2); to < stops.size(); ++to) {
    const double departed_s = stops[to].departure_s;
    if (!move(stops[to - 1], stops[to], stops[to].arrival_s) || stops[to].departure_s == departed_s) break;
  }
  return true;
}

template <class Motion>
bool Sipp<Motion>::move(const Node& from, Node& to, double latest_s,
                        ReservationTable::DiskId* likely_blocker) {
  if (from.cell() == to.cell() || from.arrival_s + seconds(distance(from.cell(), to.cell())) > latest_s ||
      !body_->line_of_sight.is_clear(from.cell(), to.cell())) {
    return false;
  }
  double departure_s = 0;
  double arrival_s = 0;
  if (!leg(from, to, 0, latest_s, likely_blocker, departure_s, arrival_s)) return false;
  to.departure_s = departure_s;
  to.arrival_s = arrival_s;
  motion_.face(to, heading_of(from, to));
  return true;
}

template <class Motion>
Trajectory Sipp<Motion>::reconstruct(const Stops& stops) const {
  Trajectory trajectory{agent_->start, {}};
  for (std::size_t i = 1; i < stops.size(); ++i) {
    const Node& from = stops[i - 1];
    const Node& to = stops[i];
    const double ready_s = motion_.turn(from, heading_of(from, to), trajectory);
    if (to.departure_s > ready_s) {
      trajectory.motions.push_back({ready_s, to.departure_s, from.cell(), from.cell()});
    }
    trajectory.motions.push_back({to.departure_s, to.arrival_s, from.cell(), to.cell()});
  }
  motion_.turn_at_goal(stops.back(), trajectory);
  return trajectory;
}

}  // namespace sipplab
