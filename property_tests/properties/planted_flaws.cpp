// The validator finds what is wrong with one trajectory: flaws of known kind and size,
// planted into walks that have none. Collisions are planted in planted_overlap.cpp.
#include <rapidcheck.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <numeric>
#include <string>
#include <tuple>
#include <vector>

#include "property_tests/support/encounters.hpp"
#include "property_tests/support/generators.hpp"
#include "property_tests/support/property.hpp"
#include "sipplab/options.hpp"
#include "sipplab/validator.hpp"

namespace sipplab::planted_flaws_laws {
namespace {

/// Nothing is left out of a report on a scene this small.
constexpr std::size_t kEverything = 1 << 20;

bool has(const ValidationReport& report, ViolationKind kind, AgentIndex agent) {
  return std::any_of(report.violations.begin(), report.violations.end(), [&](const Violation& violation) {
    return violation.kind == kind && violation.agent == agent && !violation.message.empty();
  });
}

ValidationReport report_of(const Scene& scene) {
  ValidationOptions options;
  options.max_violations = kEverything;
  return validate(scene.instance, scene.solution, options);
}

void delay_from(Trajectory& trajectory, std::size_t motion, double by_s) {
  for (std::size_t i = motion; i < trajectory.motions.size(); ++i) {
    trajectory.motions[i].begin_s += by_s;
    trajectory.motions[i].end_s += by_s;
  }
}

/// A scene, one of its robots, and one of that robot's motions.
struct Place {
  Scene scene;
  AgentIndex agent = 0;
  std::size_t motion = 0;

