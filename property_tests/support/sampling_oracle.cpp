// Distances by sampling; see sampling_oracle.hpp.
#include "property_tests/support/sampling_oracle.hpp"

#include <algorithm>
#include <limits>
#include <vector>

namespace sipplab {

Vec2 sampled_position(const Trajectory& trajectory, double time_s) {
  for (const TimedMotion& motion : trajectory.motions) {
    if (time_s > motion.end_s) continue;
    // Between motions that leave a gap a body stays where the next one finds it.
    const double part = std::max(0.0, (time_s - motion.begin_s) / (motion.end_s - motion.begin_s));
    return centre(motion.from) + (centre(motion.to) - centre(motion.from)) * part;
  }
  return centre(trajectory.end());
}

double top_speed(const Trajectory& trajectory) {
  double top = 0;
  for (const TimedMotion& motion : trajectory.motions) {
    top = std::max(top, distance(motion.from, motion.to) / (motion.end_s - motion.begin_s));
  }
  return top;
}

SampledDistance sample_distance(const Trajectory& a, const Trajectory& b, double step_s) {
  std::vector<double> times{0};
  const double until_s = std::max(a.arrival_s(), b.arrival_s());
  for (double time_s = 0; time_s < until_s; time_s += step_s) times.push_back(time_s);
  for (const Trajectory* trajectory : {&a, &b}) {
    for (const TimedMotion& motion : trajectory->motions) times.push_back(motion.end_s);
  }
  SampledDistance sampled{std::numeric_limits<double>::infinity(), 0, 0};
  for (const double time_s : times) {
    const double apart = norm(sampled_position(a, time_s) - sampled_position(b, time_s));
    if (apart < sampled.least_cells) sampled = {apart, 0, time_s};
  }
  // No time is farther than half a step from a sample.
  sampled.error_cells = (top_speed(a) + top_speed(b)) * step_s / 2;
  return sampled;
}

}  // namespace sipplab
