// Cases changed at random; see case_mutator.hpp.
#include "property_tests/support/case_mutator.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>
#include <utility>

#include "property_tests/support/case_maker.hpp"

namespace sipplab {
namespace {

/// Changes that break a rule are taken back; this many are tried for one that does not.
constexpr int kAttempts = 8;
/// One mutation in this many begins with a new case.
constexpr std::uint64_t kFreshOneIn = 64;
/// One in this many gets another seed: random orders, and what a target decides by it.
constexpr std::uint64_t kReseededOneIn = 4;
/// One in this many may have fewer than two robots.
constexpr std::uint64_t kLonelyOneIn = 16;
/// Size of fresh cases, of 100: maps of about five cells a side.
constexpr int kFreshSize = 25;

template <class Item>
Item& pick(Random& random, std::vector<Item>& items) {
  return items[static_cast<std::size_t>(random.below(items.size()))];
}

/// A cell next to this one, or the same if that would leave the map.
Cell step_from(Random& random, const GridMap& map, Cell cell) {
  const Cell next{cell.x + static_cast<std::int32_t>(random.below(3)) - 1,
                  cell.y + static_cast<std::int32_t>(random.below(3)) - 1};
  return map.contains(next) ? next : cell;
}

Cell near_or_far(Random& random, const GridMap& map, Cell cell) {
  return random.one_in(2) ? draw_cell(random, map) : step_from(random, map, cell);
}

void number(Instance& instance) {
  for (std::size_t i = 0; i < instance.agents.size(); ++i) instance.agents[i].id = std::to_string(i);
  for (std::size_t i = 0; i < instance.obstacles.size(); ++i) instance.obstacles[i].id = std::to_string(i);
}

// --- robots --------------------------------------------------------------------------

void add_robot(Random& random, Instance& instance) {
  if (instance.agents.size() >= kMutatedRobots) return;
  Agent agent;
  // Next to another one, or anywhere.
  const bool beside = !instance.agents.empty() && random.one_in(2);
  if (beside) agent = pick(random, instance.agents);
  agent.start = beside ? step_from(random, instance.map, agent.start) : draw_cell(random, instance.map);
  agent.goal = beside && random.one_in(2) ? step_from(random, instance.map, agent.goal)
                                          : draw_cell(random, instance.map);
  instance.agents.push_back(agent);
}

void change_robot(Random& random, Instance& instance) {
  auto& agents = instance.agents;
  if (agents.empty()) return add_robot(random, instance);
  Agent& agent = pick(random, agents);
  switch (random.below(10)) {
    case 0:
      agent.start = near_or_far(random, instance.map, agent.start);
      break;
    case 1:
      agent.goal = near_or_far(random, instance.map, agent.goal);
      break;
    case 2:
      std::swap(agent.start, agent.goal);
      break;
    case 3:
      std::swap(agent.goal, pick(random, agents).goal);
      break;
    case 4:
      agent.goal = pick(random, agents).start;  // onto a start that may be protected
      break;
    case 5:
      agent.radius_cells = random.one_in(2) ? kDefaultRadiusCells : draw_radius(random);
      break;
    case 6:
      agent.speed_cells_per_s = random.one_in(2) ? kDefaultSpeedCellsPerS : draw_speed(random);
      break;
    case 7:
      agent.start_heading_deg = draw_heading(random);
      agent.goal_heading_deg = draw_goal_heading(random);
      break;
    case 8:
      agent.rotation_speed = draw_rotation_speed(random);
      break;
    default:
      std::swap(agent, pick(random, agents));  // another priority
      break;
  }
}

void remove_robot(Random& random, Instance& instance) {
  // Two stay: that is where the planner has something to decide.
  if (instance.agents.size() < 3) return change_robot(random, instance);
  std::swap(pick(random, instance.agents), instance.agents.back());
  instance.agents.pop_back();
}

/// Two robots or more, if there is room.
void fill_up(Random& random, Instance& instance) {
  for (int attempt = 0; attempt < kAttempts && instance.agents.size() < 2; ++attempt) {
    add_robot(random, instance);
    number(instance);
    if (find_error(instance)) instance.agents.pop_back();
  }
}

// --- map and obstacles ---------------------------------------------------------------

void resize_map(Random& random, Instance& instance) {
  const GridMap& old_map = instance.map;
  const auto side = [&](std::int32_t old_side) {
    const std::int32_t change = static_cast<std::int32_t>(random.below(3)) - 1;
    return std::clamp(old_side + change, 1, kMutatedSide);
  };
  GridMap map(side(old_map.width()), side(old_map.height()));
  for (std::size_t i = 0; i < map.cell_count(); ++i) {
    const Cell cell = map.cell(i);
    if (old_map.contains(cell)) map.set_blocked(cell, old_map.is_blocked(cell));
  }
  instance.map = std::move(map);
}

void change_map(Random& random, Instance& instance) {
  if (random.one_in(3)) return resize_map(random, instance);
  const Cell cell = draw_cell(random, instance.map);
  instance.map.set_blocked(cell, !instance.map.is_blocked(cell));
}

void change_obstacle(Random& random, Instance& instance) {
  auto& obstacles = instance.obstacles;
  if (obstacles.empty() || (obstacles.size() < kMutatedObstacles && random.one_in(4))) {
    DynamicObstacle& added = obstacles.emplace_back();
    added.radius_cells = random.one_in(2) ? kDefaultRadiusCells : draw_radius(random);
    added.trajectory.start = draw_cell(random, instance.map);
  }
  DynamicObstacle& obstacle = pick(random, obstacles);
  Trajectory& trajectory = obstacle.trajectory;
  switch (random.below(5)) {
    case 0:
      std::swap(obstacle, obstacles.back());
      obstacles.pop_back();
      break;
    case 1:
      if (!trajectory.motions.empty()) trajectory.motions.pop_back();
      break;
    case 2:
      obstacle.radius_cells = draw_radius(random);
      break;
    default: {
      if (trajectory.motions.size() >= kMutatedMotions) break;
      const double begin_s = trajectory.end_s();
      const Cell to =
          random.one_in(4) ? trajectory.end() : near_or_far(random, instance.map, trajectory.end());
      trajectory.motions.push_back(
          {begin_s, begin_s + 0.125 + draw_eighths(random, 4), trajectory.end(), to});
    }
  }
}

// --- options -------------------------------------------------------------------------

void change_options(Random& random, PlannerOptions& options) {
  constexpr InitialOrder kOrders[] = {InitialOrder::kFifo, InitialOrder::kShortestFirst,
                                      InitialOrder::kLongestFirst, InitialOrder::kRandom};
  constexpr Rescheduling kReschedulings[] = {Rescheduling::kNone, Rescheduling::kDeterministic,
                                             Rescheduling::kRandom};
  switch (random.below(9)) {
    case 0:
      options.ssi_s = random.one_in(4) ? kInfiniteSsi : random.one_in(4) ? 0 : draw_eighths(random, 8);
      break;
    case 1:
      options.order = kOrders[random.below(std::size(kOrders))];
      break;
    case 2:
      options.rescheduling = kReschedulings[random.below(std::size(kReschedulings))];
      break;
    case 3:
      options.any_angle = !options.any_angle;
      break;
    case 4:
      options.connectedness = 2 + static_cast<int>(random.below(4));
      break;
    case 5:
      options.rules.turns = !options.rules.turns;
      break;
    case 6:
      options.rules.wait_before_move_s = random.one_in(2) ? 0 : draw_eighths(random, 1);
      if (options.rescheduling == Rescheduling::kEjection) break;  // knows nothing of inflation
      options.rules.inflate_distance_cells = random.one_in(2) ? 0 : draw_eighths(random, 1);
      options.rules.inflate_time_s = random.one_in(2) ? 0 : draw_eighths(random, 1);
      break;
    case 7:
      options.weight = random.one_in(2) ? 1 : 1 + draw_eighths(random, 2);
      break;
    default:
      options.seed = random.below(1000);
      break;
  }
}

void change_once(Random& random, PlanCase& plan_case) {
  Instance& instance = plan_case.instance;
  switch (random.below(12)) {
    case 0:
    case 1:
      return add_robot(random, instance);
    case 2:
      return remove_robot(random, instance);
    case 3:
    case 4:
    case 5:
    case 6:
      return change_robot(random, instance);
    case 7:
    case 8:
      return change_map(random, instance);
    case 9:
      return change_obstacle(random, instance);
    default:
      return change_options(random, plan_case.options);
  }
}

void bound(PlannerOptions& options) {
  options.time_limit_s = std::numeric_limits<double>::infinity();
  options.max_expansions = std::min(options.max_expansions, kMutatedExpansions);
  options.max_restarts = std::min(options.max_restarts, kMutatedRestarts);
}

PlanCase fresh_case(Random& random) {
  PlanCase plan_case;
  do {
    const auto family = static_cast<CaseFamily>(random.below(kCaseFamilies));
    plan_case = make_case(family, static_cast<int>(random.below(kFreshSize)), random.next());
  } while (!is_small_case(plan_case));
  if (!random.one_in(kLonelyOneIn)) fill_up(random, plan_case.instance);
  bound(plan_case.options);
  return plan_case;
}

}  // namespace

bool is_small_case(const PlanCase& plan_case) {
  const Instance& instance = plan_case.instance;
  return instance.map.width() <= kMutatedSide && instance.map.height() <= kMutatedSide &&
         instance.agents.size() <= kMutatedRobots && instance.obstacles.size() <= kMutatedObstacles &&
         std::all_of(instance.obstacles.begin(), instance.obstacles.end(),
                     [](const DynamicObstacle& obstacle) {
                       return obstacle.trajectory.motions.size() <= kMutatedMotions;
                     });
}

PlanCase mutate_case(const PlanCase& plan_case, Random& random) {
  if (random.one_in(kFreshOneIn) || !is_small_case(plan_case) || find_error(plan_case.instance)) {
    return fresh_case(random);
  }
  PlanCase mutated = plan_case;
  for (std::uint64_t changes = 1 + random.below(4); changes > 0; --changes) {
    for (int attempt = 0; attempt < kAttempts; ++attempt) {
      PlanCase changed = mutated;
      change_once(random, changed);
      number(changed.instance);
      if (find_error(changed.instance)) continue;
      mutated = std::move(changed);
      break;
    }
  }
  if (!random.one_in(kLonelyOneIn)) fill_up(random, mutated.instance);
  if (random.one_in(kReseededOneIn)) mutated.options.seed = random.below(1000);
  bound(mutated.options);
  return mutated;
}

PlanCase cross_cases(const PlanCase& one, const PlanCase& other, Random& random) {
  if (!is_small_case(one) || find_error(one.instance)) return mutate_case(other, random);
  PlanCase crossed = one;
  crossed.instance.agents.clear();
  // Robots of one as they are, as far as the coin says; then those of the other that fit.
  for (const PlanCase* parent : {&one, &other}) {
    for (const Agent& agent : parent->instance.agents) {
      if (crossed.instance.agents.size() >= kMutatedRobots || random.one_in(2)) continue;
      crossed.instance.agents.push_back(agent);
      if (find_error(crossed.instance)) crossed.instance.agents.pop_back();
    }
  }
  if (random.one_in(2)) {
    crossed.instance.obstacles = other.instance.obstacles;
    if (find_error(crossed.instance) || !is_small_case(crossed)) {
      crossed.instance.obstacles = one.instance.obstacles;
    }
  }
  if (random.one_in(2)) crossed.options = other.options;
  number(crossed.instance);
  if (!random.one_in(kLonelyOneIn)) fill_up(random, crossed.instance);
  bound(crossed.options);
  return crossed;
}

}  // namespace sipplab