  Trajectory& trajectory() { return scene.solution.trajectories[agent]; }
  TimedMotion& timed_motion() { return trajectory().motions[motion]; }
};

Place any_place() {
  Place place;
  place.scene = *any_scene();
  std::vector<AgentIndex> moving;
  for (AgentIndex i = 0; i < place.scene.solution.trajectories.size(); ++i) {
    if (!place.scene.solution.trajectories[i].motions.empty()) moving.push_back(i);
  }
  RC_PRE(!moving.empty());
  place.agent = *rc::gen::elementOf(moving);
  place.motion = *rc::gen::inRange<std::size_t>(0, place.trajectory().motions.size());
  return place;
}

/// Seconds: from what rounding cannot explain to what anybody sees.
double any_error_s() { return *any_of({0.125, 1.0, 1e-3, 1e-6}); }

void finds_endpoints() {
  Place place = any_place();
  Agent& agent = place.scene.instance.agents[place.agent];
  const bool at_start = *rc::gen::arbitrary<bool>();
  const bool along_x = *rc::gen::arbitrary<bool>();
  Cell& moved = at_start ? agent.start : agent.goal;
  (along_x ? moved.x : moved.y) += 1;
  RC_ASSERT(has(report_of(place.scene), ViolationKind::kEndpoint, place.agent));
}

void finds_gaps_in_time() {
  Place place = any_place();
  const double error_s = any_error_s();
  delay_from(place.trajectory(), place.motion, error_s);
  RC_ASSERT(has(report_of(place.scene), ViolationKind::kDiscontinuity, place.agent));
  // Begun too early: the motion before is not over.
  const double early_s = 2 * error_s;
  if (place.timed_motion().begin_s < early_s) return;
  delay_from(place.trajectory(), place.motion, -early_s);
  RC_ASSERT(has(report_of(place.scene), ViolationKind::kDiscontinuity, place.agent));
  RC_TAG("too early, too");
}

void finds_jumps() {
  Place place = any_place();
  TimedMotion& motion = place.timed_motion();
  const Cell elsewhere{motion.from.x + *rc::gen::inRange(-1, 2), motion.from.y + *rc::gen::inRange(-1, 2)};
  RC_PRE(elsewhere != motion.from);
  motion.from = elsewhere;
  RC_ASSERT(has(report_of(place.scene), ViolationKind::kDiscontinuity, place.agent));
}

void finds_wrong_speeds() {
  Place place = any_place();
  RC_PRE(!place.timed_motion().is_wait());
  const bool too_slow = *rc::gen::arbitrary<bool>();
  const double duration_s = place.timed_motion().end_s - place.timed_motion().begin_s;
  const double error_s = too_slow ? any_error_s() : -std::min(any_error_s(), duration_s / 2);
  place.timed_motion().end_s += error_s;
  delay_from(place.trajectory(), place.motion + 1, error_s);
  const ValidationReport report = report_of(place.scene);
  RC_ASSERT(has(report, ViolationKind::kSpeed, place.agent));
  RC_ASSERT(!has(report, ViolationKind::kDiscontinuity, place.agent));
  RC_CLASSIFY(too_slow, "too slow");
}

void finds_waits_backwards() {
  Place place = any_place();
  const TimedMotion before = place.timed_motion();
  const double error_s = std::min(any_error_s(), before.end_s);
  auto& motions = place.trajectory().motions;
  motions.insert(motions.begin() + static_cast<std::ptrdiff_t>(place.motion) + 1,
                 {before.end_s, before.end_s - error_s, before.to, before.to});
  delay_from(place.trajectory(), place.motion + 2, -error_s);
  RC_ASSERT(has(report_of(place.scene), ViolationKind::kDiscontinuity, place.agent));
}

void finds_times_that_are_none() {
  Place place = any_place();
  const double time_s =
      *any_of({std::numeric_limits<double>::quiet_NaN(), std::numeric_limits<double>::infinity(), -0.125});
  (*rc::gen::arbitrary<bool>() ? place.timed_motion().begin_s : place.timed_motion().end_s) = time_s;
  RC_ASSERT(has(report_of(place.scene), ViolationKind::kNotFinite, place.agent));
}

void finds_missing_trajectories() {
  Scene scene = *any_scene();
  if (*rc::gen::arbitrary<bool>()) {
    scene.solution.trajectories.emplace_back();
  } else {
    RC_PRE(!scene.solution.trajectories.empty());
    scene.solution.trajectories.pop_back();
  }
  RC_ASSERT(has(report_of(scene), ViolationKind::kAgentCount, 0));
}

using About = std::tuple<ViolationKind, AgentIndex, std::size_t>;
std::vector<About> abouts(const ValidationReport& report) {
  std::vector<About> abouts;
  for (const Violation& violation : report.violations) {
    abouts.emplace_back(violation.kind, violation.agent, violation.other.value_or(kEverything));
  }
  return abouts;
}

void keeps_to_the_limit() {
  const Scene scene = *any_scene();
  ValidationOptions options;
  options.max_violations = *rc::gen::inRange<std::size_t>(0, 6);
  options.ssi_s = *any_of({0.0, 1.0, kInfiniteSsi});
  options.order.resize(scene.instance.agents.size());
  std::iota(options.order.begin(), options.order.end(), AgentIndex{0});
  const std::vector<About> some = abouts(validate(scene.instance, scene.solution, options));
  const std::size_t limit = std::max<std::size_t>(1, options.max_violations);
  options.max_violations = kEverything;
  const std::vector<About> all = abouts(validate(scene.instance, scene.solution, options));
  RC_ASSERT(some.size() == std::min(limit, all.size()));
  for (const About& about : some) RC_ASSERT(std::count(all.begin(), all.end(), about) > 0);
  RC_CLASSIFY(all.size() > limit, "cut short");
}

void wants_an_order_of_all() {
  const Scene scene = *any_scene();
  const std::size_t agents = scene.instance.agents.size();
  RC_PRE(agents > 0u);
  ValidationOptions options;
  options.max_violations = kEverything;
  options.ssi_s = *any_of({0.5, 3.0, kInfiniteSsi});
  for (AgentIndex agent = 0; agent < agents; ++agent) {
    // Now and then one that is there already, or nowhere.
    const bool another = *rc::gen::inRange(0, 4) == 0;
    options.order.push_back(another ? *rc::gen::inRange<AgentIndex>(0, agents + 1) : agent);
  }
  if (*rc::gen::inRange(0, 4) == 0) options.order.pop_back();
  RC_PRE(!options.order.empty());
  std::vector<AgentIndex> sorted = options.order;
  std::sort(sorted.begin(), sorted.end());
  bool is_order = sorted.size() == agents;
  for (AgentIndex agent = 0; is_order && agent < agents; ++agent) is_order = sorted[agent] == agent;
  const ValidationReport report = validate(scene.instance, scene.solution, options);
  const bool refused =
      std::any_of(report.violations.begin(), report.violations.end(), [](const Violation& violation) {
        return violation.kind == ViolationKind::kStartSafeInterval && !violation.other.has_value();
      });
  RC_ASSERT(refused == !is_order);
  RC_CLASSIFY(is_order, "orders");
}

const PropertyRoom room("planted_flaws", [] {
  bool passed = true;

  passed &= property("a start or goal that is another is found", finds_endpoints);
  passed &= property("a gap in time is found, forwards and backwards", finds_gaps_in_time);
  passed &= property("a jump is found", finds_jumps);
  passed &= property("a motion that is too fast or too slow is found, however little", finds_wrong_speeds);
  passed &= property("a wait backwards in time is found", finds_waits_backwards);
  passed &= property("a time that is no number, endless or negative is found", finds_times_that_are_none);
  passed &= property("a trajectory too few or too many is found", finds_missing_trajectories);
  passed &= property("max_violations: so many of all that there are", keeps_to_the_limit);
  passed &=
      property("a guarantee to an order that is not one of all robots is refused", wants_an_order_of_all);

  return passed;
});

}  // namespace
}  // namespace sipplab::planted_flaws_laws
