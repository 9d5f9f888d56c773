#include "planner/geometry/collision_interval.hpp"

#include <algorithm>
#include <cmath>

#include "planner/core/tolerances.hpp"
#include "sipplab/error.hpp"

namespace sipplab {
namespace {

/// Directions count as parallel below this cross product. Unit vectors between cell
/// centres less than 8,192 cells apart that are not parallel have a cross product of
/// at least 1 / (2 * 8192^2) = 7e-9.
constexpr double kParallelCross = 1e-10;

/// The stretch of a straight segment, in cells from its beginning, on which a point is
/// within reach. Each end is a contact or an end of the segment.
struct Stretch {
  double begin = 0;
  double end = 0;
  bool contact_at_begin = false;
  bool contact_at_end = false;
  bool empty = true;
};

Stretch within_reach(Vec2 point, const Displacement& path, double reach) {
  const Vec2 offset = point - path.from;
  if (path.length == 0) {
    const double near = reach - kTouchDepthCells;
    if (near <= 0 || squared_norm(offset) >= near * near) return {};
    return {0, 0, false, false, false};
  }
  const double aside = cross(path.direction, offset);
  const double half_squared = reach * reach - aside * aside;
  // reach^2 - (reach - depth)^2 for a depth of kTouchDepthCells.
  if (half_squared <= 2 * reach * kTouchDepthCells) return {};
  const double half = std::sqrt(half_squared);
  const double nearest = dot(path.direction, offset);
  const double enter = nearest - half;
  const double leave = nearest + half;
  if (enter >= path.length - kTouchDepthCells || leave <= kTouchDepthCells) return {};
  Stretch stretch;
  stretch.empty = false;
  stretch.contact_at_begin = enter > -kTouchDepthCells;
  stretch.contact_at_end = leave < path.length + kTouchDepthCells;
  stretch.begin = std::max(enter, 0.0);
  stretch.end = std::min(leave, path.length);
  return stretch;
}

/// Grows to the span of the candidate times added to it.
class Span {
 public:
  explicit Span(double slack_s) : slack_s_(slack_s) {}

  void add(double time_s, bool contact) {
    const double inward_s = contact ? slack_s_ : -slack_s_;
    begin_s_ = std::min(begin_s_, time_s + inward_s);
    end_s_ = std::max(end_s_, time_s - inward_s);
  }

  OpenInterval interval() const {
    // No candidate, or contacts less than two slacks apart: nothing is unsafe.
    if (!(begin_s_ < end_s_)) return {};
    return {begin_s_, end_s_};
  }

