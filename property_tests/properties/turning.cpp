// Robots with headings, delays and inflated distances: every plan keeps the rules, the
// validator says so from every side, and what is planted against the rules is found.
#include <rapidcheck.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <functional>
#include <optional>
#include <queue>
#include <utility>
#include <vector>

#include "planner/core/tolerances.hpp"
#include "planner/grid/heading.hpp"
#include "planner/search/sipp_search.hpp"
#include "planner/solve/plan.hpp"
#include "property_tests/support/encounters.hpp"
#include "property_tests/support/exact_line_of_sight.hpp"
#include "property_tests/support/exhaustive_search.hpp"
#include "property_tests/support/generators.hpp"
#include "property_tests/support/property.hpp"
#include "property_tests/support/steps_between.hpp"
#include "property_tests/support/symmetry.hpp"
#include "sipplab/prioritized_planner.hpp"
#include "sipplab/validator.hpp"

namespace sipplab::turning_laws {
namespace {

/// Seconds. Rounding of sums of square roots and angles.
constexpr double kRoundingS = 1e-9;

struct Planned {
  PlanCase plan_case;
  PlanResult result;

  Scene scene() const { return {plan_case.instance, result.solution}; }
  ValidationOptions guarantees() const {
    return {plan_case.options.ssi_s, result.order(), plan_case.options.rules};
  }
};

Planned any_planned() {
  Planned planned{*any_turning_case(), {}};
  note_case(planned.plan_case);
  classify_case(planned.plan_case);
  planned.result = plan(planned.plan_case.instance, planned.plan_case.options);
  RC_CLASSIFY(planned.result.status == PlanStatus::kSolved, "solved");
  return planned;
}

Planned any_solved() {
  Planned planned = any_planned();
  RC_PRE(planned.result.status == PlanStatus::kSolved);
  return planned;
}

/// A case of one robot that fits between two blocked cells, and nothing that moves.
PlanCase one_turning_robot() {
  PlanCase plan_case = *any_turning_case();
  RC_PRE(!plan_case.instance.agents.empty());
  plan_case.instance.agents.resize(1);
  RC_PRE(plan_case.instance.agents[0].radius_cells <= kDefaultRadiusCells);
  plan_case.instance.obstacles.clear();
  note_case(plan_case);
  return plan_case;
}

bool same(const PlanResult& a, const PlanResult& b) {
  return a.status == b.status && a.solution == b.solution && a.tries() == b.tries() &&
         a.statistics.expansions == b.statistics.expansions &&
         a.statistics.generations == b.statistics.generations;
}

/// A robot that moves and turns or waits right before it.
struct Stop {
  AgentIndex agent;
  std::size_t motion;  ///< the turn
};

std::optional<Stop> any_turn(const Solution& solution) {
  std::vector<Stop> stops;
  for (AgentIndex i = 0; i < solution.trajectories.size(); ++i) {
    const auto& motions = solution.trajectories[i].motions;
    for (std::size_t k = 0; k < motions.size(); ++k) {
      if (motions[k].is_turn()) stops.push_back({i, k});
    }
  }
  if (stops.empty()) return std::nullopt;
  return *rc::gen::elementOf(stops);
}

/// Everything of the trajectory from motion `first` on happens `seconds` earlier.
void hasten(Trajectory& trajectory, std::size_t first, double seconds) {
  for (std::size_t i = first; i < trajectory.motions.size(); ++i) {
    trajectory.motions[i].begin_s -= seconds;
    trajectory.motions[i].end_s -= seconds;
  }
}

/// Degrees, counter-clockwise as seen, of a way of the grid.
double direction_deg(Cell path) {
  const double degrees = std::atan2(-path.y, path.x) * (180 / std::acos(-1.0));
  return degrees < 0 ? degrees + 360 : degrees;
}

/// A robot with a heading, alone among walls.
struct Alone {
  PlanCase plan_case;
  Fraction radius;

