// What inflated collision intervals guarantee: more distance while a robot moves, or more
// time between two bodies in one place.
#pragma once

#include <cstddef>
#include <vector>

#include "planner/validator/body_track.hpp"
#include "sipplab/instance.hpp"

namespace sipplab {

struct SpacingConflict {
  AgentIndex body = 0;    ///< a robot: of distances the one that moves
  std::size_t other = 0;  ///< another body
  double time_s = 0;      ///< when they are nearest; of times, when `body` is there
  double depth_cells = 0;
  bool in_time = false;  ///< at odds with inflate_time_s, else with inflate_distance_cells
};

/// For each pair of bodies that breaks a rule by more than `tolerance_cells`: the deepest
/// place, distances first, then times; each by `body`, then `other`; at most
/// `max_conflicts`.
///  (1) inflate_distance_cells: each robot while it moves, against those before it in
///      `order` (highest priority first; empty: none) and all obstacles.
///  (2) inflate_time_s: each robot at each time t against each later body at all times
///      from t - inflate_time_s to t + inflate_time_s.
/// The bodies from position `robots` on are obstacles. O(n^2) pairs, times the motions of
/// both; nothing if the rules are 0.
/// REQUIRES: `order` is empty or a permutation of the robots.
std::vector<SpacingConflict> check_spacing(const std::vector<BodyTrack>& bodies, std::size_t robots,
                                           const std::vector<AgentIndex>& order, const MotionRules& rules,
                                           double tolerance_cells, std::size_t max_conflicts);

/// Least distance of two points, each at a time of its own, the two at most `apart_s`
/// from each other; `time_s` is that of `a`. Infinity if there are no such times.
Approach closest_within(const LinearMotion& a, const LinearMotion& b, double apart_s);

}  // namespace sipplab