 private:
  double slack_s_;
  double begin_s_ = kForever;
  double end_s_ = -kForever;
};

/// The obstacle is at an end of its motion, `end`, at `time_s`: the departures that
/// bring the mover within reach of it at exactly that time.
void add_obstacle_at(Vec2 end, double time_s, const Move& move, double reach, Span& span) {
  const Stretch stretch = within_reach(end, move.path, reach);
  if (stretch.empty) return;
  span.add(time_s - stretch.begin * move.seconds_per_cell, stretch.contact_at_begin);
  span.add(time_s - stretch.end * move.seconds_per_cell, stretch.contact_at_end);
}

/// The mover is at an end of its move, `after_s` seconds after departure.
void add_mover_at(Vec2 end, double after_s, const MovingDisk& obstacle, double reach, Span& span) {
  const Stretch stretch = within_reach(end, obstacle.path, reach);
  if (stretch.empty) return;
  const double seconds_per_cell = (obstacle.end_s - obstacle.begin_s) / obstacle.path.length;
  span.add(obstacle.begin_s + stretch.begin * seconds_per_cell - after_s, stretch.contact_at_begin);
  span.add(obstacle.begin_s + stretch.end * seconds_per_cell - after_s, stretch.contact_at_end);
}

/// Departures for which the two pass each other at exactly `reach`, both in motion.
void add_tangents(const Move& move, const MovingDisk& obstacle, double reach, Span& span) {
  if (std::abs(cross(obstacle.path.direction, move.path.direction)) < kParallelCross) return;
  const Vec2 relative = move.velocity - obstacle.velocity;
  const double relative_squared = squared_norm(relative);
  const Vec2 apart = move.path.from - obstacle.path.from;
  const double turn = cross(obstacle.velocity, relative);
  const double middle = cross(apart, relative) / turn;
  const double half = std::abs(reach * std::sqrt(relative_squared) / turn);
  for (const double since_begin_s : {middle - half, middle + half}) {
    const Vec2 at_departure = apart - obstacle.velocity * since_begin_s;
    const double after_s = -dot(at_departure, relative) / relative_squared;
    if (after_s < 0 || after_s > move.duration) continue;
    const double contact_s = obstacle.begin_s + since_begin_s + after_s;
    if (contact_s < obstacle.begin_s || contact_s > obstacle.end_s) continue;
    span.add(obstacle.begin_s + since_begin_s, true);
  }
}

}  // namespace

OpenInterval collision_interval(Vec2 place, const MovingDisk& obstacle, double reach) {
  const Stretch stretch = within_reach(place, obstacle.path, reach);
  if (stretch.empty) return {};
  if (obstacle.at_rest()) {
    // At rest there is no contact in time, only a beginning and an end.
    return {obstacle.begin_s - kContactSlackCells, obstacle.end_s + kContactSlackCells};
  }
  Span span(kContactSlackCells / obstacle.speed);
  span.add(obstacle.begin_s + stretch.begin / obstacle.speed, stretch.contact_at_begin);
  span.add(obstacle.begin_s + stretch.end / obstacle.speed, stretch.contact_at_end);
  return span.interval();
}

namespace {

/// An obstacle at rest is one point, within reach on one stretch of the move.
OpenInterval unsafe_past_rest(const Move& move, const MovingDisk& obstacle, double reach) {
  const Stretch stretch = within_reach(obstacle.from, move.path, reach);
  if (stretch.empty) return {};
  const double slack_s = kContactSlackCells * move.seconds_per_cell;
  const double begin_s = obstacle.begin_s - stretch.end * move.seconds_per_cell;
  const double end_s = obstacle.end_s - stretch.begin * move.seconds_per_cell;
  const OpenInterval unsafe{begin_s + (stretch.contact_at_end ? slack_s : -slack_s),
                            end_s - (stretch.contact_at_begin ? slack_s : -slack_s)};
  return unsafe.begin_s < unsafe.end_s ? unsafe : OpenInterval{};
}

}  // namespace

namespace {

OpenInterval unsafe_past_motion(const Move& move, const MovingDisk& obstacle, double reach, double slack_s) {
  Span span(slack_s);
  add_obstacle_at(obstacle.path.from, obstacle.begin_s, move, reach, span);
  add_obstacle_at(obstacle.path.to, obstacle.end_s, move, reach, span);
  add_mover_at(move.path.from, 0, obstacle, reach, span);
  add_mover_at(move.path.to, move.duration, obstacle, reach, span);
  add_tangents(move, obstacle, reach, span);
  return span.interval();
}

}  // namespace

OpenInterval unsafe_departures(const Move& move, const MovingDisk& obstacle, double reach) {
  PLANNER_ASSERT(move.path.length > 0);
  if (obstacle.at_rest()) return unsafe_past_rest(move, obstacle, reach);
  return unsafe_past_motion(move, obstacle, reach, kContactSlackCells / std::max(move.speed, obstacle.speed));
}

OpenInterval meeting_interval(const Move& move, const MovingDisk& other, double reach) {
  PLANNER_ASSERT(move.path.length > 0 && !other.at_rest());
  return unsafe_past_motion(move, other, reach, 0);
}

bool reaches(const Displacement& path, Vec2 place, double reach) {
  return !within_reach(place, path, reach).empty;
}

bool intrudes(const Displacement& path, Vec2 place, Vec2 pardoned, double reach) {
  const Stretch inside = within_reach(place, path, reach);
  if (inside.empty) return false;
  const Stretch excused = within_reach(pardoned, path, reach);
  if (excused.empty) return true;
  return inside.begin < excused.begin - kTouchDepthCells || inside.end > excused.end + kTouchDepthCells;
}

double first_overlap_s(const Move& move, double departure_s, const MovingDisk& obstacle, double reach) {
  const double begin_s = std::max(departure_s, obstacle.begin_s);
  const double end_s = std::min(departure_s + move.duration, obstacle.end_s);
  if (begin_s >= end_s) return kForever;
  const Vec2 relative = move.velocity - obstacle.velocity;
  const Vec2 apart = (move.path.from + move.velocity * (begin_s - departure_s)) -
                     (obstacle.from + obstacle.velocity * (begin_s - obstacle.begin_s));
  // Of |apart + relative * after|^2 = reach^2 the smaller root.
  const double near = reach - kTouchDepthCells;
  const double beyond = squared_norm(apart) - near * near;
  if (beyond < 0) return begin_s;
  const double approach = -dot(apart, relative);
  const double discriminant = approach * approach - squared_norm(relative) * beyond;
  if (approach <= 0 || discriminant <= 0) return kForever;
  const double first_s = begin_s + beyond / (approach + std::sqrt(discriminant));
  return first_s < end_s ? first_s : kForever;
}

}  // namespace sipplab
