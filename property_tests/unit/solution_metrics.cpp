// Costs and names of solutions.
#include "sipplab/solution.hpp"

#include <gtest/gtest.h>

namespace sipplab {
namespace {

Solution two_robots() {
  Solution solution;
  solution.trajectories.resize(2);
  solution.trajectories[0].motions = {{0, 1, {0, 0}, {1, 0}}, {1, 2.5, {1, 0}, {1, 0}}};
  solution.trajectories[1].start = {0, 1};
  solution.trajectories[1].motions = {{0, 1, {0, 1}, {0, 2}}};
  return solution;
}

TEST(Solution, WithoutRobotsCostsNothing) {
  EXPECT_EQ(makespan_s(Solution{}), 0);
  EXPECT_EQ(flowtime_s(Solution{}), 0);
}

TEST(Solution, RobotThatNeverMovesArrivesAtZero) {
  Solution solution;
  solution.trajectories.resize(1);
  EXPECT_EQ(makespan_s(solution), 0);
  EXPECT_EQ(flowtime_s(solution), 0);
}

TEST(Solution, MakespanIsLatestArrivalAndFlowtimeTheSum) {
  Solution solution = two_robots();
  EXPECT_EQ(makespan_s(solution), 1) << "robot 0 only waits after 1 s";
  EXPECT_EQ(flowtime_s(solution), 2);
  solution.trajectories[0].motions.push_back({2.5, 4, {1, 0}, {1, 1}});
  EXPECT_EQ(makespan_s(solution), 4);
  EXPECT_EQ(flowtime_s(solution), 5);
}

TEST(Solution, ATurnAtTheGoalIsNoRest) {
  Solution solution;
  solution.trajectories.push_back(
      {{0, 0}, {{0, 1, {0, 0}, {1, 0}}, {1, 2, {1, 0}, {1, 0}, 90}, {2, 9, {1, 0}, {1, 0}}}});
  EXPECT_EQ(flowtime_s(solution), 2);
}

TEST(Solution, CanonicalFormJoinsWhatGoesOnAndKeepsWhatDoesNot) {
  const Trajectory written{{0, 0},
                           {{0, 1, {0, 0}, {0, 0}},
                            {1, 2, {0, 0}, {0, 0}},
                            {2, 3, {0, 0}, {1, 1}},
                            {3, 5, {1, 1}, {3, 3}},
                            {5, 6, {3, 3}, {5, 5}},  // twice as fast
                            {6, 7, {5, 5}, {4, 4}},  // back
                            {7, 8, {4, 4}, {4, 4}}}};
  const Trajectory expected{
      {0, 0},
      {{0, 2, {0, 0}, {0, 0}}, {2, 5, {0, 0}, {3, 3}}, {5, 6, {3, 3}, {5, 5}}, {6, 7, {5, 5}, {4, 4}}}};
  EXPECT_EQ(canonical(written), expected);
  EXPECT_EQ(canonical(expected), expected);
}

TEST(Solution, HashIsThatOfEveryMachine) {
  // Pinned: a change of the encoding needs a new domain in plan_hash.
  EXPECT_EQ(plan_hash(Solution{}), "5ff5de544b19ab46168b49b66f975d3e");
  EXPECT_EQ(plan_hash(two_robots()), "cc9dddef501c416e6d43f756880c0bb9");
}

TEST(Solution, HashSeesEveryBit) {
  const std::string hash = plan_hash(two_robots());
  Solution later = two_robots();
  later.trajectories[1].motions[0].end_s = 1.0000000000000002;
  EXPECT_NE(plan_hash(later), hash);
  Solution elsewhere = two_robots();
  elsewhere.trajectories[1].start = {1, 0};
  EXPECT_NE(plan_hash(elsewhere), hash);
  Solution one_more = two_robots();
  one_more.trajectories.emplace_back();
  EXPECT_NE(plan_hash(one_more), hash);
}

TEST(Solution, HashTakesEqualPlansAsEqual) {
  Solution negative_zero = two_robots();
  negative_zero.trajectories[0].motions[0].begin_s = -0.0;
  ASSERT_EQ(negative_zero, two_robots());
  EXPECT_EQ(plan_hash(negative_zero), plan_hash(two_robots()));
}

}  // namespace
}  // namespace sipplab
