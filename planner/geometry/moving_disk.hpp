// A disk in uniform straight motion, or at rest.
#pragma once

#include "sipplab/geometry.hpp"

namespace sipplab {

/// A straight segment from one point to another, without times.
struct Displacement {
  Vec2 from;
  Vec2 to;
  Vec2 direction;  ///< unit vector; zero where from == to
  double length = 0;

  Displacement() = default;
  Displacement(Vec2 begin, Vec2 end) : from(begin), to(end) {
    const Vec2 path = end - begin;
    length = norm(path);
    if (length > 0) direction = {path.x / length, path.y / length};
  }
  /// For callers that already know the direction and the length.
  Displacement(Vec2 begin, Vec2 end, Vec2 unit_direction, double length_cells)
      : from(begin), to(end), direction(unit_direction), length(length_cells) {}
};

/// A displacement travelled at constant speed; the departure is left open.
struct Move {
  Displacement path;
  double speed = 1;  ///< cells per second, > 0
  double seconds_per_cell = 1;
  double duration = 0;  ///< length / speed, in seconds
  Vec2 velocity;

  Move(const Displacement& displacement, double speed_cells_per_s)
      : path(displacement),
        speed(speed_cells_per_s),
        seconds_per_cell(1 / speed_cells_per_s),
        duration(displacement.length / speed_cells_per_s),
        velocity(displacement.direction * speed_cells_per_s) {}
};

/// A disk that follows `path` during [begin_s, end_s]; at rest if `path` has no length,
/// and then end_s may be kForever. The members that the overlap test reads come first,
/// in one cache line.
struct alignas(64) MovingDisk {
  Vec2 from;
  Vec2 velocity;  ///< cells per second; zero at rest
  double begin_s = 0;
  double end_s = 0;
  double radius = 0;
  double speed = 0;  ///< length / (end_s - begin_s); 0 at rest
  Displacement path;

  static MovingDisk moving(const Displacement& path, double begin_s, double end_s, double radius) {
    const double speed = path.length > 0 ? path.length / (end_s - begin_s) : 0.0;
    return {path.from, path.direction * speed, begin_s, end_s, radius, speed, path};
  }
  static MovingDisk resting(Vec2 place, double begin_s, double end_s, double radius) {
    return {place, {}, begin_s, end_s, radius, 0, Displacement(place, place)};
  }

  bool at_rest() const { return speed == 0; }
};

}  // namespace sipplab
