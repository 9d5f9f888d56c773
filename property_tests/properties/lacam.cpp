// LaCAM's search over cells alone: single steps against their rules, what it solves against an exhaustive
// search, however impatient, and where it is quick.
#include <rapidcheck.h>

#include <algorithm>
#include <atomic>
#include <cstdint>
#include <cstdlib>
#include <numeric>
#include <utility>
#include <vector>

#include "planner/complete/lacam.hpp"
#include "planner/complete/pibt.hpp"
#include "property_tests/support/crowds.hpp"
#include "property_tests/support/generators.hpp"
#include "property_tests/support/pebble_search.hpp"
#include "property_tests/support/property.hpp"

namespace sipplab::lacam_laws {
namespace {

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

const PropertyRoom room("lacam", [] {
  bool passed = true;

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

  return passed;
});

}  // namespace
}  // namespace sipplab::lacam_laws
