// Re-timing: against another solver of the same constraints, by its own contracts, and as the validator
// judges it.
#include <rapidcheck.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <numeric>
#include <optional>
#include <set>

#include "planner/complete/complete_planner.hpp"
#include "planner/retime/retime.hpp"
#include "planner/solve/plan.hpp"
#include "planner/validator/closest_approach.hpp"
#include "property_tests/support/generators.hpp"
#include "property_tests/support/property.hpp"
#include "sipplab/validator.hpp"

namespace sipplab::retiming_laws {
namespace {

/// Seconds. Above what bisection and rounding leave.
constexpr double kSameTimeS = 1e-7;

/// Robots on random walks of unit steps, all at once, as programs in discrete time plan: no two at a cell, no
/// two that change places; rings that turn are allowed. Bodies of all sizes that fit and, one time in two, of
/// different speeds.
Scene make_discrete_scene(std::uint64_t seed) {
  Random random(seed);
  const auto upto = [&random](std::uint64_t most) {
    return 1 + static_cast<std::int32_t>(random.below(most));
  };
  Scene scene;
  GridMap& map = scene.instance.map;
  map = GridMap(1 + upto(4), upto(4));
  std::vector<std::size_t> at(map.cell_count());
  std::iota(at.begin(), at.end(), std::size_t{0});
  random.shuffle(at);
  at.resize(map.cell_count() - random.below(std::min<std::size_t>(map.cell_count(), 6)));
  const bool are_equal = random.below(2) == 0;
  constexpr double kRadii[] = {0.5, 0.5, 0.375, 0.25};
  constexpr double kSpeeds[] = {1, 1, 2, 0.5};
  const double radius = kRadii[random.below(4)];
  for (const std::size_t cell : at) {
    Agent agent;
    agent.id = std::to_string(scene.instance.agents.size());
    agent.start = map.cell(cell);
    agent.radius_cells = are_equal ? radius : kRadii[random.below(4)];
    agent.speed_cells_per_s = are_equal ? 1 : kSpeeds[random.below(4)];
    scene.instance.agents.push_back(agent);
    scene.solution.trajectories.push_back({agent.start, {}});
  }
  const std::uint64_t steps = random.below(9);
  for (std::uint64_t step = 0; step < steps; ++step) {
    std::map<std::size_t, std::size_t> from;  // robots by their cells before the step
    for (std::size_t robot = 0; robot < at.size(); ++robot) from[at[robot]] = robot;
    std::vector<std::size_t> next = at;
    std::set<std::size_t> taken(at.begin(), at.end());
    for (std::size_t robot = 0; robot < at.size(); ++robot) {
      const Cell here = map.cell(at[robot]);
      constexpr Cell kSteps[] = {{1, 0}, {0, 1}, {-1, 0}, {0, -1}};
      const Cell by = kSteps[random.below(4)];
      const Cell there{here.x + by.x, here.y + by.y};
      if (map.contains(there) && random.below(6) > 0) next[robot] = map.index(there);
    }
    if (map.width() > 1 && map.height() > 1 && random.below(6) == 0) {  // a ring turns, the others stay
      const Cell corner{upto(static_cast<std::uint64_t>(map.width()) - 1) - 1,
                        upto(static_cast<std::uint64_t>(map.height()) - 1) - 1};
      for (std::size_t robot = 0; robot < at.size(); ++robot) {
        const Cell in{map.cell(at[robot]).x - corner.x, map.cell(at[robot]).y - corner.y};
        const bool is_in_ring = 0 <= in.x && in.x <= 1 && 0 <= in.y && in.y <= 1;
        next[robot] = is_in_ring ? map.index({corner.x + 1 - in.y, corner.y + in.x}) : at[robot];
      }
    }
    // Whoever cannot have its way stays, until all is well.
    for (bool changed = true; changed;) {
      changed = false;
      std::map<std::size_t, std::size_t> to;
      for (std::size_t robot = 0; robot < at.size(); ++robot) {
        if (next[robot] == at[robot]) to[at[robot]] = robot;
      }
      for (std::size_t robot = 0; robot < at.size(); ++robot) {
        if (next[robot] == at[robot]) continue;
        const auto other = from.find(next[robot]);
        const bool swaps = other != from.end() && next[other->second] == at[robot];
        if (swaps || !to.emplace(next[robot], robot).second) {
          next[robot] = at[robot];
          changed = true;
        }
      }
    }
    for (std::size_t robot = 0; robot < at.size(); ++robot) {
      const auto begin_s = static_cast<double>(step);
      scene.solution.trajectories[robot].motions.push_back(
          {begin_s, begin_s + 1, map.cell(at[robot]), map.cell(next[robot])});
    }
    at = next;
  }
  for (std::size_t robot = 0; robot < at.size(); ++robot) {
    scene.instance.agents[robot].goal = map.cell(at[robot]);
  }
  return scene;
}

Scene any_discrete_scene() {
  const Scene scene = make_discrete_scene(*rc::gen::arbitrary<std::uint64_t>());
  note_case({scene.instance, {}});
  RC_PRE(!find_error(scene.instance));
  return scene;
}

/// A unit move of a discrete scene, and when the robot came to both of its cells.
struct Step {
  AgentIndex robot = 0;
  TimedMotion motion;
  double came_to_from_s = 0;
  double duration_s = 1;
};

std::vector<Step> steps_of(const Scene& scene, const std::vector<AgentIndex>& robots) {
  std::vector<Step> steps;
  for (const AgentIndex robot : robots) {
    double came_s = -1;
    for (const TimedMotion& motion : scene.solution.trajectories[robot].motions) {
      if (motion.is_wait()) continue;
      steps.push_back({robot, motion, came_s, 1 / scene.instance.agents[robot].speed_cells_per_s});
      came_s = motion.end_s;
    }
  }
  return steps;
}

LinearMotion at_time(const Step& step, double begin_s) {
  const Vec2 path = centre(step.motion.to) - centre(step.motion.from);
  return {begin_s, begin_s + step.duration_s, centre(step.motion.from), path * (1 / step.duration_s)};
}

/// How much later than `first` the other one departs at least, if both are at one cell now and then:
/// bisection between when they are there at once and when they do not move at once.
double lag_by_bisection(const Step& first, const Step& second, bool leaves, bool enters, double reach) {
  double collides_s = (leaves ? 0 : first.duration_s) - (enters ? second.duration_s : 0);
  double free_s = first.duration_s;
  while (free_s - collides_s > 1e-12) {
    const double middle_s = collides_s + (free_s - collides_s) / 2;
    const auto approach = closest_approach(at_time(first, 0), at_time(second, middle_s));
    (approach && approach->distance_cells < reach - 1e-11 ? collides_s : free_s) = middle_s;
  }
  return free_s;
}

/// Departures of all steps of these robots, by rounds over all constraints of all pairs (Bellman 1958); none
/// if the rounds do not end.
std::optional<std::vector<double>> departures_by_rounds(const Scene& scene,
                                                        const std::vector<AgentIndex>& robots) {
  struct Constraint {
    std::size_t before;
    std::size_t after;
    double lag_s;
  };
  const std::vector<Step> steps = steps_of(scene, robots);
  std::vector<Constraint> constraints;
  for (std::size_t a = 0; a < steps.size(); ++a) {
    for (std::size_t b = 0; b < steps.size(); ++b) {
      const Step& first = steps[a];
      const Step& second = steps[b];
      if (first.robot == second.robot) {
        if (b == a + 1) constraints.push_back({a, b, first.duration_s});
        continue;
      }
      const double reach =
          scene.instance.agents[first.robot].radius_cells + scene.instance.agents[second.robot].radius_cells;
      for (const bool leaves : {true, false}) {
        for (const bool enters : {true, false}) {
          const Cell cell = leaves ? first.motion.from : first.motion.to;
          if (cell != (enters ? second.motion.to : second.motion.from)) continue;
          const double first_came_s = leaves ? first.came_to_from_s : first.motion.end_s;
          const double second_came_s = enters ? second.motion.end_s : second.came_to_from_s;
          if (first_came_s >= second_came_s) continue;  // the other way round
          constraints.push_back({a, b, lag_by_bisection(first, second, leaves, enters, reach)});
        }
      }
    }
  }
  std::vector<double> departures(steps.size(), 0);
  for (std::size_t round = 0; round <= steps.size() + 1; ++round) {
    bool changed = false;
    for (const Constraint& constraint : constraints) {
      const double ready_s = departures[constraint.before] + constraint.lag_s;
      if (ready_s <= departures[constraint.after] + 1e-9) continue;
      departures[constraint.after] = ready_s;
      changed = true;
    }
    if (!changed) return departures;
  }
  return std::nullopt;
}

std::vector<AgentIndex> all_robots(const Scene& scene) {
  std::vector<AgentIndex> robots(scene.instance.agents.size());
  std::iota(robots.begin(), robots.end(), AgentIndex{0});
  return robots;
}

/// Departures of unit steps, robot by robot, of motions that may be several steps long.
std::vector<double> unit_departures(const Solution& solution) {
  std::vector<double> departures;
  for (const Trajectory& trajectory : solution.trajectories) {
    for (const TimedMotion& motion : trajectory.motions) {
      const std::int32_t cells =
          std::abs(motion.to.x - motion.from.x) + std::abs(motion.to.y - motion.from.y);
      for (std::int32_t cell = 0; cell < cells; ++cell) {
        departures.push_back(motion.begin_s + (motion.end_s - motion.begin_s) * cell / cells);
      }
    }
  }
  return departures;
}

/// Merged straight moves, so that the way for all plans is taken, with the same lengths of moves.
bool is_collision(const Violation& violation) {
  return violation.kind == ViolationKind::kAgentCollision ||
         violation.kind == ViolationKind::kObstacleCollision || violation.kind == ViolationKind::kSpeed ||
         violation.kind == ViolationKind::kDiscontinuity || violation.kind == ViolationKind::kNotFinite;
}

std::size_t collisions(const Instance& instance, const Solution& solution) {
  const ValidationReport report = validate(instance, solution);
  return static_cast<std::size_t>(
      std::count_if(report.violations.begin(), report.violations.end(), is_collision));
}

/// Whether some move after a wait could begin `earlier_s` sooner, and then wait, as far as the validator
/// sees.
bool has_slack(const Instance& instance, const Solution& solution, double earlier_s) {
  for (AgentIndex robot = 0; robot < solution.trajectories.size(); ++robot) {
    const std::size_t motions = solution.trajectories[robot].motions.size();
    for (std::size_t i = 0; i + 1 < motions; ++i) {
      const TimedMotion wait = solution.trajectories[robot].motions[i];
      if (!wait.is_wait() || wait.end_s - wait.begin_s < 2 * earlier_s) continue;
      Solution sooner = solution;
      std::vector<TimedMotion>& changed = sooner.trajectories[robot].motions;
      changed[i].end_s -= earlier_s;
      const double end_s = changed[i + 1].end_s;
      changed[i + 1].begin_s -= earlier_s;
      changed[i + 1].end_s -= earlier_s;
      const Cell there = changed[i + 1].to;
      changed.insert(changed.begin() + static_cast<std::ptrdiff_t>(i) + 2,
                     {end_s - earlier_s, end_s, there, there});
      if (collisions(instance, sooner) == 0) return true;
    }
  }
  return false;
}

const PropertyRoom room("retiming", [] {
  bool passed = true;

  passed &= property("retime (1)(4): discrete plans get the times that rounds over all pairs give", [] {
    const Scene scene = any_discrete_scene();
    const auto expected = departures_by_rounds(scene, all_robots(scene));
    const auto result = retime(scene.instance, scene.solution);
    RC_ASSERT(result.has_value());
    RC_CLASSIFY(!expected, "no schedule");
    RC_CLASSIFY(collisions(scene.instance, scene.solution) > 0, "overlaps as given");
    RC_ASSERT(result->is_executable() == expected.has_value());
    if (!expected) return;
    const std::vector<double> departures = unit_departures(result->solution);
    RC_ASSERT(departures.size() == expected->size());
    for (std::size_t i = 0; i < departures.size(); ++i) {
      RC_ASSERT(std::abs(departures[i] - (*expected)[i]) <= kSameTimeS);
    }
    RC_ASSERT(collisions(scene.instance, result->solution) == 0U);
    RC_ASSERT(certify(scene.instance, result->solution).collisions == 0U);
  });

  passed &= property("retime (4): the robots of a ring have no schedule among themselves", [] {
    const Scene scene = any_discrete_scene();
    const auto result = retime(scene.instance, scene.solution);
    RC_ASSERT(result.has_value());
    RC_CLASSIFY(!result->is_executable(), "ring");
    if (result->is_executable()) return;
    std::vector<AgentIndex> ring;
    for (const RingMember& member : result->ring) ring.push_back(member.agent);
    RC_ASSERT(!ring_text(scene.instance, result->ring).empty());
    RC_ASSERT(!departures_by_rounds(scene, ring));
  });

  passed &= property("retime (2): of a valid plan it makes a valid one, and no robot arrives later", [] {
    const PlanCase plan_case = *any_case();
    note_case(plan_case);
    PlannerOptions options = plan_case.options;
    options.max_expansions = std::min<std::uint64_t>(options.max_expansions, 5'000);
    const PlanResult planned = plan(plan_case.instance, options);
    RC_CLASSIFY(planned.status == PlanStatus::kSolved, "solved");
    if (planned.status != PlanStatus::kSolved) return;
    const auto result = retime(plan_case.instance, planned.solution, options.rules);
    if (options.rules.inflates()) {
      RC_ASSERT(!result.has_value());
      return;
    }
    RC_ASSERT(result.has_value());
    RC_ASSERT(result->is_executable());
    RC_ASSERT(validate(plan_case.instance, result->solution, {0, {}, options.rules}).valid());
    for (AgentIndex i = 0; i < plan_case.instance.agents.size(); ++i) {
      RC_ASSERT(result->solution.trajectories[i].arrival_s() <=
                planned.solution.trajectories[i].arrival_s() + 1e-9);
    }
  });

  passed &= property("retime (2): plans with turns, delays and waits too", [] {
    const PlanCase plan_case = *any_turning_case();
    note_case(plan_case);
    PlannerOptions options = plan_case.options;
    options.max_expansions = std::min<std::uint64_t>(options.max_expansions, 5'000);
    options.rules.inflate_distance_cells = options.rules.inflate_time_s = 0;
    const PlanResult planned = plan(plan_case.instance, options);
    RC_CLASSIFY(planned.status == PlanStatus::kSolved, "solved");
    if (planned.status != PlanStatus::kSolved) return;
    const auto result = retime(plan_case.instance, planned.solution, options.rules);
    RC_ASSERT(result.has_value() && result->is_executable());
    RC_ASSERT(validate(plan_case.instance, result->solution, {0, {}, options.rules}).valid());
    RC_ASSERT(flowtime_s(result->solution) <= flowtime_s(planned.solution) + 1e-9);
  });

  passed &= property("retime (1)(3): of random walks, nothing collides and no move can begin sooner", [] {
    constexpr double kSoonerS = 1.0 / 128;
    Scene scene = *any_scene();
    RC_PRE(!find_error(scene.instance));
    note_case({scene.instance, {}});
    const bool is_valid = collisions(scene.instance, scene.solution) == 0;
    const auto result = retime(scene.instance, scene.solution);
    RC_PRE(result.has_value());  // motions that jump
    RC_CLASSIFY(result->is_executable(), "schedule");
    RC_CLASSIFY(is_valid, "valid as given");
    RC_CLASSIFY(result->is_executable() && !is_valid, "made valid");
    RC_ASSERT(result->is_executable() || !is_valid);
    if (!result->is_executable()) return;
    RC_ASSERT(collisions(scene.instance, result->solution) == 0U);
    RC_ASSERT(!has_slack(scene.instance, result->solution, kSoonerS));
    if (!is_valid) return;
    RC_ASSERT(flowtime_s(result->solution) <= flowtime_s(scene.solution) + 1e-9);
  });

  passed &= property("retime: what it made it leaves as it is", [] {
    const Scene scene = any_discrete_scene();
    const auto once = retime(scene.instance, scene.solution);
    RC_ASSERT(once.has_value());
    if (!once->is_executable()) return;
    const auto twice = retime(scene.instance, once->solution);
    RC_ASSERT(twice.has_value() && twice->is_executable());
    RC_ASSERT(std::abs(flowtime_s(twice->solution) - flowtime_s(once->solution)) <= kSameTimeS);
  });

  return passed;
});

}  // namespace
}  // namespace sipplab::retiming_laws
