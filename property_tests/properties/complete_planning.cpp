// LaCAM: what it solves, against an exhaustive search; that its plans are
// valid; for how long its order keeps the starts safe.
#include <rapidcheck.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <cstdlib>
#include <numeric>
#include <utility>

#include "planner/complete/complete_planner.hpp"
#include "planner/solve/plan.hpp"
#include "property_tests/support/generators.hpp"
#include "property_tests/support/pebble_search.hpp"
#include "property_tests/support/property.hpp"
#include "sipplab/solve.hpp"
#include "sipplab/validator.hpp"

namespace sipplab::complete_planning_laws {
namespace {

/// Steps: far more than the cases here take, a few milliseconds each at most.
constexpr std::uint64_t kMostSteps = 20'000;

PlannerOptions options_of(const PlanCase& plan_case) {
  PlannerOptions options = plan_case.options;
  options.max_expansions = kMostSteps;
  return options;
}

PlanCase any_case_within_model() {
  PlanCase plan_case = within_complete_model(*any_case());
  classify_case(plan_case);
  note_case(plan_case);
  return plan_case;
}

/// A few cells, and on most of them robots whose goals are among these cells.
PlanCase make_crowd(std::uint64_t seed) {
  Random random(seed);
  const auto upto = [&random](std::uint64_t most) {
    return 1 + static_cast<std::int32_t>(random.below(most));
  };
  PlanCase plan_case;
  GridMap& map = plan_case.instance.map;
  map = GridMap(1 + upto(3), upto(3));
  std::vector<std::size_t> cells(map.cell_count());
  std::iota(cells.begin(), cells.end(), std::size_t{0});
  random.shuffle(cells);
  const std::size_t free_cells = std::min<std::size_t>(cells.size(), 2 + random.below(6));
  for (std::size_t i = free_cells; i < cells.size(); ++i) map.set_blocked(map.cell(cells[i]), true);
  cells.resize(free_cells);
  std::vector<std::size_t> goals = cells;
  random.shuffle(goals);
  const std::size_t robots = free_cells - std::min<std::size_t>(free_cells, random.below(4));
  // In half of the cases bodies of all sizes that the planner takes; in half of those slow or fast ones.
  constexpr std::array<double, 4> kRadii = {0.5, 0.375, 0.25, 0.125};
  constexpr std::array<double, 4> kSpeeds = {1, 1, 0.5, 2};
  const bool are_equal = random.one_in(2);
  const double speed = are_equal ? 1 : kSpeeds[random.below(kSpeeds.size())];
  for (std::size_t i = 0; i < robots; ++i) {
    Agent agent;
    agent.start = map.cell(cells[i]);
    agent.goal = map.cell(goals[i]);
    agent.speed_cells_per_s = speed;
    if (!are_equal) agent.radius_cells = kRadii[random.below(kRadii.size())];
    plan_case.instance.agents.push_back(agent);
  }
  constexpr std::array<double, 4> kSsis = {0, 2.5, 5, kInfiniteSsi};
  plan_case.options.ssi_s = kSsis[random.below(kSsis.size())];
  plan_case.options.seed = random.next();
  return plan_case;
}

PlanCase any_crowd() {
  PlanCase plan_case = make_crowd(at_full_size([] { return *rc::gen::arbitrary<std::uint64_t>(); }));
  RC_PRE(pebble_search_is_small(plan_case.instance));
  classify_case(plan_case);
  note_case(plan_case);
  return plan_case;
}

/// A crowd as the search sees it: cells alone.
struct Cells {
  FreeGrid grid;
  Configuration starts;
  Configuration goals;

