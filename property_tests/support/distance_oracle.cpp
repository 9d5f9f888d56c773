// Distances and unsafe times by bisection; see distance_oracle.hpp.
#include "property_tests/support/distance_oracle.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace sipplab {
namespace {

/// Enough to shrink any span of plan time below its rounding, where both end.
constexpr int kTernarySteps = 120;
constexpr int kBisectionSteps = 100;
/// Seconds after an endless rest has begun at which every move is under its spell.
constexpr double kIntoRestS = 1;

Vec2 place_at(const Leg& leg, double time_s) {
  if (leg.from == leg.to) return leg.from;
  const double part = (time_s - leg.begin_s) / (leg.end_s - leg.begin_s);
  return leg.from + (leg.to - leg.from) * part;
}

/// Distance of the origin to the segment from a to b.
double origin_to_segment(Vec2 a, Vec2 b) {
  const Vec2 path = b - a;
  const double whole = squared_norm(path);
  if (whole == 0) return norm(a);
  const double part = std::clamp(-dot(a, path) / whole, 0.0, 1.0);
  return norm(a + path * part);
}

/// Least distance over the time that both legs last, which may be rounded away if it
/// is a single instant.
double least_together(const Leg& a, const Leg& b, double rounding_s) {
  const double begin_s = std::max(a.begin_s, b.begin_s);
  const double end_s = std::min(a.end_s, b.end_s);
  if (begin_s > end_s + rounding_s) return std::numeric_limits<double>::infinity();
  // Seen from one of two points in uniform motion, the other one runs along a segment.
  const Vec2 at_begin = place_at(b, begin_s) - place_at(a, begin_s);
  if (end_s == kForever) return norm(at_begin);
  return origin_to_segment(at_begin, place_at(b, end_s) - place_at(a, end_s));
}

/// Where a convex function is least in [low, high].
template <class Function>
double least_at(double low, double high, double enough, const Function& function) {
  for (int step = 0; step < kTernarySteps; ++step) {
    const double third = (high - low) / 3;
    if (low + third == low || high - third == high) break;
    const double left = function(low + third);
    const double right = function(high - third);
    if (std::min(left, right) < enough) return left < right ? low + third : high - third;
    (left <= right ? high : low) = left <= right ? high - third : low + third;
  }
  return (low + high) / 2;
}

/// The time between `outside` and `inside` from which on the function is below `reach`.
template <class Function>
double crossing(double outside, double inside, double reach, const Function& function) {
  for (int step = 0; step < kBisectionSteps; ++step) {
    const double middle = (outside + inside) / 2;
    if (middle == outside || middle == inside) break;
    (function(middle) < reach ? inside : outside) = middle;
  }
  return (outside + inside) / 2;
}

/// { t in [low, high] : function(t) < reach } for a convex function that is constant from
/// `into_rest_s` on where high is infinite.
template <class Function>
BisectedSpan below(double low, double high, double into_rest_s, double reach, const Function& function) {
  const bool endless = high == kForever;
  if (endless) high = into_rest_s;
  const double near = reach - kTouchDepthCells;
  BisectedSpan span;
  span.deepest_s = least_at(low, high, reach / 2, function);
  // The search ends close to an end at which the function is least.
  for (const double end_s : {low, high}) {
    if (function(end_s) < function(span.deepest_s)) span.deepest_s = end_s;
  }
  span.least_cells = function(span.deepest_s);
  span.empty = !(span.least_cells < near);
  if (span.empty) return span;
  span.contact_begin = function(low) >= near;
  span.begin_s = span.contact_begin ? crossing(low, span.deepest_s, reach, function) : low;
  span.contact_end = function(high) >= near;
  span.end_s = span.contact_end ? crossing(high, span.deepest_s, reach, function) : endless ? kForever : high;
  return span;
}

}  // namespace

Leg leg_of(const MovingDisk& disk) { return {disk.path.from, disk.path.to, disk.begin_s, disk.end_s}; }

Leg leg_of(const Move& move, double departure_s) {
  return {move.path.from, move.path.to, departure_s, departure_s + move.path.length / move.speed};
}

Leg leg_at(Vec2 place) { return {place, place, 0, kForever}; }

double closest_approach(const Leg& a, const Leg& b) { return least_together(a, b, 0); }

double distance_at(Vec2 place, const MovingDisk& disk, double time_s) {
  if (time_s < disk.begin_s || time_s > disk.end_s) return std::numeric_limits<double>::infinity();
  return norm(place_at(leg_of(disk), time_s) - place);
}

double time_rounding_s(double time_s) {
  constexpr double kUnits = 8;
  return kUnits * std::numeric_limits<double>::epsilon() * std::max(1.0, std::abs(time_s));
}

double rounding_cells(double time_s, double speed) {
  /// Of coordinates and of roots of sums of their squares.
  constexpr double kPlaceCells = 1e-11;
  return kPlaceCells + time_rounding_s(time_s) * speed;
}

BisectedSpan bisect_departures(const Move& move, const MovingDisk& disk, double reach) {
  const Leg obstacle = leg_of(disk);
  return below(disk.begin_s - move.path.length / move.speed, disk.end_s, disk.begin_s + kIntoRestS, reach,
               [&](double departure_s) {
                 return least_together(leg_of(move, departure_s), obstacle, time_rounding_s(departure_s));
               });
}

BisectedSpan bisect_collision(Vec2 place, const MovingDisk& disk, double reach) {
  return below(disk.begin_s, disk.end_s, disk.begin_s + kIntoRestS, reach,
               [&](double time_s) { return distance_at(place, disk, time_s); });
}

}  // namespace sipplab
