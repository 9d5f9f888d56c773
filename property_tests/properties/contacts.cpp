// Contacts at distances that no double can say: bodies on any two cells whose radii add up to exactly their
// distance, such as the square root of two. All that judges overlap lets them touch, and nothing deeper.
#include <rapidcheck.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <ostream>
#include <vector>

#include "planner/geometry/collision_interval.hpp"
#include "planner/grid/line_of_sight.hpp"
#include "planner/instance/disk_lookup.hpp"
#include "planner/instance/reachability.hpp"
#include "planner/prioritized/conflict.hpp"
#include "planner/reservation/reservation_table.hpp"
#include "planner/retime/retime.hpp"
#include "planner/solve/plan.hpp"
#include "property_tests/support/encounters.hpp"
#include "property_tests/support/property.hpp"
#include "sipplab/validator.hpp"

namespace sipplab::contacts_laws {
namespace {

/// Cells on each side, so that no body leaves the map.
constexpr std::int32_t kRoom = 6;
constexpr std::int32_t kSide = 3 * kRoom;

/// Cells by which bodies are deeper in each other than touching; far above rounding, and less than it takes
/// to see. 0 first.
rc::Gen<double> any_depth() { return any_of({0.0, 0.0, 1e-6, 0.0625}); }

constexpr std::int32_t kFarthest = 4;

/// Two bodies: where one is, seen from the other, how the distance between them is shared, how deep they are
/// in each other.
struct Meeting {
  Cell path;
  Cell half;  ///< of the move of one of them
  double share = 0.5;
  double depth_cells = 0;
  double speed = 1;

