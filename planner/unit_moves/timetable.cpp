#include "planner/unit_moves/timetable.hpp"

#include <algorithm>
#include <utility>

#include "sipplab/error.hpp"

namespace sipplab {

Timetable::Timetable(const UnitMoves& moves, std::size_t robots) : moves_(moves), routes_(robots) {
  Stay before;
  before.departure = 0;
  Stay after;
  after.arrival = kNever;
  at_.assign(moves.grid().size(), {{before, after}, {}});
}

Stay Timetable::stay(const Route& route, std::size_t stop) const {
  Stay stay;
  stay.arrival = route[stop].arrival;
  if (stop > 0) stay.entered = moves_.direction(route[stop - 1].cell, route[stop].cell);
  if (stop + 1 < route.size()) {
    stay.departure = route[stop + 1].arrival - kMoveTicks;
    stay.left = moves_.direction(route[stop].cell, route[stop + 1].cell);
  }
  return stay;
}

void Timetable::insert(RobotId robot, Route route) {
  PLANNER_ASSERT(routes_[robot].empty() && !route.empty() && fits(route));
  for (std::size_t stop = 0; stop < route.size(); ++stop) {
    Stay added = stay(route, stop);
    added.robot = robot;
    const auto place = static_cast<std::ptrdiff_t>(first_from(route[stop].cell, added.arrival));
    auto& [borders, arrivals] = at_[route[stop].cell];
    borders.insert(borders.begin() + 1 + place, added);
    arrivals.insert(arrivals.begin() + place, added.arrival);
    fill_up(at_[route[stop].cell]);
  }
  routes_[robot] = std::move(route);
}

Route Timetable::remove(RobotId robot) {
  for (const Stop& stop : routes_[robot]) {
    const auto place = static_cast<std::ptrdiff_t>(first_from(stop.cell, stop.arrival));
    auto& [borders, arrivals] = at_[stop.cell];
    PLANNER_ASSERT(stays(stop.cell)[static_cast<std::size_t>(place)].robot == robot);
    borders.erase(borders.begin() + 1 + place);
    arrivals.erase(arrivals.begin() + place);
    fill_up(at_[stop.cell]);
  }
  return std::exchange(routes_[robot], {});
}

void Timetable::fill_up(AtCell& at) {
  const std::size_t stays = at.borders.size() - 2;
  at.arrivals.resize((stays + kLanes - 1) / kLanes * kLanes, kNever);
}

bool Timetable::fits(const Route& route) const {
  for (std::size_t stop = 0; stop < route.size(); ++stop) {
    const Stay wanted = stay(route, stop);
    const std::size_t gap = first_from(route[stop].cell, wanted.arrival);
    const Stay& before = borders(route[stop].cell)[gap];
    const Stay& after = borders(route[stop].cell)[gap + 1];
    if (before.departure + moves_.lag(before.left, wanted.entered) > wanted.arrival ||
        wanted.departure + moves_.lag(wanted.left, after.entered) > after.arrival) {
      return false;
    }
  }
  return true;
}

}  // namespace sipplab
