// Prices of moves in traffic, and distances over them.
#include "planner/complete/guidance.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <atomic>

#include "planner/complete/complete_planner.hpp"
#include "planner/complete/lacam.hpp"
#include "planner/core/random.hpp"
#include "planner/retime/unit_schedule.hpp"
#include "sipplab/generator.hpp"

namespace sipplab {
namespace {

/// Costs of the cheapest paths to the goal, by cell: every move tried until none helps.
std::vector<int> cheapest(const FreeGrid& grid, CellId goal, const MoveCosts& costs) {
  constexpr int kNever = 1'000'000;
  std::vector<int> known(grid.size(), kNever);
  known[goal] = 0;
  for (bool changed = true; changed;) {
    changed = false;
    for (CellId cell = 0; cell < grid.size(); ++cell) {
      for (std::size_t i = 0; i < grid.neighbours(cell).size(); ++i) {
        const int cost = known[grid.neighbours(cell)[i]] + costs[cell][i];
        if (cost >= known[cell]) continue;
        known[cell] = cost;
        changed = true;
      }
    }
  }
  return known;
}

TEST(GuidedDistances, AreThoseOfTheCheapestPathsInAnySequenceOfQuestions) {
  Random random(1);
  for (int world = 0; world < 50; ++world) {
    GridMap map(1 + static_cast<std::int32_t>(random.below(12)), 6);
    for (std::size_t i = 0; i < map.cell_count(); ++i) map.set_blocked(map.cell(i), random.one_in(5));
    map.set_blocked({0, 0}, false);
    const FreeGrid grid(map);
    MoveCosts costs(grid.size());
    for (auto& of_cell : costs) {
      for (std::uint8_t& cost : of_cell) {
        cost = static_cast<std::uint8_t>(kFreeMoveCost + random.below(kDearestMoveCost - kFreeMoveCost + 1));
      }
    }
    const CellIds goals = {static_cast<CellId>(random.below(grid.size())), 0};
    GuidedDistances distances(grid, goals, costs);
    for (int question = 0; question < 100; ++question) {
      const auto robot = static_cast<RobotId>(random.below(goals.size()));
      const std::vector<int> known = cheapest(grid, goals[robot], costs);
      const auto from = static_cast<CellId>(random.below(grid.size()));
      const auto neighbours = grid.neighbours(from);
      if (neighbours.empty() || known[from] == 1'000'000) continue;
      const CellId to = neighbours[random.below(neighbours.size())];
      ASSERT_EQ(distances.gain(robot, from, to), known[from] - known[to]);
    }
  }
}

TEST(TrafficCosts, APathAddsATenthOfAStepToMovesAgainstIt) {
  // Ten robots go to the right through one corridor.
  const FreeGrid grid(GridMap(20, 1));
  CellIds starts;
  CellIds goals;
  for (CellId robot = 0; robot < 10; ++robot) {
    starts.push_back(robot);
    goals.push_back(10 + robot);
  }
  const MoveCosts costs = traffic_costs(grid, starts, goals, {});
  ASSERT_EQ(grid.neighbours(9)[0], 10U);
  EXPECT_EQ(costs[9][0], kFreeMoveCost);
  EXPECT_EQ(costs[10][1], 2 * kFreeMoveCost);  // against all ten
  EXPECT_EQ(costs[1][1], kFreeMoveCost);       // against the first, a tenth: rounded
  EXPECT_EQ(costs[5][1], 6U);                  // against five

  const std::atomic<bool> stop{true};
  TimeLimits over;
  over.stop = &stop;
  EXPECT_EQ(traffic_costs(grid, starts, goals, over)[10][1], kFreeMoveCost);
}

TEST(TrafficCosts, PathsGoAroundTrafficTheOtherWay) {
  // Two corridors, and robots at both ends that want to get to the other one.
  GridMap map(12, 5);
  for (std::int32_t x = 2; x < 10; ++x) {
    for (const std::int32_t y : {0, 2, 4}) map.set_blocked({x, y}, true);
  }
  const FreeGrid grid(map);
  CellIds starts;
  CellIds goals;
  for (int robot = 0; robot < 20; ++robot) {
    const bool to_the_right = robot % 2 == 0;
    starts.push_back(grid.id({to_the_right ? 0 : 11, 2}));
    goals.push_back(grid.id({to_the_right ? 11 : 0, 2}));
  }
  const MoveCosts costs = traffic_costs(grid, starts, goals, {});
  const auto cost = [&](Cell from, Cell to) {
    const auto neighbours = grid.neighbours(grid.id(from));
    const auto found = std::find(neighbours.begin(), neighbours.end(), grid.id(to));
    return costs[grid.id(from)][static_cast<std::size_t>(found - neighbours.begin())];
  };
  // Each is one way, and dear the other way.
  for (const std::int32_t y : {1, 3}) {
    const int to_the_right = cost({5, y}, {6, y});
    const int to_the_left = cost({6, y}, {5, y});
    EXPECT_EQ(std::min(to_the_right, to_the_left), static_cast<int>(kFreeMoveCost)) << "row " << y;
    EXPECT_EQ(std::max(to_the_right, to_the_left), 2 * static_cast<int>(kFreeMoveCost)) << "row " << y;
  }
}

TEST(Lacam, CheapRowsOfPushesMakeShorterPlansOfCrowds) {
  GeneratorOptions wanted;
  wanted.agents = 200;
  double cheap_s = 0;
  double other_s = 0;
  for (wanted.index = 0; wanted.index < 5; ++wanted.index) {
    const auto instance = generate_instance(GridMap(16, 16), wanted);
    ASSERT_TRUE(instance);
    const FreeGrid grid(instance->map);
    CellIds starts;
    CellIds goals;
    for (const Agent& agent : instance->agents) {
      starts.push_back(grid.id(agent.start));
      goals.push_back(grid.id(agent.goal));
    }
    Lacam lacam(grid, starts, goals);
    const auto flowtime = [&](bool push_cheaply) {
      LacamLimits limits;
      limits.push_cheaply = push_cheaply;
      const LacamResult result = lacam.search(1, limits);
      EXPECT_EQ(result.status, LacamStatus::kSolved);
      return flowtime_s(unit_schedule(grid, Visits(result.steps, grid.size()), 1, 1).solution);
    };
    cheap_s += flowtime(true);
    other_s += flowtime(false);
  }
  EXPECT_LT(cheap_s, 0.75 * other_s);
}

TEST(CompletePlanner, KeepsThePlanThatCostsLeastByTheObjective) {
  GeneratorOptions wanted;
  wanted.agents = 120;
  PlannerOptions by_flowtime;
  PlannerOptions by_makespan;
  by_makespan.objective = {0, 1};
  bool differed = false;
  for (wanted.index = 0; wanted.index < 20 && !differed; ++wanted.index) {
    const auto instance = generate_instance(warehouse_map(), wanted);
    ASSERT_TRUE(instance);
    const Solution one = plan_complete(*instance, by_flowtime).solution;
    const Solution other = plan_complete(*instance, by_makespan).solution;
    EXPECT_LE(flowtime_s(one), flowtime_s(other));
    EXPECT_LE(makespan_s(other), makespan_s(one));
    differed = !(one == other);
  }
  EXPECT_TRUE(differed);  // else this test shows nothing
}

}  // namespace
}  // namespace sipplab
