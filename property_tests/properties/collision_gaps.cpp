// The gaps between unsafe times: those of zero width, between obstacles that follow each
// other in contact, are found, and motions of one obstacle leave none.
#include <rapidcheck.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <ostream>
#include <vector>

#include "planner/geometry/collision_interval.hpp"
#include "property_tests/support/distance_oracle.hpp"
#include "property_tests/support/encounters.hpp"
#include "property_tests/support/interval_set.hpp"
#include "property_tests/support/property.hpp"

namespace sipplab::collision_gaps_laws {
namespace {

/// Two obstacles pass one after the other along row 0 of a long map, so closely that a
/// robot fits between them at one instant alone.
struct Convoy {
  double radius = 0.5;
  double front_radius = 0.5;
  double back_radius = 0.5;
  double speed = 1;
  double mover_speed = 1;
  double begin_s = 0;

  Displacement lane() const { return {{-40, 0}, {40, 0}}; }
  double lane_s() const { return lane().length / speed; }
  MovingDisk front() const { return MovingDisk::moving(lane(), begin_s, begin_s + lane_s(), front_radius); }
  MovingDisk back(double behind_s) const {
    return MovingDisk::moving(lane(), begin_s + behind_s, begin_s + behind_s + lane_s(), back_radius);
  }
};

std::ostream& operator<<(std::ostream& out, const Convoy& convoy) {
  return out << "radius " << convoy.radius << " speed " << convoy.mover_speed << " between radii "
             << convoy.front_radius << " and " << convoy.back_radius << " speed " << convoy.speed << " from "
             << convoy.begin_s;
}

rc::Gen<Convoy> any_convoy() {
  // Late enough that no robot would have to depart before time 0.
  const auto any_begin = rc::gen::apply([](double base_s, double eighths_s) { return base_s + eighths_s; },
                                        any_of({100.0, 1000.0, 10000.0}), any_eighths(3));
  return rc::gen::build<Convoy>(
      rc::gen::set(&Convoy::radius, any_radius()), rc::gen::set(&Convoy::front_radius, any_radius()),
      rc::gen::set(&Convoy::back_radius, any_radius()), rc::gen::set(&Convoy::speed, any_speed()),
      rc::gen::set(&Convoy::mover_speed, any_speed()), rc::gen::set(&Convoy::begin_s, any_begin));
}

/// `front_s` and `back_s`: for how long before and after both centres would meet in the
/// lane the departure is unsafe.
void fits_between(const Convoy& convoy, const Move& move, double front_s, double back_s, double meets_s) {
  const MovingDisk back = convoy.back(front_s + back_s);
  const OpenInterval after_front =
      unsafe_departures(move, convoy.front(), convoy.radius + convoy.front_radius);
  const OpenInterval before_back = unsafe_departures(move, back, convoy.radius + convoy.back_radius);
  const double slot_s = meets_s + front_s;
  const double slack_s = kContactSlackCells / std::max(move.speed, convoy.speed);
  RC_ASSERT(!after_front.empty() && !before_back.empty());
  RC_ASSERT(after_front.end_s <= slot_s && slot_s <= before_back.begin_s);
  RC_ASSERT(slot_s - after_front.end_s <= 2 * slack_s);
  RC_ASSERT(before_back.begin_s - slot_s <= 2 * slack_s);

  IntervalSet departures;
  departures.remove_open(before_back);
  departures.remove_open(after_front);
  RC_ASSERT(departures.contains(slot_s));
}

/// The robot waits in the middle of the lane and joins it at the convoy's speed.
void fits_in_line(const Convoy& convoy) {
  const Move move(Displacement({0, 0}, {10, 0}), convoy.speed);
  fits_between(convoy, move, (convoy.radius + convoy.front_radius) / convoy.speed,
               (convoy.radius + convoy.back_radius) / convoy.speed, convoy.begin_s + convoy.lane_s() / 2);
}

/// The robot crosses the middle of the lane at a right angle.
void fits_across(const Convoy& convoy) {
  constexpr double kToLane = 20;
  const double u = convoy.mover_speed;
  const double v = convoy.speed;
  const Move move(Displacement({0, -kToLane}, {0, kToLane}), u);
  // Two points that pass the origin at right angles and `late` apart in time are never
  // closer than late * u * v / sqrt(u^2 + v^2).
  const double late_per_cell = std::sqrt(u * u + v * v) / (u * v);
  fits_between(convoy, move, (convoy.radius + convoy.front_radius) * late_per_cell,
               (convoy.radius + convoy.back_radius) * late_per_cell,
               convoy.begin_s + convoy.lane_s() / 2 - kToLane / u);
}

/// The cell in the middle of the lane is safe between the two at one instant.
void leaves_a_safe_point(const Convoy& convoy) {
  const double front_s = (convoy.radius + convoy.front_radius) / convoy.speed;
  const double back_s = (convoy.radius + convoy.back_radius) / convoy.speed;
  const MovingDisk back = convoy.back(front_s + back_s);
  IntervalSet safe;
  safe.remove_open(collision_interval({0, 0}, convoy.front(), convoy.radius + convoy.front_radius));
  safe.remove_open(collision_interval({0, 0}, back, convoy.radius + convoy.back_radius));
  RC_ASSERT(safe.intervals().size() == 3u);
  const double slot_s = convoy.begin_s + convoy.lane_s() / 2 + front_s;
  RC_ASSERT(safe.contains(slot_s));
  RC_ASSERT(safe.intervals()[1].end_s - safe.intervals()[1].begin_s <= 4 * kContactSlackCells / convoy.speed);
}

/// The unsafe times of a walk's disks cover every time at which one of them is too close.
/// How many of the times looked at were unsafe.
template <class Unsafe, class Distance>
int leaves_no_false_gap(const Walk& walk, double reach, double rounding, const Unsafe& unsafe,
                        const Distance& distance) {
  const std::vector<MovingDisk> disks = disks_of(walk.trajectory(), walk.radius);
  std::vector<OpenInterval> spans;
  for (const MovingDisk& disk : disks) spans.push_back(unsafe(disk));
  std::vector<double> times;
  for (const OpenInterval& span : spans) {
    for (const double end_s : {span.begin_s, span.end_s}) {
      if (span.empty() || end_s == kForever) continue;
      for (const double beside_s : {0.0, 1e-12, 1e-10, 1e-9, 1e-8, 1e-6, 1e-3, 0.1}) {
        times.push_back(end_s - beside_s);
        times.push_back(end_s + beside_s);
      }
    }
  }
  const double until_s = walk.trajectory().arrival_s() + 1;
  constexpr int kTimes = 100;
  for (int i = -20; i <= kTimes; ++i) times.push_back(until_s * i / kTimes);
  int deep = 0;
  for (const double time_s : times) {
    double least = kForever;
    for (const MovingDisk& disk : disks) least = std::min(least, distance(disk, time_s));
    if (least >= reach - kPermittedDepthCells - rounding) continue;
    ++deep;
    RC_ASSERT(std::any_of(spans.begin(), spans.end(),
                          [&](const OpenInterval& span) { return span.contains(time_s); }));
  }
  return deep;
}

constexpr std::int32_t kWalkSide = 5;
constexpr int kWalksPerCase = 20;

const PropertyRoom room("collision_gaps", [] {
  bool passed = true;

  passed &= property("unsafe_departures (1): a gap of zero width in a convoy is found by one who joins it",
                     [] { fits_in_line(*any_convoy()); });

  passed &= property("unsafe_departures (1): a gap of zero width in a convoy is found by one who crosses it",
                     [] { fits_across(*any_convoy()); });

  passed &= property("collision_interval (1): a single safe point in a convoy is found",
                     [] { leaves_a_safe_point(*any_convoy()); });

  passed &= property("unsafe_departures (2): consecutive motions leave no false gap", [] {
    int overlapping = 0;
    for (int i = 0; i < kWalksPerCase; ++i) {
      const Walk walk = *any_walk(kWalkSide, kWalkSide);
      const Encounter encounter = *any_encounter();
      const Move move(Displacement(centre(encounter.from), centre(encounter.to)), *any_speed());
      const double reach = encounter.radius + walk.radius;
      overlapping += 0 < leaves_no_false_gap(
                             walk, reach, rounding_cells(100, 4),
                             [&](const MovingDisk& disk) { return unsafe_departures(move, disk, reach); },
                             [&](const MovingDisk& disk, double departure_s) {
                               return closest_approach(leg_of(move, departure_s), leg_of(disk));
                             });
    }
    RC_CLASSIFY(2 * overlapping >= kWalksPerCase, "half of the walks come too close");
  });

  passed &= property("collision_interval (2): consecutive motions leave no false gap", [] {
    int overlapping = 0;
    for (int i = 0; i < kWalksPerCase; ++i) {
      const Walk walk = *any_walk(kWalkSide, kWalkSide);
      const Vec2 place = centre(*any_cell(kWalkSide, kWalkSide));
      const double reach = *any_radius() + walk.radius;
      overlapping +=
          0 < leaves_no_false_gap(
                  walk, reach, rounding_cells(100, 4),
                  [&](const MovingDisk& disk) { return collision_interval(place, disk, reach); },
                  [&](const MovingDisk& disk, double time_s) { return distance_at(place, disk, time_s); });
    }
    RC_CLASSIFY(2 * overlapping >= kWalksPerCase, "half of the walks come too close");
  });

  return passed;
});

}  // namespace
}  // namespace sipplab::collision_gaps_laws
