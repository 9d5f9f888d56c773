// Inflated distances and times; see spacing_check.hpp.
#include "planner/validator/spacing_check.hpp"

#include <algorithm>
#include <cmath>

namespace sipplab {
namespace {

void keep_nearer(const Approach& candidate, Approach& least) {
  if (candidate.distance_cells < least.distance_cells) least = candidate;
}

/// `motion` against where `fixed` is at one time, over the times within `apart_s` of it.
Approach closest_around(const LinearMotion& motion, const LinearMotion& fixed, double time_s,
                        double apart_s) {
  const double begin_s = std::max(motion.begin_s, time_s - apart_s);
  const double end_s = std::min(motion.end_s, time_s + apart_s);
  if (!std::isfinite(time_s) || begin_s > end_s) return {};
  return closest_approach(motion, fixed.at(time_s), begin_s, end_s);
}

/// Where the paths of two moving points cross, if each comes by at a time of its span and
/// the two times are near enough.
Approach crossing(const LinearMotion& a, const LinearMotion& b, double apart_s) {
  const double turn = cross(a.velocity_cells_per_s, b.velocity_cells_per_s);
  if (turn == 0) return {};
  const Vec2 apart = b.from - a.from;
  const double a_s = a.begin_s + cross(apart, b.velocity_cells_per_s) / turn;
  const double b_s = b.begin_s + cross(apart, a.velocity_cells_per_s) / turn;
  const bool within = a.begin_s <= a_s && a_s <= a.end_s && b.begin_s <= b_s && b_s <= b.end_s &&
                      std::abs(a_s - b_s) <= apart_s;
  if (!within) return {};
  return {a_s, 0};
}

LinearMotion delayed(LinearMotion motion, double seconds) {
  motion.begin_s += seconds;
  motion.end_s += seconds;
  return motion;
}

/// Body `a` while it moves and body `b`, at the same time.
Approach closest_while_moving(const BodyTrack& a, const BodyTrack& b) {
  Approach least;
  for (const LinearMotion& motion : a.motions) {
    if (motion.is_rest()) continue;
    for (const LinearMotion& other : b.motions) {
      if (other.begin_s > motion.end_s) break;
      if (const auto approach = closest_approach(motion, other)) keep_nearer(*approach, least);
    }
  }
  return least;
}

Approach closest_within(const BodyTrack& a, const BodyTrack& b, double apart_s) {
  Approach least;
  for (const LinearMotion& motion : a.motions) {
    for (const LinearMotion& other : b.motions) {
      if (other.begin_s > motion.end_s + apart_s) break;
      keep_nearer(closest_within(motion, other, apart_s), least);
    }
  }
  return least;
}

}  // namespace

Approach closest_within(const LinearMotion& a, const LinearMotion& b, double apart_s) {
  // The squared distance is convex over both times. Its least is 0 if two paths cross, or
  // else on the border of what times are allowed: one point at an end of its motion, or
  // the two times as far from each other as may be.
  Approach least = crossing(a, b, apart_s);
  for (const double time_s : {a.begin_s, a.end_s}) {
    Approach approach = closest_around(b, a, time_s, apart_s);
    approach.time_s = time_s;
    keep_nearer(approach, least);
  }
  for (const double time_s : {b.begin_s, b.end_s}) {
    keep_nearer(closest_around(a, b, time_s, apart_s), least);
  }
  for (const double seconds : {-apart_s, apart_s}) {
    if (const auto approach = closest_approach(a, delayed(b, seconds))) keep_nearer(*approach, least);
  }
  return least;
}

std::vector<SpacingConflict> check_spacing(const std::vector<BodyTrack>& bodies, std::size_t robots,
                                           const std::vector<AgentIndex>& order, const MotionRules& rules,
                                           double tolerance_cells, std::size_t max_conflicts) {
  std::vector<SpacingConflict> conflicts;
  const auto judge = [&](AgentIndex body, std::size_t other, const Approach& nearest, double extra_cells,
                         bool in_time) {
    const double depth_cells =
        bodies[body].radius_cells + bodies[other].radius_cells + extra_cells - nearest.distance_cells;
    if (!(depth_cells > tolerance_cells) || conflicts.size() >= max_conflicts) return;
    conflicts.push_back({body, other, nearest.time_s, depth_cells, in_time});
  };

  if (rules.inflate_distance_cells > 0) {
    std::vector<std::size_t> rank(robots, 0);
    for (std::size_t i = 0; i < order.size(); ++i) rank[order[i]] = i;
    for (AgentIndex body = 0; body < robots; ++body) {
      for (std::size_t other = 0; other < bodies.size(); ++other) {
        if (other < robots && rank[other] >= rank[body]) continue;
        const Approach nearest = closest_while_moving(bodies[body], bodies[other]);
        judge(body, other, nearest, rules.inflate_distance_cells, false);
      }
    }
  }
  if (rules.inflate_time_s > 0) {
    for (AgentIndex body = 0; body < robots; ++body) {
      for (std::size_t other = body + 1; other < bodies.size(); ++other) {
        judge(body, other, closest_within(bodies[body], bodies[other], rules.inflate_time_s), 0, true);
      }
    }
  }
  return conflicts;
}

}  // namespace sipplab
