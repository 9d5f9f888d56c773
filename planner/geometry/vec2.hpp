// Plane vectors. Units are cells; x grows to the right, y downwards, and the
// centre of cell (x, y) is the point (x, y).
#pragma once

#include <cmath>

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

}  // namespace sipplab
