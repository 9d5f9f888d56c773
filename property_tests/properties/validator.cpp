// The validator against the slow and obvious model, and against itself seen from
// elsewhere.
#include "sipplab/validator.hpp"

#include <rapidcheck.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <numeric>
#include <set>
#include <tuple>

#include "planner/core/tolerances.hpp"
#include "planner/validator/separation.hpp"
#include "property_tests/support/generators.hpp"
#include "property_tests/support/property.hpp"
#include "property_tests/support/sampling_oracle.hpp"
#include "sipplab/options.hpp"

namespace sipplab::validator_laws {
namespace {

constexpr double kSampleStepS = 1.0 / 64;
/// Nothing is left out of a report on a scene this small.
constexpr std::size_t kEverything = 1 << 20;

struct Body {
  Trajectory trajectory;
  double radius_cells;
};

std::vector<Body> bodies_of(const Scene& scene) {
  std::vector<Body> bodies;
  for (AgentIndex i = 0; i < scene.instance.agents.size(); ++i) {
    bodies.push_back({scene.solution.trajectories[i], scene.instance.agents[i].radius_cells});
  }
  for (const DynamicObstacle& obstacle : scene.instance.obstacles) {
    bodies.push_back({obstacle.trajectory, obstacle.radius_cells});
  }
  return bodies;
}

std::vector<AgentIndex> input_order(const Scene& scene) {
  std::vector<AgentIndex> order;
  for (AgentIndex i = 0; i < scene.instance.agents.size(); ++i) order.push_back(i);
  return order;
}

ValidationReport report_of(const Scene& scene, double ssi_s = 0) {
  ValidationOptions options;
  options.max_violations = kEverything;
  options.ssi_s = ssi_s;
  options.order = input_order(scene);
  return validate(scene.instance, scene.solution, options);
}

/// Violations by what they are about, without places and times.
using Kinds = std::set<std::tuple<ViolationKind, AgentIndex, std::size_t>>;
Kinds kinds_of(const ValidationReport& report) {
  Kinds kinds;
  for (const Violation& violation : report.violations) {
    kinds.emplace(violation.kind, violation.agent, violation.other.value_or(kEverything));
  }
  return kinds;
}

const Violation* find(const ValidationReport& report, ViolationKind kind, AgentIndex agent,
                      std::size_t other) {
  for (const Violation& violation : report.violations) {
    if (violation.kind == kind && violation.agent == agent && violation.other == other) return &violation;
  }
  return nullptr;
}

/// The same motion in more pieces: moves cut at cell centres, waits anywhere, and waits added at the end.
Trajectory in_pieces(const Trajectory& trajectory) {
  Trajectory result{trajectory.start, {}};
  for (const TimedMotion& motion : trajectory.motions) {
    const std::int32_t steps = std::gcd(motion.to.x - motion.from.x, motion.to.y - motion.from.y);
    const std::int32_t pieces = motion.is_turn() ? 1 : motion.is_wait() ? 3 : steps;
    TimedMotion rest = motion;
    for (std::int32_t k = 1; k < pieces; ++k) {
      if (*rc::gen::arbitrary<bool>()) continue;
      TimedMotion piece = rest;
      piece.end_s = motion.begin_s + (motion.end_s - motion.begin_s) * k / pieces;
      piece.to = {motion.from.x + (motion.to.x - motion.from.x) / pieces * k,
                  motion.from.y + (motion.to.y - motion.from.y) / pieces * k};
      if (!(piece.end_s > piece.begin_s && piece.end_s < motion.end_s)) continue;
      result.motions.push_back(piece);
      rest.begin_s = piece.end_s;
      rest.from = piece.to;
    }
    result.motions.push_back(rest);
  }
  for (int waits = *rc::gen::inRange(0, 3); waits > 0; --waits) {
    const double now_s = result.motions.empty() ? 0 : result.motions.back().end_s;
    result.motions.push_back({now_s, now_s + 1.5, result.end(), result.end()});
  }
  return result;
}

/// `least` is a sampled distance of two bodies that touch at `contact`: the true one
/// is at most `least` and at least `least - error`. Does a verdict agree?
void check_against_samples(const Violation* violation, double least, double error, double contact) {
  const double limit = contact - kValidatorToleranceCells;
  if (least < limit) RC_ASSERT(violation != nullptr);
  if (least - error > limit) RC_ASSERT(violation == nullptr);
  if (violation) {
    RC_ASSERT(contact - violation->depth_cells <= least + kValidatorToleranceCells);
    RC_ASSERT(contact - violation->depth_cells >= least - error - kValidatorToleranceCells);
  }
}

/// Cells. Longer motions than most scenes have.
constexpr double kLongCells = 8;

double longest_cells(const Scene& scene) {
  double longest = 0;
  for (const Body& body : bodies_of(scene)) {
    for (const TimedMotion& motion : body.trajectory.motions) {
      longest = std::max(longest, distance(motion.from, motion.to));
    }
  }
  return longest;
}

void agrees_on_pairs(const Scene& scene) {
  const ValidationReport report = report_of(scene);
  const std::vector<Body> bodies = bodies_of(scene);
  const std::size_t robots = scene.instance.agents.size();
  double least_clearance = kClearanceReachCells;
  double largest_error = 0;
  int conflicts = 0;
  for (std::size_t i = 0; i < robots; ++i) {
    for (std::size_t j = i + 1; j < bodies.size(); ++j) {
      const SampledDistance sampled =
          sample_distance(bodies[i].trajectory, bodies[j].trajectory, kSampleStepS);
      const double contact = bodies[i].radius_cells + bodies[j].radius_cells;
      const Violation* violation = j < robots
                                       ? find(report, ViolationKind::kAgentCollision, i, j)
                                       : find(report, ViolationKind::kObstacleCollision, i, j - robots);
      check_against_samples(violation, sampled.least_cells, sampled.error_cells, contact);
      least_clearance = std::min(least_clearance, sampled.least_cells - contact);
      largest_error = std::max(largest_error, sampled.error_cells);
      conflicts += violation != nullptr;
    }
  }
  if (robots > 0 && bodies.size() > 1) {
    RC_ASSERT(report.min_clearance_cells <= least_clearance + kValidatorToleranceCells);
    RC_ASSERT(report.min_clearance_cells >= least_clearance - largest_error - kValidatorToleranceCells);
  }
  RC_CLASSIFY(longest_cells(scene) > kLongCells, "long motions");
  RC_CLASSIFY(conflicts == 0, "no conflicts");
  RC_CLASSIFY(conflicts > 0, "conflicts");
  RC_CLASSIFY(conflicts == 0 && report.min_clearance_cells < 0.25, "close calls");
}

/// Distance of a body's centre to a unit square.
double to_square(Vec2 place, Cell square) {
  const Vec2 apart = place - centre(square);
  return norm({std::max(0.0, std::abs(apart.x) - 0.5), std::max(0.0, std::abs(apart.y) - 0.5)});
}

/// Least room around a body at a place: to blocked cells and to the grid's border.
double static_clearance_at(const GridMap& map, Vec2 place) {
  double least =
      std::min({place.x + 0.5, place.y + 0.5, map.width() - 0.5 - place.x, map.height() - 0.5 - place.y});
  for (std::size_t i = 0; i < map.cell_count(); ++i) {
    if (map.is_blocked(map.cell(i))) least = std::min(least, to_square(place, map.cell(i)));
  }
  return least;
}

void agrees_on_the_map(const Scene& scene) {
  const ValidationReport report = report_of(scene);
  bool any_violated = false;
  for (AgentIndex i = 0; i < scene.instance.agents.size(); ++i) {
    const Agent& agent = scene.instance.agents[i];
    const Trajectory& trajectory = scene.solution.trajectories[i];
    double least = static_clearance_at(scene.instance.map, centre(trajectory.end()));
    for (double time_s = 0; time_s < trajectory.arrival_s(); time_s += kSampleStepS) {
      least = std::min(least, static_clearance_at(scene.instance.map, sampled_position(trajectory, time_s)));
    }
    const double error = top_speed(trajectory) * kSampleStepS;
    const bool violated = kinds_of(report).count({ViolationKind::kStaticObstacle, i, kEverything}) > 0;
    if (least < agent.radius_cells - kValidatorToleranceCells) RC_ASSERT(violated);
    if (least - error > agent.radius_cells - kValidatorToleranceCells) RC_ASSERT(!violated);
    any_violated |= violated;
  }
  RC_CLASSIFY(any_violated, "on blocked cells");
}

void agrees_on_protected_starts(const Scene& scene, double ssi_s) {
  const ValidationReport report = report_of(scene, ssi_s);
  const auto& agents = scene.instance.agents;
  bool any_violated = false;
  for (AgentIndex i = 0; i < agents.size(); ++i) {
    for (AgentIndex j = i + 1; j < agents.size(); ++j) {
      const Trajectory& trajectory = scene.solution.trajectories[i];
      const double contact = agents[i].radius_cells + agents[j].radius_cells;
      const double error = top_speed(trajectory) * kSampleStepS;
      const double until_s = std::min(trajectory.arrival_s(), ssi_s);
      double least = 1e9;         // over the time that counts
      double least_nearby = 1e9;  // the same, with a margin for what samples miss
      const auto look = [&](double time_s) {
        const Vec2 place = sampled_position(trajectory, time_s);
        const double to_start = norm(place - centre(agents[j].start));
        const double to_goal = norm(place - centre(agents[i].goal));
        // Strictly outside: on the very edge of the own goal's disk either verdict is right.
        const bool outside = to_goal > contact + kValidatorToleranceCells;
        if (!std::isinf(ssi_s) || outside) least = std::min(least, to_start);
        if (!std::isinf(ssi_s) || to_goal >= contact - error) least_nearby = std::min(least_nearby, to_start);
      };
      for (double time_s = 0; time_s < until_s; time_s += kSampleStepS) look(time_s);
      look(until_s);
      const Violation* violation = find(report, ViolationKind::kStartSafeInterval, i, j);
      const double limit = contact - kValidatorToleranceCells;
      const bool violated = violation != nullptr;
      if (least < limit) RC_ASSERT(violated);
      if (least_nearby - error > limit) RC_ASSERT(!violated);
      if (violation) {
        RC_ASSERT(contact - violation->depth_cells >= least_nearby - error - kValidatorToleranceCells);
        RC_ASSERT(violation->time_s <= ssi_s);
      }
      any_violated |= violation != nullptr;
    }
  }
  RC_CLASSIFY(any_violated, "intrusions");
}

const PropertyRoom room("validator", [] {
  bool passed = true;

  passed &= property("conflicts and clearance agree with sampling all pairs at many times",
                     [] { agrees_on_pairs(*any_scene()); });

  passed &= property("overlap with the map agrees with sampling all bodies at many times",
                     [] { agrees_on_the_map(*any_scene()); });

  passed &= property("intrusions into protected starts agree with sampling", [] {
    const double ssi_s = *rc::gen::element(0.125, 0.5, 2.5, 7.0, kInfiniteSsi, kInfiniteSsi, kInfiniteSsi);
    agrees_on_protected_starts(*any_scene(), ssi_s);
  });

  passed &= property("a walk alone breaks no rule but those of the map", [] {
    for (const Violation& violation : report_of(*any_scene()).violations) {
      RC_ASSERT(violation.kind == ViolationKind::kStaticObstacle ||
                violation.kind == ViolationKind::kAgentCollision ||
                violation.kind == ViolationKind::kObstacleCollision);
    }
  });

  passed &= property("verdict, costs and hash do not depend on how a motion is written down", [] {
    const Scene scene = *any_scene();
    Scene rewritten = scene;
    for (Trajectory& trajectory : rewritten.solution.trajectories) trajectory = in_pieces(trajectory);
    RC_ASSERT(makespan_s(rewritten.solution) == makespan_s(scene.solution));
    RC_ASSERT(flowtime_s(rewritten.solution) == flowtime_s(scene.solution));
    RC_ASSERT(plan_hash(rewritten.solution) == plan_hash(scene.solution));
    RC_ASSERT(kinds_of(report_of(rewritten)) == kinds_of(report_of(scene)));
    RC_CLASSIFY(rewritten.solution != scene.solution, "rewritten");
  });

  passed &= property("the verdict is the same after a quarter turn and in a mirror", [] {
    const Scene scene = *any_scene();
    const double ssi_s = *rc::gen::element(0.0, 0.625, 3.0, kInfiniteSsi);
    const ValidationReport report = report_of(scene, ssi_s);
    for (const Scene& seen : {rotated(scene), reflected(scene), rotated(rotated(scene))}) {
      RC_ASSERT(kinds_of(report_of(seen, ssi_s)) == kinds_of(report));
    }
    RC_CLASSIFY(report.valid(), "valid");
  });

  passed &= property("the verdict is the same with time scaled by a power of two", [] {
    const Scene scene = *any_scene();
    const double ssi_s = *rc::gen::element(0.0, 0.625, 3.0, kInfiniteSsi);
    const ValidationReport report = report_of(scene, ssi_s);
    for (const double factor : {0.25, 2.0, 8.0}) {
      const ValidationReport scaled = report_of(slowed(scene, factor), ssi_s * factor);
      RC_ASSERT(kinds_of(scaled) == kinds_of(report));
      RC_ASSERT(scaled.min_clearance_cells == report.min_clearance_cells);
    }
  });

  passed &= property("without one agent, exactly the violations without it remain", [] {
    const Scene scene = *any_scene();
    RC_PRE(!scene.instance.agents.empty());
    const double ssi_s = *rc::gen::element(0.0, 2.5, kInfiniteSsi);
    const AgentIndex gone = *rc::gen::inRange<AgentIndex>(0, scene.instance.agents.size());
    Kinds expected;
    for (auto [kind, agent, other] : kinds_of(report_of(scene, ssi_s))) {
      const bool other_is_agent =
          kind == ViolationKind::kAgentCollision || kind == ViolationKind::kStartSafeInterval;
      if (agent == gone || (other_is_agent && other == gone)) continue;
      expected.emplace(kind, agent - (agent > gone ? 1 : 0),
                       other - (other_is_agent && other > gone ? 1 : 0));
    }
    RC_ASSERT(kinds_of(report_of(without_agent(scene, gone), ssi_s)) == expected);
  });

  return passed;
});

}  // namespace
}  // namespace sipplab::validator_laws
