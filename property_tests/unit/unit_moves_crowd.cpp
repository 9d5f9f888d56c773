// Improvement by unit moves of a thousand robots on several threads: attempts that run at once are of robots
// far from each other, so that most are kept, and what one thread does wrong to another changes the plan.
#include <gtest/gtest.h>

#include <optional>

#include "planner/complete/complete_planner.hpp"
#include "planner/unit_moves/improve_unit_moves.hpp"
#include "sipplab/generator.hpp"

namespace sipplab {
namespace {

TEST(UnitMoves, AThousandRobotsGetTheSamePlanOnAnyNumberOfThreads) {
  GeneratorOptions wanted;
  wanted.agents = 1000;
  const Expected<Instance, std::string> instance =
      generate_instance(*parse_map_spec("shelves:10x20:10x2:1"), wanted);
  ASSERT_TRUE(instance) << instance.error();
  const CompleteResult planned = plan_complete(*instance, {});
  ASSERT_EQ(planned.status, LacamStatus::kSolved);
  std::optional<UnitImprovement> one;
  for (const unsigned threads : {1U, 3U}) {
    PlannerOptions options;
    options.threads = threads;
    options.improve = ImproveBudget{};
    options.improve->iterations = 48;
    const std::optional<UnitImprovement> result = improve_unit_moves(*instance, planned.solution, options);
    ASSERT_TRUE(result.has_value());
    if (!one) one = result;
    // Rounds of several changes, or this test shows nothing.
    EXPECT_GT(result->log.improvements, 12U);
    EXPECT_EQ(result->log.improvements, one->log.improvements);
    EXPECT_EQ(result->statistics.expansions, one->statistics.expansions);
    EXPECT_TRUE(result->solution == one->solution) << threads << " threads";
  }
}

TEST(UnitMoves, TheBestPlanOfACrowdIsTheResultWhereverItWanders) {
  GeneratorOptions wanted;
  wanted.agents = 40;
  const Expected<Instance, std::string> instance = generate_instance(*parse_map_spec("empty:10x10"), wanted);
  ASSERT_TRUE(instance) << instance.error();
  const CompleteResult planned = plan_complete(*instance, {});
  ASSERT_EQ(planned.status, LacamStatus::kSolved);
  // With seed 44 the best plan is one that it leaves while it wanders.
  for (std::uint64_t seed = 42; seed < 46; ++seed) {
    PlannerOptions options;
    options.seed = seed;
    options.improve = ImproveBudget{};
    options.improve->iterations = 12'000 + 16 * seed;
    const std::optional<UnitImprovement> result = improve_unit_moves(*instance, planned.solution, options);
    ASSERT_TRUE(result.has_value());
    const std::vector<ProgressPoint>& curve = result->log.curve;
    for (const ProgressPoint& point : curve) {
      EXPECT_GE(point.cost.flowtime_s, flowtime_s(result->solution));  // the search asserts it of all plans
    }
    EXPECT_GE(result->log.iterations, 9'600U);
  }
}

}  // namespace
}  // namespace sipplab
