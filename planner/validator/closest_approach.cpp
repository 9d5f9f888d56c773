// How close two moving points come; see closest_approach.hpp.
#include "planner/validator/closest_approach.hpp"

#include <algorithm>

namespace sipplab {
namespace {

/// `apart` is the vector from one point to the other at begin_s, `velocity` its change.
Approach least_distance(Vec2 apart, Vec2 velocity, double begin_s, double end_s) {
  // |apart + velocity * s|^2 = |velocity|^2 s^2 + 2 (apart . velocity) s + |apart|^2.
  const double curvature = squared_norm(velocity);
  if (!(curvature > 0)) return {begin_s, norm(apart)};
  const double after_s = std::clamp(-dot(apart, velocity) / curvature, 0.0, end_s - begin_s);
  return {begin_s + after_s, norm(apart + velocity * after_s)};
}

}  // namespace

Approach closest_approach(const LinearMotion& a, const LinearMotion& b, double begin_s, double end_s) {
  return least_distance(a.at(begin_s) - b.at(begin_s), a.velocity_cells_per_s - b.velocity_cells_per_s,
                        begin_s, end_s);
}

std::optional<Approach> closest_approach(const LinearMotion& a, const LinearMotion& b) {
  const double begin_s = std::max(a.begin_s, b.begin_s);
  const double end_s = std::min(a.end_s, b.end_s);
  if (!(begin_s <= end_s)) return std::nullopt;
  return closest_approach(a, b, begin_s, end_s);
}

Approach closest_approach(const LinearMotion& motion, Vec2 place, double begin_s, double end_s) {
  return least_distance(motion.at(begin_s) - place, motion.velocity_cells_per_s, begin_s, end_s);
}

}  // namespace sipplab
