// A robot or a dynamic obstacle as the validator sees it: a disk that is somewhere
// at every time from 0 on.
#pragma once

#include <vector>

#include "planner/solution/trajectory.hpp"
#include "planner/validator/closest_approach.hpp"

namespace sipplab {

/// A disk and its motions, sorted by begin_s, from 0 to infinity: before the first
/// motion it stands at the start, after the last it rests for ever.
struct BodyTrack {
  double radius_cells = 0;
  std::vector<LinearMotion> motions;
};

/// Never fails. Motions that nothing could make are left out, for other checks
/// report them: an end no later than the begin, times that are not finite, more
/// than twice kMaxSpeedCellsPerS. A radius that is not a number from 0 to
/// kMaxRadiusCells counts as the nearest one that is.
BodyTrack make_track(const Trajectory& trajectory, double radius_cells);

/// The first time at which two bodies are closest to each other, and their
/// distance then. O(motions of both).
Approach closest_approach(const BodyTrack& a, const BodyTrack& b);

}  // namespace sipplab