  explicit Cells(const Instance& instance) : grid(instance.map) {
    for (const Agent& agent : instance.agents) {
      starts.push_back(grid.id(agent.start));
      goals.push_back(grid.id(agent.goal));
    }
  }
};

bool are_neighbours(Cell a, Cell b) { return std::abs(a.x - b.x) + std::abs(a.y - b.y) == 1; }

/// Whether the robots can make the step at once: to neighbours or not at all, no two to one cell, and none of
/// them in a closed ring. Robots without a cell do not count.
bool is_step(const FreeGrid& grid, const Configuration& now, const Configuration& next) {
  for (std::size_t i = 0; i < now.size(); ++i) {
    if (next[i] == kNoCell) continue;
    if (now[i] != next[i] && !are_neighbours(grid.cell(now[i]), grid.cell(next[i]))) return false;
    for (std::size_t j = i + 1; j < now.size(); ++j) {
      if (next[i] == next[j]) return false;
    }
    // Who is where the robot goes, and where does that one go, and so on: never back to this robot.
    std::size_t ahead = i;
    for (std::size_t hops = 0; hops < now.size() && next[ahead] != kNoCell && next[ahead] != now[ahead];
         ++hops) {
      const auto found = std::find(now.begin(), now.end(), next[ahead]);
      if (found == now.end()) break;
      ahead = static_cast<std::size_t>(found - now.begin());
      if (ahead == i) return false;
    }
  }
  return true;
}

/// Two robots beside a free cell through which both have to go, the second one farther. Columns and rows are
/// drawn, and which of the two is first in the input.
struct Junction {
  FreeGrid grid;
  Configuration starts;
  Configuration goals;
  CellId middle;

  static Junction any() {
    constexpr std::int32_t kLongest = 4;
    GridMap map(2 * kLongest + 1, 2 * kLongest + 1);
    const Cell middle{kLongest, kLongest};
    for (std::size_t i = 0; i < map.cell_count(); ++i) map.set_blocked(map.cell(i), true);
    map.set_blocked(middle, false);
    std::vector<Cell> sides = {{1, 0}, {0, 1}, {-1, 0}, {0, -1}};
    Random random(*rc::gen::arbitrary<std::uint64_t>());
    random.shuffle(sides);
    const std::int32_t way = 2 + static_cast<std::int32_t>(random.below(kLongest - 1));
    const auto at = [&](std::size_t side, std::int32_t cells) {
      return Cell{middle.x + cells * sides[side].x, middle.y + cells * sides[side].y};
    };
    for (std::int32_t i = 1; i <= way; ++i) map.set_blocked(at(0, i), false);
    for (const std::size_t side : {1U, 2U}) map.set_blocked(at(side, 1), false);
    FreeGrid grid(map);
    const std::int32_t nearer =
        1 + static_cast<std::int32_t>(random.below(static_cast<std::uint64_t>(way) - 1));
    Configuration starts = {grid.id(at(1, 1)), grid.id(at(2, 1))};
    Configuration goals = {grid.id(at(0, nearer)), grid.id(at(0, way))};
    const CellId id = grid.id(middle);
    return {std::move(grid), std::move(starts), std::move(goals), id};
  }
};

/// A lane one cell wide with two robots in it that face each other. They can pass at its beginning, where it
/// has an arm to each side. At its end it has none, or two of which one is taken by a robot that has arrived.
struct Lane {
  FreeGrid grid;
  Configuration starts;
  Configuration goals;
  std::int32_t length;

