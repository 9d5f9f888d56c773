// Cases from families; see case_maker.hpp.
#include "property_tests/support/case_maker.hpp"

#include <array>
#include <limits>
#include <utility>

namespace sipplab {
namespace {

/// Expansions and restarts of a case: small maps are exhausted within these, and a
/// hopeless case ends in milliseconds.
constexpr std::uint64_t kCaseExpansions = 20000;
constexpr std::uint64_t kCaseRestarts = 40;
/// Attempts to find a place for one robot before going on without it.
constexpr int kPlacingAttempts = 20;

template <std::size_t N>
double pick(Random& random, const std::array<double, N>& values) {
  return values[static_cast<std::size_t>(random.below(N))];
}

std::int32_t draw_between(Random& random, std::int32_t least, std::int32_t most) {
  return least + static_cast<std::int32_t>(random.below(static_cast<std::uint64_t>(most - least + 1)));
}

/// Adds the agent unless that breaks a rule.
bool try_add(Instance& instance, Agent agent) {
  agent.id = std::to_string(instance.agents.size());
  instance.agents.push_back(std::move(agent));
  if (!find_error(instance)) return true;
  instance.agents.pop_back();
  return false;
}

void add_anywhere(Random& random, Instance& instance, const Agent& body) {
  for (int attempt = 0; attempt < kPlacingAttempts; ++attempt) {
    Agent agent = body;
    agent.start = draw_cell(random, instance.map);
    agent.goal = draw_cell(random, instance.map);
    if (try_add(instance, agent)) return;
  }
}

void block_some(Random& random, GridMap& map, std::uint64_t one_cell_in) {
  for (std::size_t i = 0; i < map.cell_count(); ++i) {
    if (random.one_in(one_cell_in)) map.set_blocked(map.cell(i), true);
  }
}

Instance scattered(Random& random, int size) {
  Instance instance;
  const std::int32_t most = 3 + size / 12;
  instance.map = GridMap(draw_between(random, 2, most), draw_between(random, 2, most));
  block_some(random, instance.map, 4 + random.below(12));
  const std::int32_t robots = draw_between(random, 0, 2 + size / 12);
  for (std::int32_t i = 0; i < robots; ++i) add_anywhere(random, instance, {});
  return instance;
}

Instance dense(Random& random, int size) {
  Instance instance;
  const std::int32_t most = 3 + size / 40;
  instance.map = GridMap(draw_between(random, 2, most), draw_between(random, 2, most));
  if (random.one_in(3)) block_some(random, instance.map, 8);
  const auto cells = static_cast<std::int32_t>(instance.map.cell_count());
  const std::int32_t robots = draw_between(random, cells / 2, cells * 4 / 5);
  for (std::int32_t i = 0; i < robots; ++i) add_anywhere(random, instance, {});
  return instance;
}

Instance corridor(Random& random, int size) {
  Instance instance;
  const std::int32_t length = draw_between(random, 4, 6 + size / 10);
  instance.map = GridMap(length, 3);
  for (std::int32_t x = 0; x < length; ++x) {
    instance.map.set_blocked({x, 0}, !random.one_in(4));
    instance.map.set_blocked({x, 2}, !random.one_in(4));
  }
  const std::int32_t robots = draw_between(random, 2, 3 + size / 40);
  for (std::int32_t i = 0; i < robots; ++i) add_anywhere(random, instance, {});
  return instance;
}

Instance contact_starts(Random& random, int size) {
  Instance instance;
  const std::int32_t side = draw_between(random, 3, 5 + size / 25);
  instance.map = GridMap(side, side);
  const Cell corner = draw_cell(random, instance.map);
  const std::int32_t columns = draw_between(random, 1, 3);
  const std::int32_t robots = draw_between(random, 2, 4 + size / 25);
  for (std::int32_t i = 0; i < robots; ++i) {
    Agent agent;
    agent.start = {corner.x + i % columns, corner.y + i / columns};
    for (int attempt = 0; attempt < kPlacingAttempts; ++attempt) {
      agent.goal = draw_cell(random, instance.map);
      if (try_add(instance, agent)) break;
    }
  }
  return instance;
}

Instance convoy(Random& random, int size) {
  Instance instance;
  const std::int32_t robots = draw_between(random, 2, 3 + size / 25);
  const std::int32_t shift = draw_between(random, 1, 4);
  const std::int32_t corner = draw_between(random, 0, 2);
  instance.map = GridMap(robots + shift, 1 + corner);
  const double slow = random.one_in(3) ? draw_speed(random) : 1.0;
  for (std::int32_t i = 0; i < robots; ++i) {
    Agent agent;
    agent.start = {i, 0};
    agent.goal = {i + shift, random.one_in(2) ? 0 : corner};
    agent.speed_cells_per_s = i == 0 ? slow : 1.0;
    try_add(instance, agent);
  }
  // A robot that comes from the other side.
  if (random.one_in(2)) add_anywhere(random, instance, {});
  return instance;
}

Instance mixed_bodies(Random& random, int size) {
  Instance instance;
  const std::int32_t most = 6 + size / 15;
  instance.map = GridMap(draw_between(random, 4, most), draw_between(random, 4, most));
  if (random.one_in(2)) block_some(random, instance.map, 10);
  const std::int32_t robots = draw_between(random, 1, 3 + size / 25);
  for (std::int32_t i = 0; i < robots; ++i) {
    Agent body;
    body.radius_cells = draw_radius(random);
    body.speed_cells_per_s = draw_speed(random);
    add_anywhere(random, instance, body);
  }
  return instance;
}

void add_obstacle(Random& random, Instance& instance) {
  DynamicObstacle obstacle;
  obstacle.id = std::to_string(instance.obstacles.size());
  obstacle.radius_cells = draw_radius(random);
  Trajectory& trajectory = obstacle.trajectory;
  trajectory.start = draw_cell(random, instance.map);
  const std::uint64_t motions = random.below(4);
  for (std::uint64_t i = 0; i < motions; ++i) {
    const double begin_s = trajectory.end_s();
    const Cell to = random.one_in(4) ? trajectory.end() : draw_cell(random, instance.map);
    trajectory.motions.push_back({begin_s, begin_s + 0.5 + draw_eighths(random, 4), trajectory.end(), to});
  }
  instance.obstacles.push_back(std::move(obstacle));
  if (find_error(instance)) instance.obstacles.pop_back();
}

double draw_ssi(Random& random) {
  switch (random.below(4)) {
    case 0:
      return 0;
    case 1:
      return kInfiniteSsi;
    default:
      return draw_eighths(random, 6);
  }
}

PlannerOptions draw_options(Random& random) {
  PlannerOptions options;
  options.order = static_cast<InitialOrder>(random.below(4));
  options.rescheduling = static_cast<Rescheduling>(random.below(3));
  options.ssi_s = draw_ssi(random);
  options.any_angle = !random.one_in(3);
  options.connectedness = draw_between(random, 2, 5);
  options.seed = random.below(1000);
  options.time_limit_s = std::numeric_limits<double>::infinity();
  options.max_expansions = kCaseExpansions;
  options.max_restarts = kCaseRestarts;
  return options;
}

}  // namespace

std::string_view name(CaseFamily family) {
  constexpr std::string_view kNames[] = {"scattered",      "dense",  "corridor",
                                         "contact starts", "convoy", "mixed bodies"};
  return kNames[static_cast<std::size_t>(family)];
}

PlanCase make_case(CaseFamily family, int size, std::uint64_t seed) {
  Random random(seed);
  PlanCase plan_case;
  plan_case.options = draw_options(random);
  const auto draw_instance = [&] {
    switch (family) {
      case CaseFamily::kScattered:
        return scattered(random, size);
      case CaseFamily::kDense:
        return dense(random, size);
      case CaseFamily::kCorridor:
        return corridor(random, size);
      case CaseFamily::kContactStarts:
        return contact_starts(random, size);
      case CaseFamily::kConvoy:
        return convoy(random, size);
      case CaseFamily::kMixedBodies:
        return mixed_bodies(random, size);
    }
    return Instance{};
  };
  plan_case.instance = draw_instance();
  if (random.one_in(4)) add_obstacle(random, plan_case.instance);
  if (random.one_in(12)) add_obstacle(random, plan_case.instance);
  if (random.one_in(6)) plan_case.options.weight = 1 + draw_eighths(random, 2);
  return plan_case;
}

PlanCase with_motion_rules(PlanCase plan_case, std::uint64_t seed) {
  Random random(seed);
  for (Agent& agent : plan_case.instance.agents) {
    agent.start_heading_deg = draw_heading(random);
    agent.goal_heading_deg = draw_goal_heading(random);
    agent.rotation_speed = draw_rotation_speed(random);
  }
  MotionRules& rules = plan_case.options.rules;
  rules.turns = true;
  if (random.one_in(4)) rules.wait_before_move_s = draw_eighths(random, 1);
  if (random.one_in(4)) rules.inflate_distance_cells = draw_eighths(random, 1);
  if (random.one_in(4)) rules.inflate_time_s = draw_eighths(random, 1);
  return plan_case;
}

double draw_eighths(Random& random, std::uint64_t limit) {
  return static_cast<double>(random.below(8 * limit + 1)) / 8;
}

Cell draw_cell(Random& random, const GridMap& map) {
  return map.cell(static_cast<std::size_t>(random.below(map.cell_count())));
}

double draw_radius(Random& random) {
  // The square root of one half: bodies on diagonal neighbours touch exactly, as
  // nearly as a double can say it.
  return pick(random, std::array{0.25, 0.375, 0.5, 0.5, 0.625, 0.7071067811865476, 1.0, 1.5});
}

double draw_speed(Random& random) {
  return pick(random, std::array{0.25, 0.5, 0.75, 1.0, 1.0, 1.5, 2.0, 3.0});
}

double draw_heading(Random& random) {
  constexpr double kEighthTurnDeg = 45;
  const auto eighths = static_cast<double>(random.below(8));
  return eighths * kEighthTurnDeg + (random.one_in(4) ? draw_eighths(random, 44) : 0.0);
}

double draw_rotation_speed(Random& random) {
  return pick(random, std::array{0.125, 0.25, 0.5, 1.0, 1.0, 2.0, 8.0});
}

std::optional<double> draw_goal_heading(Random& random) {
  if (random.one_in(2)) return std::nullopt;
  return draw_heading(random);
}

}  // namespace sipplab
