// The certifying mode: what it proves is so, and it agrees with the validator.
#include "sipplab/validator.hpp"

#include <rapidcheck.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <optional>
#include <ostream>

#include "planner/core/tolerances.hpp"
#include "planner/solve/plan.hpp"
#include "planner/validator/body_track.hpp"
#include "planner/validator/enclosure.hpp"
#include "property_tests/support/encounters.hpp"
#include "property_tests/support/generators.hpp"
#include "property_tests/support/property.hpp"
#include "property_tests/support/sampling_oracle.hpp"

namespace sipplab::certify_laws {
namespace {

constexpr std::size_t kEverything = 1 << 20;
constexpr double kSampleStepS = 1.0 / 64;
/// Cells. Rounding of the validator's distances in scenes as small as these.
constexpr double kRoundingCells = 1e-11;

/// Two bodies whose radii add up to `contact_cells` to the last bit but one.
PairVerdict certify_at(const Trajectory& a, const Trajectory& b, double contact_cells) {
  return certify_pair(a, contact_cells / 2, b, contact_cells - contact_cells / 2);
}

void classify(const PairVerdict& verdict) { RC_TAG(std::string(name(verdict.certificate))); }

// --- enclosures ---------------------------------------------------------------------

/// A double of any sign and of magnitudes that plans have, with all its bits in use.
rc::Gen<double> any_real() {
  return rc::gen::resize(
      rc::kNominalSize,
      rc::gen::apply([](std::int64_t digits,
                        int exponent) { return std::ldexp(static_cast<double>(digits), exponent - 52); },
                     rc::gen::inRange<std::int64_t>(-(std::int64_t{1} << 53), std::int64_t{1} << 53),
                     rc::gen::inRange(-30, 30)));
}

/// An interval, often of one number alone, and a number in it.
struct Member {
  Enclosure interval;
  double number = 0;
};

rc::Gen<Member> any_member() {
  return rc::gen::apply(
      [](double one, double other, int eighths, bool single) {
        if (single) return Member{Enclosure(one), one};
        const Enclosure interval(std::min(one, other), std::max(one, other));
        const double number = interval.low + (interval.high - interval.low) * (eighths / 8.0);
        return Member{interval, std::clamp(number, interval.low, interval.high)};
      },
      any_real(), any_real(), rc::gen::inRange(0, 9), rc::gen::arbitrary<bool>());
}

bool holds(Enclosure interval, long double number) {
  return static_cast<long double>(interval.low) <= number &&
         number <= static_cast<long double>(interval.high);
}

// --- pairs that touch ---------------------------------------------------------------

struct Touch {
  Trajectory a;
  Trajectory b;
  double contact_cells = 1;
};

std::ostream& operator<<(std::ostream& out, const Touch& touch) {
  const auto print = [&](const Trajectory& trajectory) {
    out << " (" << trajectory.start.x << ", " << trajectory.start.y << ")";
    for (const TimedMotion& motion : trajectory.motions)
      out << " until " << motion.end_s << " (" << motion.to.x << ", " << motion.to.y << ")";
  };
  print(touch.a);
  out << " and";
  print(touch.b);
  return out << " touch at " << touch.contact_cells;
}

/// One long motion, and single cells right behind it whose times add up one by one.
Touch convoy(std::int32_t cells, double speed) {
  Touch touch;
  touch.a = {{1, 0}, {{0, cells / speed, {1, 0}, {1 + cells, 0}}}};
  touch.b.start = {0, 0};
  for (std::int32_t x = 0; x < cells; ++x) {
    const double now_s = touch.b.end_s();
    touch.b.motions.push_back({now_s, now_s + 1 / speed, {x, 0}, {x + 1, 0}});
  }
  return touch;
}

/// Past each other in rows side by side.
Touch side_by_side(std::int32_t cells, double speed) {
  return {{{0, 0}, {{0, cells / speed, {0, 0}, {cells, 0}}}},
          {{cells, 1}, {{0, static_cast<double>(cells), {cells, 1}, {0, 1}}}},
          1};
}

/// Two paths that cross at right angles, the second body late by as much as it takes.
Touch crossing(std::int32_t cells, double speed) {
  const double late_s = std::sqrt(2.0) / speed;
  const double duration_s = 2 * cells / speed;
  return {
      {{0, cells}, {{0, duration_s, {0, cells}, {2 * cells, cells}}}},
      {{cells, 0},
       {{0, late_s, {cells, 0}, {cells, 0}}, {late_s, late_s + duration_s, {cells, 0}, {cells, 2 * cells}}}},
      1};
}

/// Along a diagonal past a body at rest.
Touch past_a_corner(std::int32_t cells, double speed) {
  const double duration_s = 2 * cells * std::sqrt(2.0) / speed;
  return {{{cells, cells}, {}},
          {{0, 2 * cells + 1}, {{0, duration_s, {0, 2 * cells + 1}, {2 * cells, 1}}}},
          1 / std::sqrt(2.0)};
}

/// The same, with waits of the body at rest that end just before and after the other one
/// is nearest: a span in which hardly anything moves.
Touch past_a_fidgeting_corner(std::int32_t cells, double speed, double beside_s) {
  Touch touch = past_a_corner(cells, speed);
  const double nearest_s = touch.b.end_s() * (cells + 0.5) / (2 * cells);
  const Cell rest = touch.a.start;
  const double before_s = std::max(0.0, nearest_s - beside_s);
  touch.a.motions.push_back({0, before_s, rest, rest});
  touch.a.motions.push_back({before_s, nearest_s + 0.75 * beside_s, rest, rest});
  return touch;
}

rc::Gen<Touch> any_touch() {
  const auto any_pace = any_of({1.0, 0.3, 0.5, 1.7, 3.0, 0.001, 700.0});
  const auto any_moment = any_of({1e-8, 3e-9, 1e-9, 3e-8, 1e-7, 1e-6, 1e-4, 1e-11});
  return rc::gen::apply(
      [](int kind, std::int32_t cells, double speed, double moment_s) {
        switch (kind) {
          case 0:
            return convoy(cells, speed);
          case 1:
            return side_by_side(cells, speed);
          case 2:
            return crossing(cells, speed);
          case 3:
            return past_a_corner(cells, speed);
          default:
            return past_a_fidgeting_corner(cells, speed, moment_s);
        }
      },
      rc::gen::resize(rc::kNominalSize, rc::gen::inRange(0, 5)),
      rc::gen::resize(rc::kNominalSize, rc::gen::inRange<std::int32_t>(1, 60)),
      rc::gen::resize(rc::kNominalSize, any_pace), rc::gen::resize(rc::kNominalSize, any_moment));
}

// --- against the validator ----------------------------------------------------------

const Violation* find_pair(const ValidationReport& report, const PairFinding& pair) {
  const ViolationKind kind =
      pair.other_is_obstacle ? ViolationKind::kObstacleCollision : ViolationKind::kAgentCollision;
  for (const Violation& violation : report.violations) {
    if (violation.kind == kind && violation.agent == pair.agent && violation.other == pair.other)
      return &violation;
  }
  return nullptr;
}

void never_contradicts(const Scene& scene) {
  ValidationOptions options;
  options.max_violations = kEverything;
  const ValidationReport report = validate(scene.instance, scene.solution, options);
  const Certification certification = certify(scene.instance, scene.solution, kEverything);
  const std::size_t robots = scene.instance.agents.size();
  RC_ASSERT(certification.pairs() ==
            robots * (robots - (robots > 0)) / 2 + robots * scene.instance.obstacles.size());
  RC_ASSERT(certification.findings.size() == certification.collisions + certification.undecided);
  for (const PairFinding& pair : certification.findings) {
    const Violation* violation = find_pair(report, pair);
    // On this lattice no overlap is as shallow as the tolerance, so all is decided.
    RC_ASSERT(pair.verdict.certificate == PairCertificate::kCollision);
    RC_ASSERT(violation != nullptr);
    RC_ASSERT(pair.verdict.depth_cells <= violation->depth_cells + kRoundingCells);
    RC_ASSERT(pair.verdict.depth_cells >= violation->depth_cells - kRoundingCells);
  }
  std::size_t violations = 0;
  for (const Violation& violation : report.violations) {
    violations += violation.kind == ViolationKind::kAgentCollision ||
                  violation.kind == ViolationKind::kObstacleCollision;
  }
  RC_ASSERT(certification.collisions == violations);
  RC_CLASSIFY(certification.collisions > 0, "collisions");
  RC_CLASSIFY(certification.undecided > 0, "undecided");
}

const PropertyRoom room("certify", [] {
  bool passed = true;

  passed &= property("enclosures (1)(2): hold what operations on their members give", [] {
    const Member a = *any_member();
    const Member b = *any_member();
    const auto x = static_cast<long double>(a.number);
    const auto y = static_cast<long double>(b.number);
    RC_ASSERT(holds(a.interval + b.interval, x + y));
    RC_ASSERT(holds(a.interval - b.interval, x - y));
    RC_ASSERT(holds(a.interval * b.interval, x * y));
    if (b.number != 0) RC_ASSERT(holds(a.interval / b.interval, x / y));
    RC_ASSERT(holds(square(a.interval), x * x));
    if (a.number >= 0) RC_ASSERT(holds(square_root(a.interval), std::sqrt(x)));
    RC_CLASSIFY(a.interval.low == a.interval.high, "single numbers");
    RC_CLASSIFY(b.interval.low <= 0 && b.interval.high >= 0, "0 in the divisor");
  });

  passed &= property("planted overlaps of 1e-6 cells and more are all proven", [] {
    const Trajectory a = (*any_walk(5, 5)).trajectory();
    const Trajectory b = (*any_walk(5, 5)).trajectory();
    // The sampled distance is one that the bodies do have at that time.
    const double least_cells = sample_distance(a, b, kSampleStepS).least_cells;
    const double depth_cells = *any_of({1e-6, 1e-5, 1e-4, 1e-3, 1e-2, 0.1, 0.25, 1.0});
    const PairVerdict verdict = certify_at(a, b, least_cells + depth_cells);
    RC_ASSERT(verdict.certificate == PairCertificate::kCollision);
    RC_ASSERT(verdict.depth_cells >= depth_cells - kRoundingCells);
    const Vec2 apart = sampled_position(a, verdict.time_s) - sampled_position(b, verdict.time_s);
    RC_ASSERT(norm(apart) <= least_cells + depth_cells - verdict.depth_cells + kRoundingCells);
    RC_CLASSIFY(least_cells > 0, "not in one place");
    RC_CLASSIFY(verdict.time_s >= std::max(a.arrival_s(), b.arrival_s()), "at the goals for ever");
  });

  passed &= property("bodies that keep 1e-6 cells apart are all proven safe", [] {
    const Trajectory a = (*any_walk(5, 5)).trajectory();
    const Trajectory b = (*any_walk(5, 5)).trajectory();
    const SampledDistance sampled = sample_distance(a, b, kSampleStepS);
    const double contact_cells = sampled.least_cells - sampled.error_cells - 1e-6;
    RC_PRE(contact_cells > 0);
    RC_ASSERT(certify_at(a, b, contact_cells).certificate == PairCertificate::kSafe);
  });

  passed &= property("the tolerance parts the two verdicts, to within rounding", [] {
    const Trajectory a = (*any_walk(5, 5)).trajectory();
    const Trajectory b = (*any_walk(5, 5)).trajectory();
    const double least_cells = closest_approach(make_track(a, 0), make_track(b, 0)).distance_cells;
    RC_PRE(least_cells > 0);
    const double beyond_cells = *any_of({1e-9, -1e-9, 1e-10, -1e-10, 2e-11, -2e-11});
    const PairVerdict verdict = certify_at(a, b, least_cells + kValidatorToleranceCells + beyond_cells);
    classify(verdict);
    RC_ASSERT(verdict.certificate ==
              (beyond_cells > 0 ? PairCertificate::kCollision : PairCertificate::kSafe));
  });

  passed &= property("bodies that touch are never proven to collide", [] {
    const Touch touch = *any_touch();
    const PairVerdict verdict = certify_at(touch.a, touch.b, touch.contact_cells);
    classify(verdict);
    RC_ASSERT(verdict.certificate != PairCertificate::kCollision);
    RC_ASSERT(certify_at(touch.b, touch.a, touch.contact_cells).certificate == verdict.certificate);
    // The same, a little too close: the touch is one.
    RC_ASSERT(certify_at(touch.a, touch.b, touch.contact_cells + 1e-6).certificate ==
              PairCertificate::kCollision);
  });

  passed &= property("within rounding of the tolerance nothing false is proven", [] {
    // The nearest distance, 1 / sqrt(2), depends on no time.
    const auto cells = *rc::gen::inRange<std::int32_t>(1, 60);
    const double speed = *any_of({1.0, 0.3, 1.7, 0.001, 700.0});
    const Touch touch = past_a_fidgeting_corner(cells, speed, *any_of({1e-8, 1e-7, 1e-6, 1e-4, 0.25}));
    const double beyond_cells = *any_of({1e-12, -1e-12, 1e-13, -1e-13, 1e-14, -1e-14, 2e-15, -2e-15});
    const double contact_cells = touch.contact_cells + kValidatorToleranceCells + beyond_cells;
    const PairVerdict verdict = certify_at(touch.a, touch.b, contact_cells);
    classify(verdict);
    RC_ASSERT(verdict.certificate !=
              (beyond_cells > 0 ? PairCertificate::kSafe : PairCertificate::kCollision));
  });

  passed &= property("a proof never contradicts the validator", [] { never_contradicts(*any_scene()); });

  passed &= property("every pair of a plan is proven safe", [] {
    const PlanCase plan_case = *any_case();
    const PlanResult result = plan(plan_case.instance, plan_case.options);
    RC_PRE(result.status == PlanStatus::kSolved);
    const Certification certification = certify(plan_case.instance, result.solution);
    RC_ASSERT(certification.collisions == 0u);
    RC_ASSERT(certification.undecided == 0u);
    classify_case(plan_case);
  });

  return passed;
});

}  // namespace
}  // namespace sipplab::certify_laws
