// Spans of plan time, in seconds.
#pragma once

#include <limits>

namespace sipplab {

inline constexpr double kForever = std::numeric_limits<double>::infinity();

/// A closed span [begin_s, end_s]; a single point if the two are equal; endless if
/// end_s is kForever. Safe intervals are of this kind, and single points matter: a robot
/// whose neighbour sets off towards it at time 0 can still leave at exactly time 0.
struct Interval {
  double begin_s = 0;
  double end_s = kForever;

  bool contains(double t) const { return begin_s <= t && t <= end_s; }
  friend bool operator==(const Interval&, const Interval&) = default;
};

/// A maximal closed span in which a disk may stay at a cell. [PL11] section III.
using SafeInterval = Interval;

/// An open span (begin_s, end_s), empty if begin_s >= end_s. Times at which two disks
/// overlap, or departures that lead to an overlap: touching is allowed, so the ends are
/// not included.
struct OpenInterval {
  double begin_s = 0;
  double end_s = 0;

  bool empty() const { return !(begin_s < end_s); }
  bool contains(double t) const { return begin_s < t && t < end_s; }
  friend bool operator==(const OpenInterval&, const OpenInterval&) = default;
};

}  // namespace sipplab
