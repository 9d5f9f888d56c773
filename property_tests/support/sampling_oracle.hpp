// The slow and obvious model of "too close": look at both bodies at many times.
#pragma once

#include "sipplab/geometry.hpp"
#include "sipplab/solution.hpp"

namespace sipplab {

/// Where a body is: found by reading its motions from the first one on.
Vec2 sampled_position(const Trajectory& trajectory, double time_s);

/// Fastest motion of a trajectory, in cells per second.
double top_speed(const Trajectory& trajectory);

struct SampledDistance {
  double least_cells = 0;  ///< the true least distance is no more than this ...
  double error_cells = 0;  ///< ... and no less than this much below it
  double time_s = 0;       ///< when the least distance was seen
};

/// Distance of two bodies at the times 0, step_s, 2 step_s, ... until both rest,
/// and at the ends of all motions.
SampledDistance sample_distance(const Trajectory& a, const Trajectory& b, double step_s);

}  // namespace sipplab
