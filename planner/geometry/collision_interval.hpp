// When two disks overlap, in closed form: this is what makes the planner exact.
//
// A mover that departs at time t is, tau seconds later, at a + u tau; an obstacle
// is at p + v (t + tau - t0) during [t0, t1]. Their difference
//     w(t, tau) = (a - p) + (u - v) tau - v (t - t0)
// is linear in (t, tau), so { |w| < reach } is the preimage of an open disk: convex.
// Cut by the parallelogram 0 <= tau <= duration, t0 <= t + tau <= t1 it stays convex,
// and its projection on t, the set of unsafe departures, is one interval.
//
// Differs from [YA17]: departures are not tried in steps; the interval's ends are
// found exactly and the search jumps from end to end.
#pragma once

#include <algorithm>

#include "planner/core/tolerances.hpp"
#include "planner/geometry/moving_disk.hpp"
#include "sipplab/geometry.hpp"

namespace sipplab {

/// The times at which a disk resting at `place` overlaps `obstacle`. `reach` is the sum
/// of the two radii, in cells.
///  (1) An end at which the two only touch moves inwards by kContactSlackCells divided
///      by the obstacle's speed, so that a gap of zero width between two such intervals
///      survives rounding.
///  (2) An end at which the obstacle's motion begins or ends during an overlap moves
///      outwards by the same amount: the motion before or after it continues the
///      overlap, and no false gap may appear between the two.
///  (3) Overlap shallower than kTouchDepthCells does not count.
OpenInterval collision_interval(Vec2 place, const MovingDisk& obstacle, double reach);

/// The departures for which `move` leads to an overlap with `obstacle` at some time
/// during the move; contracts (1) to (3) hold with the faster of the two speeds.
/// Endless if the obstacle rests for ever within reach of the move.
///
/// REQUIRES: move.path.length > 0.
OpenInterval unsafe_departures(const Move& move, const MovingDisk& obstacle, double reach);

/// The same for two moves without slack (1)(2), for schedules in which robots touch one after the other: a
/// thousand slacks would add up. With other.begin_s = 0 these are the departures of `move` relative to the
/// other one's. (3) holds.
///
/// REQUIRES: move.path.length > 0, and the other moves.
OpenInterval meeting_interval(const Move& move, const MovingDisk& other, double reach);

/// Whether `path` comes within reach of `place` (3). A `path` of no length is a point.
bool reaches(const Displacement& path, Vec2 place, double reach);

/// Whether `path` comes within reach of `place` outside the disk of radius `reach` around
/// `pardoned`. A `path` of no length is a point.
bool intrudes(const Displacement& path, Vec2 place, Vec2 pardoned, double reach);

/// Cells. How far beyond their reach two disks may stay from each other at a departure
/// that still counts as unsafe: an end of its interval may have moved outwards by the time
/// of one kContactSlackCells, each of the two bodies moves that far in this time, and the
/// rest is for rounding.
inline constexpr double kNearMissCells = 4 * kContactSlackCells;

/// Cells. Disks closer than their reach by this much overlap in spite of slack and rounding.
inline constexpr double kSureOverlapCells = 1e-7;

enum class Closeness { kApart, kTouching, kOverlapping };

/// How close the two come to each other: a quick test, without roots or divisions, that decides most
/// departures.
///  (1) Never kApart for a departure that unsafe_departures contains: skipping kApart changes no answer.
///  (2) kApart if the two stay apart by kNearMissCells or more during the time that they share.
///  (3) kOverlapping only for departures that unsafe_departures contains.
/// Inline: the planner calls it many times for each interval that it computes.
inline Closeness closeness(const Move& move, double departure_s, const MovingDisk& obstacle, double reach) {
  const double begin_s = std::max(departure_s, obstacle.begin_s);
  const double end_s = std::min(departure_s + move.duration, obstacle.end_s);
  const double span_s = end_s - begin_s;
  if (span_s * move.speed < -kNearMissCells) return Closeness::kApart;
  const double far = reach + kNearMissCells;
  const Vec2 relative = move.velocity - obstacle.velocity;
  const Vec2 apart = (move.path.from + move.velocity * (begin_s - departure_s)) -
                     (obstacle.from + obstacle.velocity * (begin_s - obstacle.begin_s));
  const double approach = -dot(apart, relative);
  double squared = 0;  // the squared least distance times `scale`
  double scale = 1;
  const double relative_squared = squared_norm(relative);
  if (approach <= 0) {
    squared = squared_norm(apart);
  } else if (approach >= relative_squared * span_s) {
    squared = squared_norm(apart + relative * span_s);
  } else {
    const double aside = cross(apart, relative);
    squared = aside * aside;
    scale = relative_squared;
  }
  if (!(squared < far * far * scale)) return Closeness::kApart;
  const double sure = reach - kSureOverlapCells;
  const bool overlapping = sure > 0 && span_s > 0 && squared < sure * sure * scale;
  return overlapping ? Closeness::kOverlapping : Closeness::kTouching;
}

/// When the two first overlap if `move` departs then: absolute time; kForever if they do not. Touching does
/// not count, up to rounding.
double first_overlap_s(const Move& move, double departure_s, const MovingDisk& obstacle, double reach);

}  // namespace sipplab
