// What the heuristic's weight and its knowledge of the map buy and cost, in counts.
#include <gtest/gtest.h>

#include <cmath>
#include <cstdint>

#include "planner/grid/static_distances.hpp"
#include "planner/search/sipp_search.hpp"
#include "planner/solve/plan.hpp"
#include "sipplab/generator.hpp"
#include "sipplab/prioritized_planner.hpp"
#include "sipplab/solution.hpp"

namespace sipplab {
namespace {

/// Robots on a map that is large enough for nodes far off the straight move.
Instance roomy_instance() {
  GeneratorOptions options;
  options.agents = 128;
  const Expected<Instance, std::string> instance = generate_instance(GridMap(64, 64), options);
  EXPECT_TRUE(instance.has_value());
  return instance.has_value() ? *instance : Instance{};
}

TEST(WeightedSearch, ExpandsAQuarterLessForATenthMoreOfTheHeuristic) {
  const Instance instance = roomy_instance();
  for (const bool turns : {false, true}) {
    PlannerOptions options;
    options.rules.turns = turns;
    const PlanResult plain = plan(instance, options);
    options.weight = 1.1;
    const PlanResult weighted = plan(instance, options);
    ASSERT_EQ(plain.status, PlanStatus::kSolved);
    ASSERT_EQ(weighted.status, PlanStatus::kSolved);
    EXPECT_LT(4 * weighted.statistics.expansions, 3 * plain.statistics.expansions) << "turns " << turns;
    EXPECT_LT(flowtime_s(weighted.solution), 1.02 * flowtime_s(plain.solution)) << "turns " << turns;
  }
}

TEST(WeightedSearch, PullingTightWinsBackAQuarterOfWhatAWeightCosts) {
  const Instance instance = roomy_instance();
  const auto flowtime = [&](double weight, bool elastic) {
    SippOptions options;
    options.weight = weight;
    options.elastic = elastic;
    SippSearch search(instance, options);
    const PlanResult result = plan_prioritized(instance, PlannerOptions{}, search);
    EXPECT_EQ(result.status, PlanStatus::kSolved);
    return flowtime_s(result.solution);
  };
  const double best_s = flowtime(1, false);
  EXPECT_LT(flowtime(1, true), best_s);
  EXPECT_LT(flowtime(1.2, true) - best_s, 0.75 * (flowtime(1.2, false) - best_s));
}

/// Robots in the aisles of a warehouse, whose paths turn around shelves.
Instance warehouse_instance() {
  GeneratorOptions options;
  options.agents = 32;
  const Expected<Instance, std::string> instance = generate_instance(warehouse_map(), options);
  EXPECT_TRUE(instance.has_value());
  return instance.has_value() ? *instance : Instance{};
}

TEST(GoalShot, IsLedAroundOtherRobotsByLegsInsteadOfSteps) {
  GeneratorOptions options;
  options.agents = 256;
  const Expected<Instance, std::string> instance = generate_instance(GridMap(64, 64), options);
  ASSERT_TRUE(instance.has_value());
  SippSearch search(*instance, {});
  const PlanResult result = plan_prioritized(*instance, PlannerOptions{}, search);
  ASSERT_EQ(result.status, PlanStatus::kSolved);
  constexpr std::uint64_t kMostForARobot = 65;  // without legs 90
  EXPECT_LT(result.statistics.expansions, kMostForARobot * instance->agents.size());
}

TEST(StaticDistances, ExpandAFifthLessBetweenShelves) {
  const Instance instance = warehouse_instance();
  PlanResult results[2];
  for (const bool static_distances : {false, true}) {
    SippOptions options;
    options.static_distances = static_distances;
    SippSearch search(instance, options);
    results[static_distances] = plan_prioritized(instance, PlannerOptions{}, search);
    ASSERT_EQ(results[static_distances].status, PlanStatus::kSolved);
  }
  EXPECT_LT(results[1].statistics.expansions, 0.8 * static_cast<double>(results[0].statistics.expansions));
  EXPECT_LT(flowtime_s(results[1].solution), 1.01 * flowtime_s(results[0].solution));
}

TEST(StaticDistances, AreFoundAgainWhereTheyWereForgotten) {
  // 8 MB a goal: a dozen do not fit.
  GridMap map(1024, 1024);
  map.set_blocked({500, 2}, true);
  const LineOfSight line_of_sight(map, 0.5);
  StepTable steps(line_of_sight, map.cell_count(), 3);
  StaticDistances distances(map, line_of_sight, steps, 3);
  const std::int32_t goals =
      static_cast<std::int32_t>(StaticDistances::kMostKeptBytes / map.cell_count() / 8) + 4;
  for (int round = 0; round < 2; ++round) {
    for (std::int32_t goal = 0; goal < goals; ++goal) {
      distances.set_goal({501 + goal, 2}, {499, 2});
      // One cell up, past the corner, and down again: aslant where there is room.
      EXPECT_NEAR(distances.excess_cells({499, 2}), goal == 0 ? 2 : std::sqrt(2.0), 1e-6);
    }
  }
}

}  // namespace
}  // namespace sipplab
