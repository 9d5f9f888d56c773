// Distances of disks in uniform motion, the slow and obvious way: where both are is
// read off their two end points, and unsafe times are found by bisection. Shares no
// formula with planner/geometry.
#pragma once

#include "planner/core/tolerances.hpp"
#include "planner/geometry/moving_disk.hpp"

namespace sipplab {

/// Where a point is at two times; between them it moves uniformly. A point at rest may
/// have end_s == kForever.
struct Leg {
  Vec2 from;
  Vec2 to;
  double begin_s;
  double end_s;
};

Leg leg_of(const MovingDisk& disk);
Leg leg_of(const Move& move, double departure_s);
/// At rest during [0, infinity).
Leg leg_at(Vec2 place);

/// Least distance of the two over the time that both legs last, both ends included, in
/// cells; infinite if there is no such time. A convex function of a departure.
double closest_approach(const Leg& a, const Leg& b);

/// Distance of `place` and the disk's centre at a time; infinite if the disk is not
/// there at that time.
double distance_at(Vec2 place, const MovingDisk& disk, double time_s);

/// Overlap that the planner permits: as deep as touching, and the slack by which it
/// moves the end of a collision interval.
inline constexpr double kPermittedDepthCells = kTouchDepthCells + kContactSlackCells;

/// What rounding does to sums of times as large as `time_s`: a few units in the last place.
double time_rounding_s(double time_s);
/// What rounding does to a distance, in cells, when times as large as `time_s` are
/// multiplied by speeds that add up to `speed`.
double rounding_cells(double time_s, double speed);

/// The span of unsafe times and how it was found.
struct BisectedSpan {
  double begin_s = 0;
  double end_s = 0;
  double deepest_s = 0;       ///< a time of the least distance, or of overlap by half the reach ...
  double least_cells = 0;     ///< ... and that distance
  bool empty = true;          ///< overlap nowhere deeper than kTouchDepthCells
  bool contact_begin = true;  ///< else the span begins where the disk's motion does
  bool contact_end = true;    ///< else the span ends where the disk's motion does
};

/// Departures for which the move overlaps the disk.
BisectedSpan bisect_departures(const Move& move, const MovingDisk& disk, double reach);
/// Times at which a disk that rests at `place` overlaps the disk.
BisectedSpan bisect_collision(Vec2 place, const MovingDisk& disk, double reach);

}  // namespace sipplab
