// The closest that two bodies come at two times that are not far apart, against many pairs of
// times: what the validator judges inflated times by.
#include "planner/validator/spacing_check.hpp"

#include <rapidcheck.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <numeric>
#include <ostream>
#include <vector>

#include "planner/core/random.hpp"
#include "planner/core/tolerances.hpp"
#include "property_tests/support/encounters.hpp"
#include "property_tests/support/property.hpp"
#include "property_tests/support/shown.hpp"

namespace sipplab::spacing_laws {
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

LinearMotion any_motion() { return at_full_size(make_motion); }

double any_quarters(int most) {
  return at_full_size([most] { return quarters(0, most); });
}

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

constexpr std::int32_t kTrackSide = 4;

/// A body that walks a little, in short legs with waits between them.
BodyTrack any_track(Trajectory& trajectory) {
  trajectory.start = *any_cell(kTrackSide, kTrackSide);
  for (int legs = *rc::gen::inRange(0, 5); legs > 0; --legs) {
    const double now_s = trajectory.end_s();
    if (*rc::gen::inRange(0, 3) == 0) {
      trajectory.motions.push_back({now_s, now_s + quarters(1, 6), trajectory.end(), trajectory.end()});
    } else {
      trajectory.motions.push_back(
          {now_s, now_s + quarters(1, 8), trajectory.end(), *any_cell(kTrackSide, kTrackSide)});
    }
  }
  return make_track(trajectory, *any_of({0.5, 0.25, 0.5, 0.125, 0.75}));
}

/// One that goes the same way as another, later by what it has to be later, or a little less.
BodyTrack follower_of(Trajectory trajectory, double apart_s) {
  const double later_s = std::max(0.125, apart_s - *any_of({0.0, 0.0625, 0.25, 0.5}));
  for (TimedMotion& motion : trajectory.motions) {
    motion.begin_s += later_s;
    motion.end_s += later_s;
  }
  return make_track(trajectory, *any_of({0.5, 0.125, 0.25}));
}

/// One that sets out when another has ended a leg, and comes to where that leg began a moment before it has
/// to keep away no longer.
BodyTrack crosser_of(const Trajectory& trajectory, double apart_s) {
  constexpr double kLaterS = 0.125;
  for (const TimedMotion& leg : trajectory.motions) {
    const double begin_s = leg.end_s + kLaterS;
    const double end_s = leg.begin_s + apart_s - *any_of({0.0625, 0.0, 0.25});
    if (leg.is_wait() || end_s <= begin_s) continue;
    const Cell from{leg.from.x + *any_of({2, -2}), leg.from.y + *any_of({2, 0, -2})};
    const Trajectory crosser{
        from,
        {{0, begin_s, from, from}, {begin_s, end_s, from, leg.from}, {end_s, end_s + 0.5, leg.from, from}}};
    return make_track(crosser, *any_of({0.5, 0.125, 0.25}));
  }
  return follower_of(trajectory, apart_s);
}

struct Crowd {
  std::vector<BodyTrack> bodies;
  std::size_t robots = 0;
  std::vector<AgentIndex> order;  ///< of the robots, or empty
  MotionRules rules;
};

Crowd make_crowd() {
  Crowd crowd;
  crowd.rules.inflate_distance_cells = *any_of({0.0, 0.25, 0.5});
  crowd.rules.inflate_time_s = *any_of({0.0, 0.25, 0.75, 1.5});
  for (int bodies = *rc::gen::inRange(1, 4); bodies > 0; --bodies) {
    Trajectory trajectory;
    crowd.bodies.push_back(any_track(trajectory));
    const int kind = *rc::gen::inRange(0, 3);
    if (kind == 1) crowd.bodies.push_back(follower_of(trajectory, crowd.rules.inflate_time_s));
    if (kind == 2) crowd.bodies.push_back(crosser_of(trajectory, crowd.rules.inflate_time_s));
  }
  crowd.robots = *rc::gen::inRange<std::size_t>(0, crowd.bodies.size() + 1);
  if (*rc::gen::inRange(0, 4) == 0) return crowd;
  crowd.order.resize(crowd.robots);
  std::iota(crowd.order.begin(), crowd.order.end(), AgentIndex{0});
  Random random(*rc::gen::arbitrary<std::uint64_t>());
  random.shuffle(crowd.order);
  return crowd;
}

std::ostream& operator<<(std::ostream& out, const Crowd& crowd) {
  out << crowd.rules.inflate_distance_cells << " cells and " << crowd.rules.inflate_time_s
      << " s apart, the first " << crowd.robots << " of these are robots"
      << (crowd.order.empty() ? ", without an order" : "");
  for (const AgentIndex robot : crowd.order) out << " " << robot;
  for (const BodyTrack& body : crowd.bodies) {
    out << "\nradius " << body.radius_cells;
    for (const LinearMotion& motion : body.motions) {
      out << "\n  ";
      showValue(motion, out);
    }
  }
  return out;
}

/// Each motion against each other motion.
double nearest_of_all(const BodyTrack& a, const BodyTrack& b, double apart_s) {
  double least = kForever;
  for (const LinearMotion& one : a.motions) {
    for (const LinearMotion& other : b.motions) {
      least = std::min(least, closest_within(one, other, apart_s).distance_cells);
    }
  }
  return least;
}

double nearest_while_moving(const BodyTrack& a, const BodyTrack& b) {
  double least = kForever;
  for (const LinearMotion& one : a.motions) {
    if (norm(one.velocity_cells_per_s) == 0) continue;
    for (const LinearMotion& other : b.motions) {
      least = std::min(least, closest_within(one, other, 0).distance_cells);
    }
  }
  return least;
}

std::vector<SpacingConflict> all_conflicts(const Crowd& crowd) {
  std::vector<SpacingConflict> found;
  const auto judge = [&](AgentIndex body, std::size_t other, double nearest, double extra, bool in_time) {
    const double depth = crowd.bodies[body].radius_cells + crowd.bodies[other].radius_cells + extra - nearest;
    if (depth > kValidatorToleranceCells) found.push_back({body, other, 0, depth, in_time});
  };
  const auto comes_before = [&](std::size_t other, AgentIndex body) {
    const auto place = [&](std::size_t robot) {
      return std::find(crowd.order.begin(), crowd.order.end(), robot);
    };
    return other >= crowd.robots || (!crowd.order.empty() && place(other) < place(body));
  };
  for (AgentIndex body = 0; crowd.rules.inflate_distance_cells > 0 && body < crowd.robots; ++body) {
    for (std::size_t other = 0; other < crowd.bodies.size(); ++other) {
      if (other == body || !comes_before(other, body)) continue;
      judge(body, other, nearest_while_moving(crowd.bodies[body], crowd.bodies[other]),
            crowd.rules.inflate_distance_cells, false);
    }
  }
  for (AgentIndex body = 0; crowd.rules.inflate_time_s > 0 && body < crowd.robots; ++body) {
    for (std::size_t other = body + 1; other < crowd.bodies.size(); ++other) {
      judge(body, other, nearest_of_all(crowd.bodies[body], crowd.bodies[other], crowd.rules.inflate_time_s),
            0, true);
    }
  }
  return found;
}

const PropertyRoom room("spacing", [] {
  bool passed = true;

  passed &= property("closest_within: no sampled pair of times is closer", [] {
    const LinearMotion a = any_motion();
    const LinearMotion b = any_motion();
    const double apart_s = any_quarters(12);
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
    const double apart_s = any_quarters(12);
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
    const double apart_s = any_quarters(12);
    const double one = closest_within(a, b, apart_s).distance_cells;
    const double other = closest_within(b, a, apart_s).distance_cells;
    RC_ASSERT(one == other || std::abs(one - other) <= kRoundingCells);
    RC_ASSERT(closest_within(a, b, apart_s + any_quarters(8)).distance_cells <= one + kRoundingCells);
  });

  passed &= property("check_spacing (1)(2): whole tracks, as each motion against each other motion says", [] {
    const Crowd crowd = at_full_size(make_crowd);
    const std::vector<SpacingConflict> expected = all_conflicts(crowd);
    const std::size_t most = *any_of<std::size_t>({100, 100, 2, 1});
    const std::vector<SpacingConflict> found =
        check_spacing(crowd.bodies, crowd.robots, crowd.order, crowd.rules, kValidatorToleranceCells, most);
    RC_ASSERT(found.size() == std::min(expected.size(), most));
    for (std::size_t i = 0; i < found.size(); ++i) {
      RC_ASSERT(found[i].body == expected[i].body);
      RC_ASSERT(found[i].other == expected[i].other);
      RC_ASSERT(found[i].in_time == expected[i].in_time);
      RC_ASSERT(std::abs(found[i].depth_cells - expected[i].depth_cells) <= kRoundingCells);
    }
    RC_CLASSIFY(expected.empty(), "nobody too near");
    RC_CLASSIFY(!expected.empty() && expected.back().in_time, "too near in time");
    RC_CLASSIFY(!expected.empty() && !expected.front().in_time, "too near while moving");
  });

  return passed;
});

}  // namespace
}  // namespace sipplab::spacing_laws
