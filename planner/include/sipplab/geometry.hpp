// Plane vectors and spans of time. Units are cells and seconds of plan time; x grows to the right, y
// downwards, and the centre of cell (x, y) is the point (x, y).
#pragma once

#include <cmath>
#include <limits>

namespace sipplab {

struct Vec2 {
  double x = 0;
  double y = 0;

  friend constexpr Vec2 operator+(Vec2 a, Vec2 b) { return {a.x + b.x, a.y + b.y}; }
  friend constexpr Vec2 operator-(Vec2 a, Vec2 b) { return {a.x - b.x, a.y - b.y}; }
  friend constexpr Vec2 operator*(Vec2 a, double k) { return {a.x * k, a.y * k}; }
  friend constexpr bool operator==(Vec2 a, Vec2 b) { return a.x == b.x && a.y == b.y; }
};

constexpr double dot(Vec2 a, Vec2 b) { return a.x * b.x + a.y * b.y; }
constexpr double cross(Vec2 a, Vec2 b) { return a.x * b.y - a.y * b.x; }
constexpr double squared_norm(Vec2 a) { return dot(a, a); }
/// The square root of a sum of squares, not std::hypot, whose last bit differs
/// between C libraries.
inline double norm(Vec2 a) { return std::sqrt(squared_norm(a)); }

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
