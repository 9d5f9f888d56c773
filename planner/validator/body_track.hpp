// A robot or a dynamic obstacle as the validator sees it: a disk that is somewhere
// at every time from 0 on.
#pragma once

#include <vector>

#include "planner/validator/closest_approach.hpp"
#include "sipplab/solution.hpp"

namespace sipplab {

/// A disk and its motions, sorted by begin_s, from 0 to infinity: before the first
/// motion it stands at the start, after the last it rests for ever.
struct BodyTrack {
  double radius_cells = 0;
  std::vector<LinearMotion> motions;
};

/// Whether a motion has a place at each time from its begin to its end: finite times, the end after the
/// begin, and at most twice kMaxSpeedCellsPerS.
bool can_be_followed(const TimedMotion& motion);

/// Never fails. Motions that cannot be followed are left out; the check of
/// single trajectories reports those that go anywhere. A radius that is not a number from 0 to
/// kMaxRadiusCells counts as the nearest one that is.
BodyTrack make_track(const Trajectory& trajectory, double radius_cells);

/// The first time at which two bodies are closest to each other, and their
/// distance then. O(motions of both).
Approach closest_approach(const BodyTrack& a, const BodyTrack& b);

}  // namespace sipplab