  const Agent& agent() const { return plan_case.instance.agents[0]; }
};

Alone make_alone() {
  constexpr std::int32_t kWidth = 5;
  constexpr std::int32_t kHeight = 4;
  Alone alone;
  Instance& instance = alone.plan_case.instance;
  PlannerOptions& options = alone.plan_case.options;
  instance.map = GridMap(kWidth, kHeight);
  Agent agent;
  agent.start = *any_cell(kWidth, kHeight);
  agent.goal = *any_cell(kWidth, kHeight);
  alone.radius = *any_of<Fraction>({{1, 2}, {1, 4}, {3, 10}});
  agent.radius_cells = alone.radius.value();
  agent.speed_cells_per_s = *any_of({1.0, 0.5, 2.0});
  agent.rotation_speed = *any_of({1.0, 0.125, 0.5, 3.0});
  agent.start_heading_deg = *any_of({0.0, 90.0, 45.0, 200.0, 315.0});
  if (*rc::gen::arbitrary<bool>()) agent.goal_heading_deg = *any_of({0.0, 180.0, 270.0, 100.0});
  instance.agents.push_back(agent);
  for (int walls = *rc::gen::inRange(0, 7); walls > 0; --walls) {
    const Cell cell = *any_cell(kWidth, kHeight);
    if (cell != agent.start && cell != agent.goal) instance.map.set_blocked(cell, true);
  }
  options.rules.turns = true;
  options.rules.wait_before_move_s = *any_of({0.0, 0.0, 0.5});
  options.any_angle = false;
  options.connectedness = *any_of({2, 3, 4, 5});
  return alone;
}

/// When it can be at its goal, its last turn done: Dijkstra's algorithm over cells and headings.
std::optional<double> earliest_alone_s(const Alone& alone) {
  const GridMap& map = alone.plan_case.instance.map;
  const Agent& agent = alone.agent();
  const std::vector<Cell> steps = mediant_neighbourhood(alone.plan_case.options.connectedness);
  std::vector<double> headings_deg;
  for (const Cell step : steps) headings_deg.push_back(direction_deg(step));
  headings_deg.push_back(agent.start_heading_deg);
  const auto turn_s = [&](double from_deg, double to_deg) {
    return std::abs(std::remainder(from_deg - to_deg, 360)) / (180 * agent.rotation_speed);
  };
  const auto state = [&](Cell cell, std::size_t heading) {
    return map.index(cell) * headings_deg.size() + heading;
  };
  std::vector<double> arrivals_s(map.cell_count() * headings_deg.size(), kForever);
  using Arrival = std::pair<double, std::size_t>;
  std::priority_queue<Arrival, std::vector<Arrival>, std::greater<>> open;
  arrivals_s[state(agent.start, steps.size())] = 0;
  open.emplace(0, state(agent.start, steps.size()));
  double least_s = kForever;
  while (!open.empty()) {
    const auto [now_s, id] = open.top();
    open.pop();
    if (now_s > arrivals_s[id]) continue;
    const Cell here = map.cell(id / headings_deg.size());
    const double facing_deg = headings_deg[id % headings_deg.size()];
    if (here == agent.goal) {
      least_s = std::min(least_s, now_s + turn_s(facing_deg, agent.goal_heading_deg.value_or(facing_deg)));
    }
    for (std::size_t i = 0; i < steps.size(); ++i) {
      const Cell there{here.x + steps[i].x, here.y + steps[i].y};
      if (!exactly_legal(map, alone.radius, there) || !exactly_clear(map, alone.radius, here, there))
        continue;
      const double then_s = now_s + turn_s(facing_deg, headings_deg[i]) +
                            alone.plan_case.options.rules.wait_before_move_s +
                            distance(here, there) / agent.speed_cells_per_s;
      if (then_s >= arrivals_s[state(there, i)]) continue;
      arrivals_s[state(there, i)] = then_s;
      open.emplace(then_s, state(there, i));
    }
  }
  if (least_s == kForever) return std::nullopt;
  return least_s;
}

bool finds(const ValidationReport& report, AgentIndex agent, ViolationKind kind) {
  return std::any_of(report.violations.begin(), report.violations.end(), [&](const Violation& violation) {
    return violation.agent == agent && violation.kind == kind;
  });
}

const PropertyRoom room("turning", [] {
  bool passed = true;

  passed &= property("every plan of robots with headings, delays and inflation is valid", [] {
    const Planned planned = any_planned();
    RC_PRE(planned.result.status == PlanStatus::kSolved);
    const ValidationReport report =
        validate(planned.plan_case.instance, planned.result.solution, planned.guarantees());
    for (const Violation& violation : report.violations) RC_LOG() << violation.message << '\n';
    RC_ASSERT(report.valid());
    RC_CLASSIFY(has_turns(planned.result.solution), "turns on the path");
  });

  passed &= property("turns are stated, each as long as its angle takes", [] {
    const Planned planned = any_solved();
    for (AgentIndex i = 0; i < planned.plan_case.instance.agents.size(); ++i) {
      const Agent& agent = planned.plan_case.instance.agents[i];
      double facing_deg = agent.start_heading_deg;
      for (const TimedMotion& motion : planned.result.solution.trajectories[i].motions) {
        if (!motion.is_wait()) {
          RC_ASSERT(facing_deg == heading_deg(motion.from, motion.to));
        } else if (motion.is_turn()) {
          const double due_s = turn_deg(facing_deg, *motion.turn_to_deg) / (180 * agent.rotation_speed);
          RC_ASSERT(std::abs(motion.end_s - motion.begin_s - due_s) <=
                    kRoundingS * std::max(1.0, motion.end_s));
          facing_deg = *motion.turn_to_deg;
        }
      }
      RC_ASSERT(facing_deg == agent.goal_heading_deg.value_or(facing_deg));
    }
  });

  passed &= property("the same case gives the same plan, and the final order alone explains it", [] {
    const Planned planned = any_planned();
    const PlanCase& plan_case = planned.plan_case;
    RC_ASSERT(same(planned.result, plan(plan_case.instance, plan_case.options)));
    RC_PRE(planned.result.status == PlanStatus::kSolved);
    const PriorityOrder& order = planned.result.order();
    PlanCase sorted = plan_case;
    for (std::size_t i = 0; i < order.size(); ++i)
      sorted.instance.agents[i] = plan_case.instance.agents[order[i]];
    sorted.options.order = InitialOrder::kFifo;
    sorted.options.rescheduling = Rescheduling::kNone;
    const PlanResult replayed = plan(sorted.instance, sorted.options);
    RC_ASSERT(replayed.status == PlanStatus::kSolved);
    for (std::size_t i = 0; i < order.size(); ++i) {
      RC_ASSERT(replayed.solution.trajectories[i] == planned.result.solution.trajectories[order[i]]);
    }
  });

  passed &= property("the verdict stays after a quarter turn, in a mirror, and at half the speed", [] {
    const Planned planned = any_solved();
    ValidationOptions guarantees = planned.guarantees();
    const auto is_valid = [&](const Scene& scene) {
      return validate(scene.instance, scene.solution, guarantees).valid();
    };
    RC_ASSERT(is_valid(rotated(planned.scene())));
    RC_ASSERT(is_valid(reflected(planned.scene())));
    guarantees.ssi_s *= 2;
    guarantees.rules.wait_before_move_s *= 2;
    guarantees.rules.inflate_time_s *= 2;
    RC_ASSERT(is_valid(slowed(planned.scene(), 2)));
  });

  passed &= property("one robot alone: solved exactly when breadth-first search reaches the goal", [] {
    const PlanCase plan_case = one_turning_robot();
    const Agent& agent = plan_case.instance.agents[0];
    const PlanResult result = plan(plan_case.instance, plan_case.options);
    RC_PRE(result.status != PlanStatus::kLimit);
    const auto steps = steps_between(plan_case.instance.map, agent.start, agent.goal);
    RC_ASSERT((result.status == PlanStatus::kSolved) == steps.has_value());
    if (!steps) return;
    const double arrival_s = result.solution.trajectories[0].arrival_s();
    const double half_turn_s = 1 / agent.rotation_speed;
    const double delay_s = plan_case.options.rules.wait_before_move_s;
    RC_ASSERT(arrival_s >= distance(agent.start, agent.goal) / agent.speed_cells_per_s - kRoundingS);
    // A quarter turn before each step at most, half a turn at both ends.
    const double stepwise_s =
        *steps * (1 / agent.speed_cells_per_s + half_turn_s + delay_s) + 2 * half_turn_s;
    RC_ASSERT(arrival_s <= plan_case.options.weight * stepwise_s + kRoundingS);
  });

  passed &=
      property("one robot alone, stepwise: as early as Dijkstra's algorithm over cells and headings", [] {
        Alone alone = at_full_size(make_alone);
        note_case(alone.plan_case);
        const std::optional<double> earliest_s = earliest_alone_s(alone);
        const auto arrival_s = [&] {
          const PlanResult result = plan(alone.plan_case.instance, alone.plan_case.options);
          RC_ASSERT((result.status == PlanStatus::kSolved) == earliest_s.has_value());
          return earliest_s ? makespan_s(result.solution) : 0;
        };
        RC_CLASSIFY(!earliest_s, "no way");
        RC_ASSERT(std::abs(arrival_s() - earliest_s.value_or(0)) <= kRoundingS);
        alone.plan_case.options.weight = *any_of({1.25, 2.0, 5.0});
        RC_ASSERT(arrival_s() <= alone.plan_case.options.weight * earliest_s.value_or(0) + kRoundingS);
        // At any angle each step is offered, too.
        alone.plan_case.options.weight = 1;
        alone.plan_case.options.any_angle = true;
        if (earliest_s) RC_ASSERT(arrival_s() <= *earliest_s + kRoundingS);
      });

  passed &= property("one robot alone, stepwise: who turns twice as fast arrives no later", [] {
    PlanCase plan_case = one_turning_robot();
    plan_case.options.any_angle = false;
    plan_case.options.weight = 1;
    const PlanResult slow = plan(plan_case.instance, plan_case.options);
    RC_PRE(slow.status == PlanStatus::kSolved);
    plan_case.instance.agents[0].rotation_speed *= 2;
    const PlanResult fast = plan(plan_case.instance, plan_case.options);
    RC_ASSERT(fast.status == PlanStatus::kSolved);
    RC_ASSERT(makespan_s(fast.solution) <= makespan_s(slow.solution) + kRoundingS);
  });

  passed &= property("without rules, stepwise, the two searches arrive at the same times", [] {
    PlanCase plan_case = *any_case();
    plan_case.options.any_angle = false;
    plan_case.options.weight = 1;
    plan_case.options.rescheduling = Rescheduling::kNone;
    plan_case.instance.agents.resize(std::min<std::size_t>(plan_case.instance.agents.size(), 1));
    note_case(plan_case);
    TurningSearch turning(plan_case.instance, {false, plan_case.options.connectedness});
    const PlanResult one = plan(plan_case.instance, plan_case.options);
    const PlanResult other = plan_prioritized(plan_case.instance, plan_case.options, turning);
    RC_PRE(one.status != PlanStatus::kLimit && other.status != PlanStatus::kLimit);
    RC_ASSERT(one.status == other.status);
    RC_ASSERT(std::abs(makespan_s(one.solution) - makespan_s(other.solution)) <= kRoundingS);
  });

  passed &= property(
      "stepwise, with the map's distances in the heuristic and without it robots arrive together", [] {
        PlanCase plan_case = *any_case();
        plan_case.options.any_angle = false;
        plan_case.options.rescheduling = Rescheduling::kNone;
        plan_case.instance.agents.resize(std::min<std::size_t>(plan_case.instance.agents.size(), 1));
        note_case(plan_case);
        SippOptions options{false, plan_case.options.connectedness, 1, plan_case.options.rules};
        TurningSearch with(plan_case.instance, options);
        options.static_distances = false;
        TurningSearch without(plan_case.instance, options);
        const PlanResult one = plan_prioritized(plan_case.instance, plan_case.options, with);
        const PlanResult other = plan_prioritized(plan_case.instance, plan_case.options, without);
        RC_PRE(one.status != PlanStatus::kLimit && other.status != PlanStatus::kLimit);
        RC_ASSERT(one.status == other.status);
        RC_ASSERT(std::abs(makespan_s(one.solution) - makespan_s(other.solution)) <= kRoundingS);
        RC_CLASSIFY(one.statistics.expansions < other.statistics.expansions, "with fewer expansions");
      });

  passed &= property("inflated times: no plan for a robot whose start is unsafe at once", [] {
    PlanCase plan_case;
    Instance& instance = plan_case.instance;
    constexpr std::int32_t kSide = 7;
    instance.map = GridMap(kSide, kSide);
    Agent& agent = instance.agents.emplace_back();
    agent.start = *any_cell(kSide, kSide);
    agent.goal = *any_cell(kSide, kSide);
    agent.radius_cells = *any_of({0.5, 0.25});
    plan_case.options.rules.turns = *rc::gen::arbitrary<bool>();
    plan_case.options.rules.inflate_time_s = *any_of({0.5, 1.0, 2.5});
    DynamicObstacle& obstacle = instance.obstacles.emplace_back();
    obstacle.trajectory.start = *any_cell(kSide, kSide);
    const Cell to = *any_cell(kSide, kSide);
    RC_PRE(to != obstacle.trajectory.start);
    const double begin_s = *any_eighths(2);
    const Cell from = obstacle.trajectory.start;
    if (begin_s > 0) obstacle.trajectory.motions.push_back({0, begin_s, from, from});
    obstacle.trajectory.motions.push_back(
        {begin_s, begin_s + distance(from, to) / *any_of({1.0, 2.0}), from, to});
    RC_PRE(!find_error(instance));
    note_case(plan_case);
    // How near the obstacle comes to the start within the inflated time.
    const double reach = agent.radius_cells + obstacle.radius_cells;
    double nearest = kForever;
    constexpr int kMoments = 400;
    const TimedMotion& motion = obstacle.trajectory.motions.back();
    for (int i = 0; i <= kMoments; ++i) {
      const double time_s = plan_case.options.rules.inflate_time_s * i / kMoments;
      const double share = std::clamp((time_s - motion.begin_s) / (motion.end_s - motion.begin_s), 0.0, 1.0);
      const Vec2 place = centre(from) + (centre(to) - centre(from)) * share;
      nearest = std::min(nearest, norm(place - centre(agent.start)));
    }
    constexpr double kGrazeCells = 0.05;  // between two moments it comes no nearer by more
    const bool is_unsafe = nearest < reach - kGrazeCells;
    RC_CLASSIFY(is_unsafe, "unsafe");
    if (is_unsafe) RC_ASSERT(plan(instance, plan_case.options).status == PlanStatus::kFailed);
  });

  passed &= property("the validator finds a turn that is too short, left out, or the wrong way", [] {
    const Planned planned = any_solved();
    const std::optional<Stop> stop = any_turn(planned.result.solution);
    RC_PRE(stop.has_value());
    Scene scene = planned.scene();
    Trajectory& trajectory = scene.solution.trajectories[stop->agent];
    TimedMotion& turn = trajectory.motions[stop->motion];
    const double duration_s = turn.end_s - turn.begin_s;
    RC_PRE(duration_s > 1e-3);
    ViolationKind expected = ViolationKind::kStandingTime;
    switch (*rc::gen::inRange(0, 3)) {
      case 0:
        turn.end_s -= duration_s / 4;
        hasten(trajectory, stop->motion + 1, duration_s / 4);
        break;
      case 1:
        // Where nothing else fills the time.
        RC_PRE(planned.plan_case.options.rules.wait_before_move_s == 0);
        hasten(trajectory, stop->motion + 1, duration_s);
        trajectory.motions.erase(trajectory.motions.begin() + static_cast<std::ptrdiff_t>(stop->motion));
        if (stop->motion < trajectory.motions.size()) RC_PRE(!trajectory.motions[stop->motion].is_wait());
        break;
      default:
        turn.turn_to_deg = std::fmod(*turn.turn_to_deg + 7.5, 360);
        expected = ViolationKind::kHeading;
        break;
    }
    RC_ASSERT(finds(validate(scene.instance, scene.solution, planned.guarantees()), stop->agent, expected));
  });

  passed &= property("the validator finds a delay that is too short, also after a turn in parts", [] {
    PlanCase plan_case = *any_turning_case();
    plan_case.options.rules.wait_before_move_s = 0.5;
    note_case(plan_case);
    const PlanResult result = plan(plan_case.instance, plan_case.options);
    RC_PRE(result.status == PlanStatus::kSolved);
    ValidationOptions guarantees{plan_case.options.ssi_s, result.order(), plan_case.options.rules};
    Solution solution = result.solution;
    std::vector<Stop> stops;
    for (AgentIndex i = 0; i < solution.trajectories.size(); ++i) {
      const auto& motions = solution.trajectories[i].motions;
      for (std::size_t k = 0; k + 1 < motions.size(); ++k) {
        if (motions[k].is_wait() && !motions[k].is_turn() && !motions[k + 1].is_wait())
          stops.push_back({i, k});
      }
    }
    RC_PRE(!stops.empty());
    const Stop stop = *rc::gen::elementOf(stops);
    Trajectory& trajectory = solution.trajectories[stop.agent];
    // Half of the delay is left.
    TimedMotion& wait = trajectory.motions[stop.motion];
    const double early_s = wait.end_s - wait.begin_s - guarantees.rules.wait_before_move_s / 2;
    wait.end_s -= early_s;
    hasten(trajectory, stop.motion + 1, early_s);
    if (*rc::gen::arbitrary<bool>()) {
      // A little aside and back before: as long as both take.
      const double facing_deg = heading_deg(wait.from, trajectory.motions[stop.motion + 1].to);
      constexpr double kAsideDeg = 90;
      const double turn_s = kAsideDeg / (180 * plan_case.instance.agents[stop.agent].rotation_speed);
      const double begin_s = wait.begin_s;
      const Cell here = wait.from;
      hasten(trajectory, stop.motion, -2 * turn_s);
      trajectory.motions.insert(
          trajectory.motions.begin() + static_cast<std::ptrdiff_t>(stop.motion),
          {{begin_s, begin_s + turn_s, here, here, std::fmod(facing_deg + kAsideDeg, 360)},
           {begin_s + turn_s, begin_s + 2 * turn_s, here, here, facing_deg}});
    }
    RC_ASSERT(
        finds(validate(plan_case.instance, solution, guarantees), stop.agent, ViolationKind::kStandingTime));
  });

  return passed;
});

}  // namespace
}  // namespace sipplab::turning_laws