  bool touch() const { return depth_cells == 0; }
};

std::ostream& operator<<(std::ostream& out, const Meeting& meeting) {
  return out << meeting.path << " away, half a move " << meeting.half << " at speed " << meeting.speed
             << ", share " << meeting.share << ", deep " << meeting.depth_cells;
}

Meeting make_meeting() {
  Meeting meeting;
  while (meeting.path == Cell{0, 0}) {
    const Cell cell = *any_cell(2 * kFarthest + 1, 2 * kFarthest + 1);
    meeting.path = {cell.x - kFarthest, cell.y - kFarthest};
  }
  meeting.half = *any_of<Cell>({{1, 0}, {0, 1}, {1, 1}, {1, -1}, {2, 1}, {1, 2}, {2, -1}, {3, 2}});
  meeting.share = *any_of({0.5, 1.0 / 3, 0.7, 0.25, 1 / std::sqrt(5.0)});
  meeting.depth_cells = *any_depth();
  meeting.speed = *any_of({1.0, 0.5, 3.0});
  return meeting;
}

double length(Cell path) { return std::sqrt(static_cast<double>(path.x * path.x + path.y * path.y)); }

/// Two bodies that touch if they are `apart_cells` apart, one of them deeper by `depth_cells`.
struct Radii {
  double one;
  double other;
};

Radii radii_that_touch(double apart_cells, const Meeting& meeting) {
  const double one = meeting.share * apart_cells;
  return {one, apart_cells - one + meeting.depth_cells};
}

Agent body(const char* id, Cell start, Cell goal, double radius_cells) {
  Agent agent;
  agent.id = id;
  agent.start = start;
  agent.goal = goal;
  agent.radius_cells = radius_cells;
  return agent;
}

/// All say the same of two bodies that rest side by side.
void agree_on_bodies_at_rest(const Meeting& meeting) {
  const bool touch = meeting.touch();
  const Cell path = meeting.path;
  const Cell here{kSide / 2, kSide / 2};
  const Cell there{here.x + path.x, here.y + path.y};
  const Radii radii = radii_that_touch(length(path), meeting);
  const double reach = radii.one + radii.other;
  RC_LOG() << here << " radius " << radii.one << ", " << there << " radius " << radii.other << std::endl;
  RC_CLASSIFY(touch && length(path) != std::floor(length(path)), "in contact at an irrational distance");

  RC_ASSERT(disks_overlap(here, radii.one, there, radii.other) == !touch);
  DiskLookup lookup;
  lookup.add(0, there, radii.other);
  RC_ASSERT(lookup.find_overlap(here, radii.one).has_value() == !touch);

  const MovingDisk other = MovingDisk::resting(centre(there), 1, 3, radii.other);
  RC_ASSERT(collision_interval(centre(here), other, reach).empty() == touch);
  const Displacement stay(centre(here), centre(here));
  RC_ASSERT(reaches(stay, centre(there), reach) == !touch);
  RC_ASSERT(intrudes(stay, centre(there), centre(there) + Vec2{3 * reach, 0}, reach) == !touch);

  Instance instance;
  instance.map = GridMap(kSide, kSide);
  instance.agents = {body("one", here, here, radii.one), body("other", there, there, radii.other)};
  ReservationTable table(instance.map, std::max(radii.one, radii.other));
  table.add(other);
  RC_ASSERT((table.safe_intervals(here, radii.one).size() == 1) == touch);

  RC_ASSERT(!find_error(instance) == touch);
  const Solution resting{{{here, {}}, {there, {}}}};
  RC_ASSERT(validate(instance, resting).valid() == touch);
  RC_ASSERT((certify(instance, resting).collisions == 0) == touch);
  RC_ASSERT(are_in_conflict(instance.agents[0], resting.trajectories[0], radii.other,
                            resting.trajectories[1]) == !touch);
  const auto retimed = retime(instance, resting);
  RC_ASSERT(retimed.has_value());
  RC_ASSERT(retimed->is_executable() == touch);
  if (touch) RC_ASSERT(plan(instance, PlannerOptions{}).status == PlanStatus::kSolved);
}

/// A body that goes straight past one at rest, in contact with it somewhere in the middle.
void pass_in_contact(const Meeting& meeting) {
  const bool touch = meeting.touch();
  const Cell half = meeting.half;
  const Cell aside = meeting.path;
  const Cell middle{kSide / 2, kSide / 2};
  const Cell from{middle.x - half.x, middle.y - half.y};
  const Cell to{middle.x + half.x, middle.y + half.y};
  const double off_line = std::abs(half.x * aside.y - half.y * aside.x) / length(half);
  // Nearest within the way, not at an end of it.
  const int along = half.x * aside.x + half.y * aside.y;
  RC_PRE(off_line > 0.25);
  RC_PRE(std::abs(along) < half.x * half.x + half.y * half.y);
  const Cell there{middle.x + aside.x, middle.y + aside.y};
  const Radii radii = radii_that_touch(off_line, meeting);
  const double reach = radii.one + radii.other;
  RC_LOG() << from << " -> " << to << " radius " << radii.one << ", " << there << " radius " << radii.other
           << std::endl;
  RC_CLASSIFY(touch && off_line != std::floor(off_line), "in contact at an irrational distance");

  const double speed = meeting.speed;
  const Move move(Displacement(centre(from), centre(to)), speed);
  const MovingDisk other = MovingDisk::resting(centre(there), 0, kForever, radii.other);
  RC_ASSERT(unsafe_departures(move, other, reach).empty() == touch);
  RC_ASSERT((closeness(move, 1, other, reach) == Closeness::kOverlapping) <= !touch);
  RC_ASSERT(reaches(move.path, centre(there), reach) == !touch);

  Instance instance;
  instance.map = GridMap(kSide, kSide);
  instance.agents = {body("one", from, to, radii.one), body("other", there, there, radii.other)};
  instance.agents[0].speed_cells_per_s = speed;
  ReservationTable table(instance.map, std::max(radii.one, radii.other));
  table.add(other);
  RC_ASSERT((table.earliest_departure(from, to, speed, radii.one, 0, 1) == 0) == touch);
  const Solution straight{{{from, {{0, move.duration, from, to}}}, {there, {}}}};
  RC_ASSERT(validate(instance, straight).valid() == touch);
  RC_ASSERT(are_in_conflict(instance.agents[0], straight.trajectories[0], radii.other,
                            straight.trajectories[1]) == !touch);
  // Inside the other one's rim at the start it cannot be planned.
  if (!touch || find_error(instance)) return;
  PlannerOptions options;
  options.order = InitialOrder::kLongestFirst;  // whoever moves makes way for nobody
  const PlanResult result = plan(instance, options);
  RC_ASSERT(result.status == PlanStatus::kSolved);
  RC_ASSERT(makespan_s(result.solution) <= move.duration + 1e-9);
}

/// A body beside a blocked cell whose corner it touches.
void stand_at_a_corner(const Meeting& meeting) {
  const bool touch = meeting.touch();
  const Cell here{kSide / 2, kSide / 2};
  const Cell path = meeting.path;
  const double radius_cells =
      std::hypot(std::max(0.0, std::abs(path.x) - 0.5), std::max(0.0, std::abs(path.y) - 0.5)) +
      meeting.depth_cells;
  RC_PRE(radius_cells <= kRoom);
  Instance instance;
  instance.map = GridMap(kSide, kSide);
  instance.map.set_blocked({here.x + path.x, here.y + path.y}, true);
  instance.agents = {body("one", here, here, radius_cells)};
  RC_LOG() << "radius " << radius_cells << ", blocked " << path << " away" << std::endl;
  RC_CLASSIFY(touch && path.x != 0 && path.y != 0, "at a corner");
  RC_ASSERT(!find_error(instance) == touch);
  RC_ASSERT(LineOfSight(instance.map, radius_cells).is_legal(here) == touch);
  RC_ASSERT((standing_components(instance.map, radius_cells)[instance.map.index(here)] != 0) == touch);
  RC_ASSERT(validate(instance, {{{here, {}}}}).valid() == touch);
}

const PropertyRoom room("contacts", [] {
  bool passed = true;
  passed &= property("bodies at rest touch or overlap: everything says the same",
                     [] { agree_on_bodies_at_rest(at_full_size(make_meeting)); });
  passed &= property("a body passes one at rest in contact, and no deeper",
                     [] { pass_in_contact(at_full_size(make_meeting)); });
  passed &= property("a body touches the corner of a blocked cell, and no deeper",
                     [] { stand_at_a_corner(at_full_size(make_meeting)); });
  return passed;
});

}  // namespace
}  // namespace sipplab::contacts_laws
