#include "planner/unit_moves/timetable.hpp"

#include <algorithm>
#include <utility>

#include "sipplab/error.hpp"

namespace sipplab {

Timetable::Timetable(const UnitMoves& moves, std::size_t robots)
    : moves_(moves), routes_(robots), stays_(moves.grid().size()) {}

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

std::size_t Timetable::first_from(CellId cell, Tick time) const {
  const std::vector<Stay>& stays = stays_[cell];
  const auto found = std::partition_point(stays.begin(), stays.end(),
                                          [time](const Stay& stay) { return stay.arrival < time; });
  return static_cast<std::size_t>(found - stays.begin());
}

void Timetable::insert(RobotId robot, Route route) {
  PLANNER_ASSERT(routes_[robot].empty() && !route.empty() && fits(route));
  for (std::size_t stop = 0; stop < route.size(); ++stop) {
    Stay added = stay(route, stop);
    added.robot = robot;
    const CellId cell = route[stop].cell;
    const std::size_t place = first_from(cell, added.arrival);
    stays_[cell].insert(stays_[cell].begin() + static_cast<std::ptrdiff_t>(place), added);
  }
  routes_[robot] = std::move(route);
}

Route Timetable::remove(RobotId robot) {
  for (const Stop& stop : routes_[robot]) {
    const std::size_t place = first_from(stop.cell, stop.arrival);
    PLANNER_ASSERT(stays_[stop.cell][place].robot == robot);
    stays_[stop.cell].erase(stays_[stop.cell].begin() + static_cast<std::ptrdiff_t>(place));
  }
  return std::exchange(routes_[robot], {});
}

bool Timetable::fits(const Route& route) const {
  for (std::size_t stop = 0; stop < route.size(); ++stop) {
    const Stay wanted = stay(route, stop);
    const std::vector<Stay>& stays = stays_[route[stop].cell];
    const std::size_t place = first_from(route[stop].cell, wanted.arrival);
    if (place > 0) {
      const Stay& before = stays[place - 1];
      if (before.departure + moves_.lag(before.left, wanted.entered) > wanted.arrival) return false;
    }
    if (place < stays.size()) {
      const Stay& after = stays[place];
      if (wanted.departure + moves_.lag(wanted.left, after.entered) > after.arrival) return false;
    }
  }
  return true;
}

}  // namespace sipplab
