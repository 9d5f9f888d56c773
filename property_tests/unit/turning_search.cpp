// Robots with headings, by hand: what turns and delays cost, and when an earlier arrival
// is not the better one.
#include <gtest/gtest.h>

#include <cmath>
#include <string>

#include "planner/io/case_codec.hpp"
#include "planner/reservation/reservation_table.hpp"
#include "planner/solve/plan.hpp"
#include "sipplab/prioritized_planner.hpp"
#include "sipplab/validator.hpp"

namespace sipplab {
namespace {

/// The case with turns; `text` as decode_case reads it.
PlanCase turning_case(const std::string& text) {
  const std::optional<PlanCase> plan_case = decode_case(text);
  EXPECT_TRUE(plan_case);
  PlanCase turning = plan_case.value_or(PlanCase{});
  turning.options.rules.turns = true;
  turning.options.rescheduling = Rescheduling::kNone;
  turning.options.order = InitialOrder::kFifo;
  turning.options.ssi_s = 0;
  return turning;
}

/// Plans, has the plan validated, and returns it.
PlanResult valid_plan(const PlanCase& plan_case) {
  PlanResult result = plan(plan_case.instance, plan_case.options);
  EXPECT_EQ(result.status, PlanStatus::kSolved);
  const ValidationReport report =
      validate(plan_case.instance, result.solution,
               {plan_case.options.ssi_s, result.order(), plan_case.options.rules});
  EXPECT_TRUE(report.valid()) << report.violations.front().message;
  return result;
}

double arrival_s(const PlanCase& plan_case) { return makespan_s(valid_plan(plan_case).solution); }

TEST(TurningSearch, TurnsTakeTimeAtStartAndGoal) {
  PlanCase plan_case = turning_case("....\nrobot 0 0 to 3 0\n");
  Agent& agent = plan_case.instance.agents[0];
  EXPECT_EQ(arrival_s(plan_case), 3);
  agent.start_heading_deg = 180;
  EXPECT_EQ(arrival_s(plan_case), 4);
  agent.rotation_speed = 4;
  EXPECT_EQ(arrival_s(plan_case), 3.25);
  agent.goal_heading_deg = 90;
  EXPECT_EQ(arrival_s(plan_case), 3.375);
  agent.goal_heading_deg = 0;
  EXPECT_EQ(arrival_s(plan_case), 3.25);
  agent.goal = agent.start;
  EXPECT_EQ(arrival_s(plan_case), 0.25);
}

TEST(TurningSearch, EachMoveWaitsItsDelay) {
  PlanCase plan_case = turning_case("....\nrobot 0 0 to 3 0\n");
  plan_case.options.rules = {};
  plan_case.options.rules.wait_before_move_s = 0.5;
  EXPECT_EQ(arrival_s(plan_case), 3.5);  // in one go
  plan_case.options.any_angle = false;
  EXPECT_EQ(arrival_s(plan_case), 4.5);  // in three
}

TEST(TurningSearch, AStraightDetourCanBeQuickerThanTurning) {
  // Round one corner or round four.
  PlanCase plan_case = turning_case("...\n...\n...\nrobot 0 2 to 2 0\nany-angle no\n");
  plan_case.instance.agents[0].rotation_speed = 0.05;  // a quarter turn takes ten seconds
  EXPECT_EQ(arrival_s(plan_case), 14);
  plan_case.options.connectedness = 3;
  EXPECT_DOUBLE_EQ(arrival_s(plan_case), 5 + 2 * std::sqrt(2.0));  // an eighth of a turn
}

TEST(TurningSearch, EndsWhereNoUsefulArrivalIsLeft) {
  const PlanCase plan_case = turning_case("......\n......\n......\nrobot 0 0 to 5 2\nany-angle no\n");
  const auto search = single_agent_planner(plan_case.instance, plan_case.options);
  ReservationTable empty(plan_case.instance.map, 0.5);
  SearchLimits limits;
  SearchStatistics useful;
  limits.latest_arrival_s = 8;  // seven cells and a quarter turn
  EXPECT_TRUE(search->plan(0, empty, limits, useful));
  SearchStatistics useless;
  limits.latest_arrival_s = 6;
  EXPECT_FALSE(search->plan(0, empty, limits, useless));
  EXPECT_EQ(useless.expansions, 0U);
}

TEST(TurningSearch, AnEarlierArrivalWithAnotherHeadingDoesNotDominate) {
  // Two paths lead to (2, 2). By the one over the top the robot is there after 8 s, but
  // faces down and has 2 s to turn. By the other one it waits 3 s for the obstacle to
  // leave, is there after 9 s, and can go straight on.
  PlanCase plan_case = turning_case(
      "...@\n"
      ".@.@\n"
      "....\n"
      "robot 0 0 to 3 2\n"
      "obstacle 0 1 radius 0.5 until 3 at 0 1 until 3.125 at -9 1\n"
      "any-angle no\n");
  Agent& agent = plan_case.instance.agents[0];
  agent.start_heading_deg = 270;
  agent.rotation_speed = 0.25;
  const double sooner_s = arrival_s(plan_case);
  EXPECT_GT(sooner_s, 9.9);
  EXPECT_LE(sooner_s, 10.125);
  plan_case.instance.obstacles[0].trajectory.motions[0].end_s = 6;
  plan_case.instance.obstacles[0].trajectory.motions[1] = {6, 6.125, {0, 1}, {-9, 1}};
  EXPECT_EQ(arrival_s(plan_case), 11);  // now the other way is the quicker one
}

TEST(TurningSearch, AStartThatIsSafeForAMomentOnlyLeavesNoTimeToTurn) {
  // An obstacle follows the robot in contact from time 0 on.
  const std::string text =
      ".....\n"
      "robot 1 0 to 4 0\n"
      "obstacle 0 0 radius 0.5 until 3 at 3 0\n";
  PlanCase plan_case = turning_case(text);
  EXPECT_EQ(arrival_s(plan_case), 3);
  plan_case.instance.agents[0].start_heading_deg = 1;
  EXPECT_EQ(plan(plan_case.instance, plan_case.options).status, PlanStatus::kFailed);
  plan_case.instance.agents[0].start_heading_deg = 0;
  plan_case.options.rules.wait_before_move_s = 0.01;
  EXPECT_EQ(plan(plan_case.instance, plan_case.options).status, PlanStatus::kFailed);
}

TEST(TurningSearch, ARobotTurnsInPlaceWhileAnotherOnePasses) {
  const PlanCase plan_case = turning_case(
      "...\n"
      "...\n"
      "...\n"
      "robot 0 1 to 2 1\n"
      "robot 1 2 to 1 0\n");
  const PlanResult result = valid_plan(plan_case);
  // The second one has half a second of turning to do before it may go.
  EXPECT_EQ(result.solution.trajectories[1].motions.front().turn_to_deg, 90.0);
}

TEST(TurningSearch, MovingRobotsKeepTheInflationDistance) {
  // One that waits for another to pass before it moves to where that one came along.
  PlanCase plan_case = turning_case(
      ".......\n"
      ".......\n"
      "robot 0 0 to 6 0 speed 0.5\n"
      "robot 1 1 to 1 0\n");
  plan_case.options.rules = {};
  EXPECT_NEAR(arrival_s(plan_case), 12, 1e-6);
  EXPECT_NEAR(valid_plan(plan_case).solution.trajectories[1].arrival_s(), 4, 1e-6);
  plan_case.options.rules.inflate_distance_cells = 1;
  // Seen from the other one it goes up at 1 and back at 0.5 cells a second, along a line
  // that passes two cells away: sqrt(5) - 0.5 cells behind it on departure.
  EXPECT_NEAR(valid_plan(plan_case).solution.trajectories[1].arrival_s(), 2 + 2 * std::sqrt(5.0), 1e-6);
}

}  // namespace
}  // namespace sipplab
