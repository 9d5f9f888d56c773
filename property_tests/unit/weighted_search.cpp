// What a weight of the heuristic buys and costs, in counts, on a map with room for detours.
#include <gtest/gtest.h>

#include "planner/generator/generator.hpp"
#include "planner/prioritized/prioritized_planner.hpp"
#include "planner/solution/solution.hpp"

namespace sipplab {
namespace {

/// Robots on a map that is large enough for nodes far off the straight way.
Instance roomy_instance() {
  GeneratorOptions options;
  options.agents = 128;
  const Expected<Instance, std::string> instance = generate_instance(GridMap(64, 64), options);
  EXPECT_TRUE(instance.has_value());
  return instance.has_value() ? *instance : Instance{};
}

TEST(WeightedSearch, ExpandsLessThanHalfForATenthMoreOfTheHeuristic) {
  const Instance instance = roomy_instance();
  for (const bool turns : {false, true}) {
    PlannerOptions options;
    options.rules.turns = turns;
    const PlanResult plain = plan(instance, options);
    options.weight = 1.1;
    const PlanResult weighted = plan(instance, options);
    ASSERT_EQ(plain.status, PlanStatus::kSolved);
    ASSERT_EQ(weighted.status, PlanStatus::kSolved);
    EXPECT_LT(2 * weighted.statistics.expansions, plain.statistics.expansions) << "turns " << turns;
    EXPECT_LT(flowtime_s(weighted.solution), 1.02 * flowtime_s(plain.solution)) << "turns " << turns;
  }
}

}  // namespace
}  // namespace sipplab
