// What a motion is, however it is written down; see trajectory.hpp.
#include "sipplab/solution.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>

namespace sipplab {
namespace {

/// Relative difference of speeds, no unit. Above the rounding of times of 1e5 s, which is 1e-11 s for a step
/// of 1 s; far below any difference of speeds that a plan would use.
constexpr double kSameSpeed = 1e-9;

bool is_plain_wait(const TimedMotion& motion) { return motion.is_wait() && !motion.is_turn(); }

/// Whether `next`, which begins where and when `motion` ends, only continues it.
bool continues(const TimedMotion& motion, const TimedMotion& next) {
  if (motion.is_turn() || next.is_turn() || motion.is_wait() != next.is_wait()) return false;
  if (motion.end_s != next.begin_s || motion.to != next.from) return false;
  if (motion.is_wait()) return true;
  const std::int64_t ax = motion.to.x - motion.from.x;
  const std::int64_t ay = motion.to.y - motion.from.y;
  const std::int64_t bx = next.to.x - next.from.x;
  const std::int64_t by = next.to.y - next.from.y;
  if (ax * by != ay * bx || ax * bx + ay * by <= 0) return false;
  // In one direction at one speed, seconds are proportional to cells.
  const double expected_s = (motion.end_s - motion.begin_s) *
                            static_cast<double>(std::abs(bx) + std::abs(by)) /
                            static_cast<double>(std::abs(ax) + std::abs(ay));
  return std::abs(next.end_s - next.begin_s - expected_s) <= kSameSpeed * expected_s;
}

}  // namespace

double Trajectory::arrival_s() const {
  const auto last = std::find_if_not(motions.rbegin(), motions.rend(), is_plain_wait);
  return last == motions.rend() ? 0.0 : last->end_s;
}

Trajectory canonical(const Trajectory& trajectory) {
  Trajectory result{trajectory.start, {}};
  for (const TimedMotion& motion : trajectory.motions) {
    if (!result.motions.empty() && continues(result.motions.back(), motion)) {
      result.motions.back().to = motion.to;
      result.motions.back().end_s = motion.end_s;
    } else {
      result.motions.push_back(motion);
    }
  }
  while (!result.motions.empty() && is_plain_wait(result.motions.back())) result.motions.pop_back();
  return result;
}

}  // namespace sipplab
