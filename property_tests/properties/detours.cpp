// Where to turn aside for a disk that is in the way.
#include "planner/search/detours.hpp"

#include <rapidcheck.h>

#include <algorithm>
#include <cmath>
#include <cstdint>

#include "planner/geometry/collision_interval.hpp"
#include "property_tests/support/property.hpp"
#include "property_tests/support/shown.hpp"

namespace sipplab::detours_laws {
namespace {

/// A mover meets a disk in the middle of its way, and both go on for long before and after.
struct Meeting {
  Cell from;
  Cell to;
  double speed = 1;
  double departure_s = 0;
  Vec2 missed_by;  ///< the disk's place when the mover is halfway, seen from the mover
  Vec2 velocity;   ///< of the disk
  double reach = 1;

  Move move() const { return {Displacement(centre(from), centre(to)), speed}; }
  MovingDisk disk() const {
    constexpr double kLongS = 100;
    const Move mover = move();
    const Vec2 place = (mover.path.from + mover.path.to) * 0.5 + missed_by;
    const double met_s = departure_s + mover.duration / 2;
    if (squared_norm(velocity) == 0) return MovingDisk::resting(place, met_s - kLongS, met_s + kLongS, reach);
    const Displacement path(place - velocity * kLongS, place + velocity * kLongS);
    return MovingDisk::moving(path, met_s - kLongS, met_s + kLongS, reach);
  }
};

double any_real(double least, double most) {
  constexpr int kSteps = 1 << 16;
  return least + (most - least) * *rc::gen::inRange(0, kSteps + 1) / kSteps;
}

Meeting any_meeting() {
  constexpr std::int32_t kFarthest = 30;
  Meeting meeting;
  meeting.from = {kFarthest, kFarthest};
  do {
    meeting.to = {*rc::gen::inRange(0, 2 * kFarthest + 1), *rc::gen::inRange(0, 2 * kFarthest + 1)};
  } while (distance(meeting.from, meeting.to) < kFarthest / 2);
  meeting.speed = any_real(0.5, 2);
  meeting.departure_s = any_real(100, 200);
  meeting.reach = any_real(0.4, 1.5);
  meeting.missed_by = {any_real(-0.4, 0.4), any_real(-0.4, 0.4)};
  const bool rests = *rc::gen::inRange(0, 4) == 0;
  if (!rests) meeting.velocity = {any_real(-2, 2), any_real(-2, 2)};
  return meeting;
}

const PropertyRoom room("detours", [] {
  bool passed = true;

  passed &= property("Detours: a mover that is so far aside passes the disk", [] {
    const Meeting meeting = any_meeting();
    const Move move = meeting.move();
    const MovingDisk disk = meeting.disk();
    const Vec2 along = move.path.direction;
    int left = 0;
    int right = 0;
    Detours(move, meeting.departure_s, disk, meeting.reach).for_each([&](Cell cell) {
      const double offset = cross(along, centre(cell) - move.path.from);
      const double forward = dot(along, centre(cell) - move.path.from);
      ++(offset > 0 ? left : right);
      RC_ASSERT(forward > 0 && forward < move.path.length);
      const Vec2 aside = Vec2{-along.y, along.x} * offset;
      const Move shifted(Displacement(move.path.from + aside, move.path.to + aside), move.speed);
      RC_ASSERT(closeness(shifted, meeting.departure_s, disk, meeting.reach) != Closeness::kOverlapping);
    });
    RC_ASSERT(std::max(left, right) <= 2);
    RC_CLASSIFY(left + right > 0, "some detours");
  });

  passed &= property("Detours: on both sides of a disk that rests or comes straight on, near it", [] {
    Meeting meeting = any_meeting();
    meeting.reach = std::min(meeting.reach, 1.0);
    meeting.missed_by = meeting.missed_by * 0.5;
    const Move move = meeting.move();
    const bool rests = *rc::gen::inRange(0, 2) == 0;
    meeting.velocity = rests ? Vec2{} : move.velocity * -any_real(0.2, 2);
    const MovingDisk disk = meeting.disk();
    int left = 0;
    int right = 0;
    Detours(move, meeting.departure_s, disk, meeting.reach).for_each([&](Cell cell) {
      ++(cross(move.path.direction, centre(cell) - move.path.from) > 0 ? left : right);
      const Vec2 met = (move.path.from + move.path.to) * 0.5;
      RC_ASSERT(norm(centre(cell) - met) < 4);
    });
    RC_ASSERT(left == 2 && right == 2);
  });

  return passed;
});

}  // namespace
}  // namespace sipplab::detours_laws