  static Lane any() {
    Random random(*rc::gen::arbitrary<std::uint64_t>());
    const auto length = 6 + static_cast<std::int32_t>(random.below(12));
    const bool is_upright = random.one_in(2);
    const bool is_backward = random.one_in(2);
    const auto at = [&](std::int32_t along, std::int32_t aside) {
      const Cell cell{is_backward ? length - 1 - along : along, 1 + aside};
      return is_upright ? Cell{cell.y, cell.x} : cell;
    };
    GridMap map(is_upright ? 3 : length, is_upright ? length : 3);
    for (const std::int32_t aside : {-1, 1}) {
      for (std::int32_t along = 1; along < length; ++along) map.set_blocked(at(along, aside), true);
    }
    const auto from = 1 + static_cast<std::int32_t>(random.below(static_cast<std::uint64_t>(length) - 3));
    std::vector<std::pair<Cell, Cell>> robots = {{at(from, 0), at(length - 1, 0)},
                                                 {at(from + 1, 0), at(0, 0)}};
    if (random.one_in(2)) {
      const std::int32_t taken = random.one_in(2) ? 1 : -1;
      for (const std::int32_t aside : {-1, 1}) map.set_blocked(at(length - 1, aside), false);
      robots.emplace_back(at(length - 1, taken), at(length - 1, taken));
    }
    random.shuffle(robots);
    FreeGrid grid(map);
    Configuration starts;
    Configuration goals;
    for (const auto& [start, goal] : robots) {
      starts.push_back(grid.id(start));
      goals.push_back(grid.id(goal));
    }
    return {std::move(grid), std::move(starts), std::move(goals), length};
  }
};

/// Of each cell, the robots that come to it, one after the other.
std::vector<std::vector<AgentIndex>> visitors_of(const GridMap& map, const Solution& solution) {
  std::vector<std::vector<std::pair<double, AgentIndex>>> comings(map.cell_count());
  for (AgentIndex robot = 0; robot < solution.trajectories.size(); ++robot) {
    const Trajectory& trajectory = solution.trajectories[robot];
    comings[map.index(trajectory.start)].emplace_back(-1, robot);
    for (const TimedMotion& motion : trajectory.motions) {
      const Cell path{motion.to.x - motion.from.x, motion.to.y - motion.from.y};
      const std::int32_t cells = std::abs(path.x) + std::abs(path.y);
      for (std::int32_t i = 1; i <= cells; ++i) {
        const Cell cell{motion.from.x + path.x / cells * i, motion.from.y + path.y / cells * i};
        comings[map.index(cell)].emplace_back(motion.begin_s + (motion.end_s - motion.begin_s) * i / cells,
                                              robot);
      }
    }
  }
  std::vector<std::vector<AgentIndex>> visitors;
  for (auto& coming : comings) {
    std::sort(coming.begin(), coming.end());
    visitors.emplace_back();
    for (const auto& [time_s, robot] : coming) visitors.back().push_back(robot);
  }
  return visitors;
}

bool is_valid(const Instance& instance, const Solution& solution, double ssi_s,
              const std::vector<AgentIndex>& order) {
  ValidationOptions options;
  options.ssi_s = ssi_s;
  options.order = order;
  return validate(instance, solution, options).valid();
}

const PropertyRoom room("complete_planning", [] {
  bool passed = true;

  passed &= property("plan_complete (1): solves exactly what an exhaustive search solves", [] {
    const PlanCase plan_case = any_crowd();
    const CompleteResult result = plan_complete(plan_case.instance, PlannerOptions{});
    const bool solvable = is_solvable_by_pebbles(plan_case.instance);
    RC_CLASSIFY(solvable, "solvable");
    RC_ASSERT(result.status == (solvable ? LacamStatus::kSolved : LacamStatus::kUnsolvable));
  });

  passed &= property("plan_complete (2): every plan of a crowd is valid, its guarantee kept", [] {
    const PlanCase plan_case = any_crowd();
    const CompleteResult result = plan_complete(plan_case.instance, options_of(plan_case));
    RC_CLASSIFY(result.status == LacamStatus::kSolved, "solved");
    if (result.status != LacamStatus::kSolved) return;
    RC_ASSERT(is_valid(plan_case.instance, result.solution, result.ssi_kept_s, result.order));
  });

  passed &= property("plan_complete (2): every plan is valid, its guarantee kept", [] {
    const PlanCase plan_case = any_case_within_model();
    RC_ASSERT(!find_beyond_complete(plan_case.instance));
    const CompleteResult result = plan_complete(plan_case.instance, options_of(plan_case));
    RC_CLASSIFY(result.status == LacamStatus::kSolved, "solved");
    if (result.status != LacamStatus::kSolved) return;
    RC_ASSERT(result.ssi_kept_s <= plan_case.options.ssi_s);
    RC_ASSERT(is_valid(plan_case.instance, result.solution, result.ssi_kept_s, result.order));
  });

  passed &= property("plan_complete (2): no order keeps the starts safe for longer", [] {
    constexpr double kLongerS = 1e-3;
    const PlanCase plan_case = any_crowd();
    RC_PRE(plan_case.instance.agents.size() <= 5u);
    const CompleteResult result = plan_complete(plan_case.instance, options_of(plan_case));
    if (result.status != LacamStatus::kSolved) return;
    const bool all_of_it = result.ssi_kept_s == plan_case.options.ssi_s;
    RC_CLASSIFY(!all_of_it, "not kept to the end");
    if (all_of_it) return;
    std::vector<AgentIndex> order(plan_case.instance.agents.size());
    std::iota(order.begin(), order.end(), AgentIndex{0});
    do {
      RC_ASSERT(!is_valid(plan_case.instance, result.solution, result.ssi_kept_s + kLongerS, order));
    } while (std::next_permutation(order.begin(), order.end()));
  });

  passed &= property("plan_complete (2): of the orders that keep them safe as long, the first", [] {
    const PlanCase plan_case = any_crowd();
    RC_PRE(plan_case.instance.agents.size() <= 5u);
    const CompleteResult result = plan_complete(plan_case.instance, options_of(plan_case));
    if (result.status != LacamStatus::kSolved) return;
    std::vector<AgentIndex> order(plan_case.instance.agents.size());
    std::iota(order.begin(), order.end(), AgentIndex{0});
    RC_CLASSIFY(result.order != order, "not that of input");
    while (!is_valid(plan_case.instance, result.solution, result.ssi_kept_s, order)) {
      RC_ASSERT(std::next_permutation(order.begin(), order.end()));
    }
    RC_ASSERT(result.order == order);
  });

  passed &= property("plan_complete (2): no robot leaves a cell and comes back before anybody else came", [] {
    const PlanCase plan_case = any_crowd();
    const CompleteResult result = plan_complete(plan_case.instance, options_of(plan_case));
    if (result.status != LacamStatus::kSolved) return;
    for (const std::vector<AgentIndex>& visitors : visitors_of(plan_case.instance.map, result.solution)) {
      RC_ASSERT(std::adjacent_find(visitors.begin(), visitors.end()) == visitors.end());
    }
  });

  passed &= property("plan_complete (4): no plan for another objective costs less by this one", [] {
    const PlanCase plan_case = any_case_within_model();
    PlannerOptions options = options_of(plan_case);
    const std::vector<Objective> objectives = {{1, 0}, {0, 1}, {1, 4}};
    std::vector<CompleteResult> results;
    for (const Objective& objective : objectives) {
      options.objective = objective;
      results.push_back(plan_complete(plan_case.instance, options));
    }
    if (results.front().status != LacamStatus::kSolved) return;
    RC_CLASSIFY(results[0].solution != results[1].solution, "objectives differ in their plans");
    for (std::size_t i = 0; i < objectives.size(); ++i) {
      const auto cost = [&](const CompleteResult& result) {
        return objectives[i].flowtime_weight * flowtime_s(result.solution) +
               objectives[i].makespan_weight * makespan_s(result.solution);
      };
      for (const CompleteResult& other : results) RC_ASSERT(cost(results[i]) <= cost(other) + 1e-9);
    }
  });

  passed &= property("plan_complete: budgets of steps are kept by all of its plans together", [] {
    const PlanCase plan_case = any_case_within_model();
    PlannerOptions options = options_of(plan_case);
    const CompleteResult free = plan_complete(plan_case.instance, options);
    RC_PRE(free.steps_tried > 0u);
    options.max_expansions = *rc::gen::inRange<std::uint64_t>(0, free.steps_tried + 2);
    const CompleteResult limited = plan_complete(plan_case.instance, options);
    RC_ASSERT(limited.steps_tried <= options.max_expansions);
    if (options.max_expansions >= free.steps_tried) RC_ASSERT(limited.solution == free.solution);
    if (limited.status == LacamStatus::kSolved) RC_ASSERT(free.status == LacamStatus::kSolved);
  });

  passed &= property("Pibt::make_step (1) to (4): steps keep the rules and the constraints", [] {
    const PlanCase plan_case = any_crowd();
    const Cells cells(plan_case.instance);
    const std::size_t robots = cells.starts.size();
    GoalDistances distances(cells.grid, cells.goals);
    for (RobotId robot = 0; robot < robots; ++robot) {
      RC_PRE(distances.first_distance(robot, cells.starts[robot]).has_value());
    }
    Random random(at_full_size([] { return *rc::gen::arbitrary<std::uint64_t>(); }));
    Pibt pibt(cells.grid, distances, random.one_in(2), random.next());
    std::vector<RobotId> order(robots);
    std::iota(order.begin(), order.end(), RobotId{0});
    bool some_found = false;
    constexpr int kSteps = 8;
    for (int i = 0; i < kSteps; ++i) {
      random.shuffle(order);
      const std::uint64_t share = random.below(4);  // of robots constrained: none to all
      std::vector<StepConstraint> constraints;
      Configuration wanted(robots, kNoCell);
      for (RobotId robot = 0; robot < robots; ++robot) {
        if (random.below(3) >= share) continue;
        const auto near = cells.grid.neighbours(cells.starts[robot]);
        const std::size_t choice = random.below(near.size() + 1);
        wanted[robot] = choice < near.size() ? near[choice] : cells.starts[robot];
        constraints.push_back({robot, wanted[robot]});
      }
      Configuration next;
      const StepOutcome outcome = pibt.make_step(cells.starts, order, constraints, next);
      RC_ASSERT((outcome == StepOutcome::kContradiction) == !is_step(cells.grid, cells.starts, wanted));
      if (constraints.size() == robots) RC_ASSERT(outcome != StepOutcome::kNotFound);
      if (outcome != StepOutcome::kFound) continue;
      some_found = true;
      RC_ASSERT(is_step(cells.grid, cells.starts, next));
      for (const StepConstraint& constraint : constraints) {
        RC_ASSERT(next[constraint.robot] == constraint.cell);
      }
    }
    RC_CLASSIFY(some_found, "some found");
  });

  passed &= property("Lacam::search (1): however impatient, it solves exactly what can be solved", [] {
    const PlanCase plan_case = any_crowd();
    const Cells cells(plan_case.instance);
    LacamLimits limits;
    limits.patience_lengths = *rc::gen::inRange<std::uint64_t>(0, 2);
    limits.least_patience_steps = *rc::gen::element<std::uint64_t>(1, 2, 5, 20);
    const LacamResult result = Lacam(cells.grid, cells.starts, cells.goals).search(1, limits);
    const auto [solvable, arrangements] = search_by_pebbles(plan_case.instance);
    RC_CLASSIFY(result.steps_tried > limits.least_patience_steps, "several searches");
    // A proof has seen whatever can be reached. (Where a goal is out of reach it needs none.)
    if (!solvable && result.configurations > 0) RC_ASSERT(result.configurations == arrangements);
    RC_CLASSIFY(!solvable && result.configurations > 20, "20 configurations or more seen for a proof");
    RC_ASSERT(result.status == (solvable ? LacamStatus::kSolved : LacamStatus::kUnsolvable));
    RC_ASSERT(result.steps.empty() != solvable);
    if (!solvable) return;
    RC_ASSERT(result.steps.front() == cells.starts);
    RC_ASSERT(result.steps.back() == cells.goals);
    for (std::size_t i = 1; i < result.steps.size(); ++i) {
      RC_ASSERT(is_step(cells.grid, result.steps[i - 1], result.steps[i]));
    }
    // All of its searches share a budget.
    const std::uint64_t needed = result.steps_tried;
    limits.max_steps = *rc::gen::inRange<std::uint64_t>(0, needed + 2);
    const LacamResult limited = Lacam(cells.grid, cells.starts, cells.goals).search(1, limits);
    RC_ASSERT(limited.steps_tried == std::min(limits.max_steps, needed));
    RC_ASSERT(limited.status == (limits.max_steps < needed ? LacamStatus::kLimit : LacamStatus::kSolved));
    limits.max_steps = UINT64_MAX;
    limits.max_memory_bytes = 0;
    const LacamResult forgetful = Lacam(cells.grid, cells.starts, cells.goals).search(1, limits);
    RC_ASSERT(forgetful.status == (cells.starts == cells.goals ? LacamStatus::kSolved : LacamStatus::kLimit));
    const std::atomic<bool> stop{true};
    TimeLimits over;
    over.stop = &stop;
    const LacamResult late = Lacam(cells.grid, cells.starts, cells.goals, over).search(1, {});
    RC_ASSERT(late.status == (cells.starts.empty() ? LacamStatus::kSolved : LacamStatus::kLimit));
    RC_ASSERT(late.steps_tried == 0u);
  });

  passed &= property("Lacam::search: of two robots at a junction the one with the longer way goes first", [] {
    Junction junction = at_full_size(Junction::any);
    const bool is_swapped = *rc::gen::arbitrary<bool>();
    if (is_swapped) {
      std::swap(junction.starts[0], junction.starts[1]);
      std::swap(junction.goals[0], junction.goals[1]);
    }
    Lacam lacam(junction.grid, junction.starts, junction.goals);
    const LacamResult result = lacam.search(*rc::gen::arbitrary<std::uint64_t>(), {});
    RC_ASSERT(result.status == LacamStatus::kSolved);
    RC_ASSERT(result.steps.at(1)[is_swapped ? 0 : 1] == junction.middle);
  });

  passed &= property(
      "Lacam::search: robots that face each other in a lane go to where they can pass",
      [] {
        // There, past each other, and back: on average no cell much more than twice. Who tries the other
        // side, too, takes several times as many steps, up to the square of them. Single cases may have bad
        // luck.
        constexpr int kLanes = 40;
        constexpr std::uint64_t kMostPerCell = 5;
        std::uint64_t cells = 0;
        std::uint64_t steps = 0;
        for (int i = 0; i < kLanes; ++i) {
          const Lane lane = at_full_size(Lane::any);
          const auto seed = *rc::gen::arbitrary<std::uint64_t>();
          const LacamResult result = Lacam(lane.grid, lane.starts, lane.goals).search(seed, {});
          RC_ASSERT(result.status == LacamStatus::kSolved);
          steps += result.steps_tried;
          cells += static_cast<std::uint64_t>(lane.length);
        }
        RC_ASSERT(steps <= kMostPerCell * cells);
      },
      kCasesOfWorlds / 10);

  passed &= property("plan_complete (3): the same case gives the same plan", [] {
    const PlanCase plan_case = any_case_within_model();
    const CompleteResult one = plan_complete(plan_case.instance, options_of(plan_case));
    const CompleteResult other = plan_complete(plan_case.instance, options_of(plan_case));
    RC_ASSERT(one.status == other.status);
    RC_ASSERT(one.solution == other.solution);
    RC_ASSERT(one.order == other.order);
    RC_ASSERT(one.ssi_kept_s == other.ssi_kept_s);
    RC_ASSERT(one.steps_tried == other.steps_tried);
  });

  passed &= property("a fallback plans what was not solved, and changes nothing else", [] {
    PlanCase plan_case = any_case_within_model();
    plan_case.options.max_expansions = std::min(plan_case.options.max_expansions, kMostSteps);
    const PlanResult without = plan(plan_case.instance, plan_case.options);
    plan_case.options.fallback = Fallback::kComplete;
    const PlanResult with = plan(plan_case.instance, plan_case.options);
    const bool needed = without.status != PlanStatus::kSolved;
    RC_CLASSIFY(needed, "needed");
    RC_CLASSIFY(needed && with.status == PlanStatus::kSolved, "saved");
    RC_ASSERT(with.made_by == (needed ? Method::kComplete : Method::kPrioritized));
    if (!needed) {
      RC_ASSERT(with.solution == without.solution);
      RC_ASSERT(with.ssi_kept_s == plan_case.options.ssi_s);
    } else if (with.status == PlanStatus::kSolved) {
      RC_ASSERT(with.tries() == without.tries() + 1);
      const CompleteResult complete = plan_complete(plan_case.instance, plan_case.options);
      RC_ASSERT(with.statistics.expansions == without.statistics.expansions + complete.steps_tried);
      RC_ASSERT(with.statistics.generations == without.statistics.generations + complete.configurations);
      RC_ASSERT(with.ssi_kept_s == complete.ssi_kept_s);
      RC_ASSERT(is_valid(plan_case.instance, with.solution, with.ssi_kept_s, with.order()));
    }
  });

  passed &= property("bodies, speeds and obstacles beyond the model are refused in one line", [] {
    const PlanCase plan_case = *any_case();
    const Instance& instance = plan_case.instance;
    const bool beyond = !instance.obstacles.empty() ||
                        std::any_of(instance.agents.begin(), instance.agents.end(), [&](const Agent& agent) {
                          return agent.radius_cells > kDefaultRadiusCells ||
                                 agent.speed_cells_per_s != instance.agents.front().speed_cells_per_s;
                        });
    RC_CLASSIFY(beyond, "beyond");
    MotionRules rules;
    rules.wait_before_move_s = *rc::gen::element(0.0, 0.0, 0.5);
    RC_ASSERT(find_beyond_complete(instance, rules).has_value() == (beyond || rules.wait_before_move_s > 0));
    rules = {true};
    RC_ASSERT(find_beyond_complete(instance, rules).has_value());
    const auto error = find_beyond_complete(instance);
    RC_ASSERT(error.has_value() == beyond);
    if (!error) return;
    RC_ASSERT(!error->what.empty() && !error->expected.empty());
    RC_ASSERT((error->what + error->expected).find('\n') == std::string::npos);
    PlannerOptions options;
    options.method = Method::kComplete;
    RC_ASSERT(plan(instance, options).status == PlanStatus::kFailed);
  });

  passed &= property("what the improvement of its plan says that it keeps, it keeps", [] {
    const PlanCase plan_case = any_crowd();
    PlannerOptions options = options_of(plan_case);
    options.method = Method::kComplete;
    options.improve = ImproveBudget{};
    options.improve->iterations = 3;
    const SolveResult result = solve(plan_case.instance, options);
    if (!result.improvement) return;
    RC_CLASSIFY(result.plan.ssi_kept_s < options.ssi_s, "not kept to the end");
    RC_ASSERT(result.improvement->log.keeps_guarantee);
    RC_ASSERT(result.ssi_kept_s() <= options.ssi_s);
    RC_ASSERT(is_valid(plan_case.instance, result.solution(), result.ssi_kept_s(), result.order()));
  });

  passed &= property("inflation does not go with ejection, improvement or the best plan", [] {
    const Instance instance = (*any_case()).instance;
    PlannerOptions options;
    const int kind = *rc::gen::inRange(0, 4);
    if (kind == 1) options.rescheduling = Rescheduling::kEjection;
    if (kind == 2) options.improve = ImproveBudget{};
    if (kind == 3) options.best = true;
    RC_ASSERT(!find_beyond(instance, options));
    (*rc::gen::arbitrary<bool>() ? options.rules.inflate_time_s : options.rules.inflate_distance_cells) = 0.5;
    RC_ASSERT(find_beyond(instance, options).has_value() == (kind > 0));
  });

  return passed;
});

}  // namespace
}  // namespace sipplab::complete_planning_laws
