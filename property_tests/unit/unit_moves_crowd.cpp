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
  PlannerOptions options;
  options.seed = 44;  // the best plan is one that it leaves while it wanders
  options.improve = ImproveBudget{};
  options.improve->iterations = 12'704;
  const std::optional<UnitImprovement> result = improve_unit_moves(*instance, planned.solution, options);
  ASSERT_TRUE(result.has_value());
  for (const ProgressPoint& point : result->log.curve) {
    EXPECT_GE(point.cost.flowtime_s, flowtime_s(result->solution));  // the search asserts it of all plans
  }
  EXPECT_GE(result->log.iterations, 10'000U);
}

TEST(UnitMoves, WanderingInVainEnds) {
  Instance instance;
  instance.map = GridMap(4, 2);
  instance.agents.resize(2);  // they change places, so one of them must give way
  instance.agents[0].start = instance.agents[1].goal = {0, 0};
  instance.agents[0].goal = instance.agents[1].start = {3, 0};
  const CompleteResult planned = plan_complete(instance, {});
  ASSERT_EQ(planned.status, LacamStatus::kSolved);
  PlannerOptions options;
  options.improve = ImproveBudget{};
  options.improve->iterations = 200'000;
  const std::optional<UnitImprovement> result = improve_unit_moves(instance, planned.solution, options);
  ASSERT_TRUE(result.has_value());
  EXPECT_GT(flowtime_s(result->solution), 6);  // or it would end at once
  EXPECT_GT(result->log.iterations, 10 * 2 * 80U);
  EXPECT_LT(result->log.iterations, 20'000U);
}

}  // namespace
}  // namespace sipplab
