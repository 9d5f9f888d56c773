// A body over all time; see body_track.hpp.
#include "planner/validator/body_track.hpp"

#include <algorithm>
#include <cmath>

#include "sipplab/instance.hpp"

namespace sipplab {
namespace {

/// Cells per second. Faster motions are jumps, and numbers that large would drown
/// the geometry.
constexpr double kJumpSpeed = 2 * kMaxSpeedCellsPerS;

}  // namespace

bool can_be_followed(const TimedMotion& motion) {
  const double duration_s = motion.end_s - motion.begin_s;
  return motion.begin_s >= 0 && duration_s > 0 && std::isfinite(motion.end_s) &&
         distance(motion.from, motion.to) <= kJumpSpeed * duration_s;
}

BodyTrack make_track(const Trajectory& trajectory, double radius_cells) {
  BodyTrack track;
  track.radius_cells = radius_cells > 0 ? std::min(radius_cells, kMaxRadiusCells) : 0.0;
  track.motions.reserve(trajectory.motions.size() + 2);

  double covered_until_s = 0;
  Vec2 place = centre(trajectory.start);
  for (const TimedMotion& motion : trajectory.motions) {
    if (!can_be_followed(motion)) continue;
    const double duration_s = motion.end_s - motion.begin_s;
    const Vec2 from = centre(motion.from);
    const Vec2 to = centre(motion.to);
    if (motion.begin_s > covered_until_s)
      track.motions.push_back({covered_until_s, motion.begin_s, place, {}});
    const Vec2 path = to - from;
    track.motions.push_back({motion.begin_s, motion.end_s, from, {path.x / duration_s, path.y / duration_s}});
    covered_until_s = std::max(covered_until_s, motion.end_s);
    place = to;
  }
  LinearMotion rest;
  rest.begin_s = covered_until_s;
  rest.from = centre(trajectory.end());
  track.motions.push_back(rest);
  std::stable_sort(track.motions.begin(), track.motions.end(),
                   [](const LinearMotion& a, const LinearMotion& b) { return a.begin_s < b.begin_s; });
  return track;
}

Approach closest_approach(const BodyTrack& a, const BodyTrack& b) {
  Approach least;
  auto motion_a = a.motions.begin();
  auto motion_b = b.motions.begin();
  while (motion_a != a.motions.end() && motion_b != b.motions.end()) {
    const auto approach = closest_approach(*motion_a, *motion_b);
    if (approach && approach->distance_cells < least.distance_cells) least = *approach;
    if (motion_a->end_s < motion_b->end_s) {
      ++motion_a;
    } else {
      ++motion_b;
    }
  }
  return least;
}

}  // namespace sipplab
