// Start-safe intervals without end, where a goal overlaps the start of a robot of lower
// priority without being on it: only robots wider than a cell can be in that position.
#include <gtest/gtest.h>

#include "planner/solve/plan.hpp"
#include "sipplab/validator.hpp"

namespace sipplab {
namespace {

Instance overlapping_goal() {
  Instance instance;
  instance.map = GridMap(6, 6);
  Agent wide;
  wide.id = "0";
  wide.start = {1, 1};
  wide.goal = {4, 2};
  wide.radius_cells = 0.625;
  Agent beside;
  beside.id = "1";
  beside.start = {3, 2};
  beside.goal = {2, 5};
  instance.agents = {wide, beside};
  return instance;
}

class StartGuard : public testing::TestWithParam<bool> {};

TEST_P(StartGuard, lets_a_robot_onto_its_goal_and_forgets_the_exception_afterwards) {
  const Instance instance = overlapping_goal();
  ASSERT_FALSE(find_error(instance));
  PlannerOptions options;
  options.order = InitialOrder::kFifo;
  options.rescheduling = Rescheduling::kNone;
  options.ssi_s = kInfiniteSsi;
  options.any_angle = GetParam();
  const PlanResult result = plan(instance, options);
  // The second robot starts inside the disk that was kept from the first one.
  ASSERT_EQ(result.status, PlanStatus::kSolved);
  const ValidationReport report =
      validate(instance, result.solution, {options.ssi_s, result.order(), options.rules});
  EXPECT_TRUE(report.valid()) << report.violations.front().message;
}

INSTANTIATE_TEST_SUITE_P(BothPlanners, StartGuard, testing::Bool(),
                         [](const auto& any_angle) { return any_angle.param ? "any_angle" : "grid"; });

}  // namespace
}  // namespace sipplab
