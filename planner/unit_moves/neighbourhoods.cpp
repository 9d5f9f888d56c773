#include "planner/unit_moves/neighbourhoods.hpp"

#include <algorithm>

namespace sipplab {
namespace {

/// Robots drawn, of which the latest is taken. (Trials, four seeds of 5 s: with 2 instead of 4 robots
/// flowtime of 400 robots on random-32-32-20 -2.6 %, 200 there -0.6 %, 1,000 in a warehouse -2.2 %, 300 on
/// room-32-32-4 +1.0 %, others within 0.2 %.)
constexpr int kDrawn = 2;

/// Half of the time within which robots at one place belong together.
constexpr Tick kPlaceTicks = 8 * kMoveTicks;
/// Cells looked at around a place.
constexpr std::size_t kPlaceCells = 60;

/// Draws in vain after which a set is left smaller than it may be.
constexpr std::size_t kMostDraws = 20;

}  // namespace

UnitNeighbourhoods::UnitNeighbourhoods(const Timetable& plan, SharedDistances& distances)
    : plan_(plan), distances_(distances) {}

std::vector<RobotId> UnitNeighbourhoods::choose(UnitRule rule, std::size_t most, Random& random) {
  chosen_.clear();
  most_ = std::min(most, plan_.robots());
  const RobotId first = late_robot(random);
  add(first);
  switch (rule) {
    case UnitRule::kBlocked:
      for (std::size_t draw = 0; !is_full() && draw < kMostDraws; ++draw) {
        const RobotId robot = draw == 0 ? first : chosen_[random.below(chosen_.size())];
        if (random.one_in(2)) {
          add_blockers(robot, random);
        } else {
          add_on_shorter_way(robot, random);
        }
      }
      break;
    case UnitRule::kPlace: {
      const Route& route = plan_.route(first);
      const Stop stop = route[random.below(route.size())];
      add_around(stop.cell, stop.arrival);
      break;
    }
    case UnitRule::kLate:
      for (std::size_t draw = 0; !is_full() && draw < kMostDraws; ++draw) add(late_robot(random));
      break;
  }
  return chosen_;
}

RobotId UnitNeighbourhoods::late_robot(Random& random) const {
  auto latest = static_cast<RobotId>(random.below(plan_.robots()));
  for (int draw = 1; draw < kDrawn; ++draw) {
    const auto other = static_cast<RobotId>(random.below(plan_.robots()));
    if (delay(other) > delay(latest)) latest = other;
  }
  return latest;
}

void UnitNeighbourhoods::add(RobotId robot) {
  if (is_full() || std::find(chosen_.begin(), chosen_.end(), robot) != chosen_.end()) return;
  chosen_.push_back(robot);
}

/// Those that a robot waits for, from some stop of its route on.
void UnitNeighbourhoods::add_blockers(RobotId robot, Random& random) {
  const Route& route = plan_.route(robot);
  const std::size_t begin = random.below(route.size());
  for (std::size_t i = 0; i + 1 < route.size() && !is_full(); ++i) {
    const std::size_t stop = 1 + (begin + i) % (route.size() - 1);
    if (route[stop].arrival - route[stop - 1].arrival == kMoveTicks) continue;  // it did not wait
    const std::size_t place = plan_.first_from(route[stop].cell, route[stop].arrival);
    if (place > 0) add(plan_.stays(route[stop].cell)[place - 1].robot);
  }
}

/// Those in the way of a robot that goes straight to its goal from some stop of its route on.
void UnitNeighbourhoods::add_on_shorter_way(RobotId robot, Random& random) {
  SharedDistances::OfRobot distances = distances_.of(robot);
  const Route& route = plan_.route(robot);
  auto [cell, time] = route[random.below(route.size())];
  while (cell != distances_.goal(robot) && !is_full()) {
    CellId nearer = kNoCell;
    std::uint64_t paths = 0;
    for (const CellId next : plan_.moves().grid().neighbours(cell)) {
      if (distances.is_nearer(cell, next) && random.one_in(++paths)) nearer = next;
    }
    cell = nearer;
    time += kMoveTicks;
    add_at(cell, time - kMoveTicks, time + kMoveTicks);
  }
  if (cell == distances_.goal(robot)) add_at(cell, time, kNever);
}

/// Robots that stay at the cell at some time between these.
void UnitNeighbourhoods::add_at(CellId cell, Tick begin, Tick end) {
  const auto stays = plan_.stays(cell);
  std::size_t place = plan_.first_from(cell, begin);
  if (place > 0 && stays[place - 1].departure > begin) --place;
  for (; place < stays.size() && stays[place].arrival < end && !is_full(); ++place) add(stays[place].robot);
}

/// Robots near the cell at about this time, the nearest cells first.
void UnitNeighbourhoods::add_around(CellId cell, Tick time) {
  std::vector<CellId> cells = {cell};
  for (std::size_t i = 0; i < cells.size() && !is_full(); ++i) {
    add_at(cells[i], time - kPlaceTicks, time + kPlaceTicks);
    for (const CellId next : plan_.moves().grid().neighbours(cells[i])) {
      if (cells.size() >= kPlaceCells) break;
      if (std::find(cells.begin(), cells.end(), next) == cells.end()) cells.push_back(next);
    }
  }
}

}  // namespace sipplab
