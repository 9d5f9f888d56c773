// The closest that two bodies come at two times that are not far apart, against many pairs of
// times: what the validator judges inflated times by.
#include "planner/validator/spacing_check.hpp"

#include <rapidcheck.h>

#include <algorithm>
#include <cmath>
#include <ostream>
#include <vector>

#include "property_tests/support/property.hpp"

namespace sipplab {

void showValue(const LinearMotion& motion, std::ostream& out) {
  const Vec2 v = motion.velocity_cells_per_s;
  out << "from (" << motion.from.x << ", " << motion.from.y << ") at " << motion.begin_s << " to "
      << motion.end_s << " s, (" << v.x << ", " << v.y << ") a second";
}

namespace {

/// Sampled times of a motion, both ends among them.
constexpr int kSamples = 33;

/// Seconds of a rest without end in which it is looked at.
constexpr double kLongEnoughS = 16;

/// Cells. Rounding of positions of some ten cells.
constexpr double kRoundingCells = 1e-9;

/// Quarters, so that paths cross in samples, ends meet, and velocities are equal now and then.
double quarters(int least, int most) { return 0.25 * *rc::gen::inRange(least, most + 1); }

LinearMotion make_motion() {
  LinearMotion motion;
  motion.begin_s = quarters(0, 32);
  motion.from = {quarters(-12, 12), quarters(-12, 12)};
  const int kind = *rc::gen::inRange(0, 5);
  if (kind == 0) return motion;  // at rest for ever
  motion.end_s = motion.begin_s + quarters(1, 24);
  if (kind > 1) motion.velocity_cells_per_s = {quarters(-6, 6), quarters(-6, 6)};
  return motion;
}

LinearMotion any_motion() { return *rc::gen::exec(make_motion); }

std::vector<double> sampled(double begin_s, double end_s) {
  std::vector<double> times_s;
  if (begin_s > end_s) return times_s;
  for (int i = 0; i < kSamples; ++i) times_s.push_back(begin_s + (end_s - begin_s) * i / (kSamples - 1));
  return times_s;
}

double last_s(const LinearMotion& motion) { return std::min(motion.end_s, motion.begin_s + kLongEnoughS); }

/// Times at which `b` may be looked at while `a` is at its place of time `a_s`.
std::vector<double> sampled_around(const LinearMotion& b, double a_s, double apart_s) {
  return sampled(std::max(b.begin_s, a_s - apart_s), std::min(b.end_s, a_s + apart_s));
}

}  // namespace
}  // namespace sipplab

int main() {
  using namespace sipplab;
  bool passed = true;

  passed &= property("closest_within: no sampled pair of times is closer", [] {
    const LinearMotion a = any_motion();
    const LinearMotion b = any_motion();
    const double apart_s = quarters(0, 12);
    RC_LOG() << "up to " << apart_s << " s apart\n";
    const Approach closest = closest_within(a, b, apart_s);
    bool any = false;
    for (const double a_s : sampled(a.begin_s, last_s(a))) {
      for (const double b_s : sampled_around(b, a_s, apart_s)) {
        any = true;
        RC_ASSERT(closest.distance_cells <= norm(a.at(a_s) - b.at(b_s)) + kRoundingCells);
      }
    }
    RC_CLASSIFY(!any, "never that near in time");
    RC_CLASSIFY(closest.distance_cells == 0, "paths cross");
  });

  passed &= property("closest_within: at the time that is named, that close it is", [] {
    const LinearMotion a = any_motion();
    const LinearMotion b = any_motion();
    const double apart_s = quarters(0, 12);
    const Approach closest = closest_within(a, b, apart_s);
    RC_PRE(std::isfinite(closest.distance_cells));
    RC_ASSERT(a.begin_s <= closest.time_s);
    RC_ASSERT(closest.time_s <= a.end_s);
    // With `a` at one place the distance is convex over the times of `b`: thirds are left out
    // until nothing is left to choose from.
    const Vec2 place = a.at(closest.time_s);
    double begin_s = std::max(b.begin_s, closest.time_s - apart_s);
    double end_s = std::min(b.end_s, closest.time_s + apart_s);
    RC_ASSERT(begin_s <= end_s + kRoundingCells);
    for (int i = 0; i < 100; ++i) {
      const double third = (end_s - begin_s) / 3;
      const bool later = norm(place - b.at(begin_s + third)) > norm(place - b.at(end_s - third));
      (later ? begin_s : end_s) += later ? third : -third;
    }
    RC_ASSERT(std::abs(norm(place - b.at(begin_s)) - closest.distance_cells) <= 1e3 * kRoundingCells);
  });

  passed &= property("closest_within: the same from the other side, and no farther with more time apart", [] {
    const LinearMotion a = any_motion();
    const LinearMotion b = any_motion();
    const double apart_s = quarters(0, 12);
    const double one = closest_within(a, b, apart_s).distance_cells;
    const double other = closest_within(b, a, apart_s).distance_cells;
    RC_ASSERT(one == other || std::abs(one - other) <= kRoundingCells);
    RC_ASSERT(closest_within(a, b, apart_s + quarters(0, 8)).distance_cells <= one + kRoundingCells);
  });

  return passed ? 0 : 1;
}
