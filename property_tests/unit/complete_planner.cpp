// LaCAM on small maps that a person can draw.
#include "planner/complete/complete_planner.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <utility>
#include <vector>

#include "planner/retime/exact_time.hpp"
#include "planner/retime/unit_schedule.hpp"
#include "sipplab/validator.hpp"

namespace sipplab {
namespace {

using Paths = std::vector<std::pair<Cell, Cell>>;

Instance instance_of(std::int32_t width, std::int32_t height, const Paths& paths,
                     const std::vector<Cell>& blocked = {}) {
  Instance instance;
  instance.map = GridMap(width, height);
  for (const Cell cell : blocked) instance.map.set_blocked(cell, true);
  for (const auto& [start, goal] : paths) {
    Agent agent;
    agent.start = start;
    agent.goal = goal;
    instance.agents.push_back(agent);
  }
  return instance;
}

CompleteResult planned(const Instance& instance, double ssi_s = 0) {
  PlannerOptions options;
  options.ssi_s = ssi_s;
  CompleteResult result = plan_complete(instance, options);
  if (result.status == LacamStatus::kSolved) {
    const ValidationReport report = validate(instance, result.solution, {result.ssi_kept_s, result.order});
    EXPECT_TRUE(report.valid()) << report.violations.front().message;
  }
  return result;
}

TEST(CompletePlanner, NoRobotsHaveAPlan) {
  EXPECT_EQ(planned(instance_of(3, 3, {})).status, LacamStatus::kSolved);
}

TEST(CompletePlanner, ALoneRobotGoesStraightOnWithoutAStop) {
  const CompleteResult result = planned(instance_of(9, 1, {{{1, 0}, {7, 0}}}));
  const std::vector<TimedMotion> straight = {{0, 6, {1, 0}, {7, 0}}};
  EXPECT_EQ(result.solution.trajectories.at(0).motions, straight);
}

TEST(CompletePlanner, ARingWithoutAFreeCellCannotTurn) {
  const Paths ring = {{{0, 0}, {1, 0}}, {{1, 0}, {1, 1}}, {{1, 1}, {0, 1}}, {{0, 1}, {0, 0}}};
  EXPECT_EQ(planned(instance_of(2, 2, ring)).status, LacamStatus::kUnsolvable);
}

TEST(CompletePlanner, ARingWithAFreeCellTurns) {
  const Paths ring = {{{0, 0}, {1, 0}}, {{1, 0}, {1, 1}}, {{1, 1}, {0, 1}}};
  EXPECT_EQ(planned(instance_of(2, 2, ring)).status, LacamStatus::kSolved);
}

TEST(CompletePlanner, ARingOfSevenTurnsInNineCells) {
  const std::vector<Cell> round = {{0, 0}, {1, 0}, {2, 0}, {2, 1}, {2, 2}, {1, 2}, {0, 2}, {0, 1}};
  Paths ring;
  for (std::size_t i = 0; i < round.size(); ++i) ring.push_back({round[i], round[(i + 1) % round.size()]});
  ring.pop_back();  // all eight cannot, with one free cell: that is an odd permutation
  EXPECT_EQ(planned(instance_of(3, 3, ring)).status, LacamStatus::kSolved);
}

TEST(CompletePlanner, TwoRobotsCannotPassInACorridorButInABay) {
  const Paths swap = {{{0, 0}, {4, 0}}, {{4, 0}, {0, 0}}};
  EXPECT_EQ(planned(instance_of(5, 1, swap)).status, LacamStatus::kUnsolvable);
  const std::vector<Cell> bay = {{0, 1}, {1, 1}, {3, 1}, {4, 1}};
  EXPECT_EQ(planned(instance_of(5, 2, swap, bay)).status, LacamStatus::kSolved);
}

TEST(CompletePlanner, AGoalBehindAWallIsUnreachable) {
  const Instance instance = instance_of(3, 1, {{{0, 0}, {2, 0}}}, {{1, 0}});
  EXPECT_EQ(planned(instance).status, LacamStatus::kUnsolvable);
}

TEST(CompletePlanner, LimitsEndTheSearch) {
  PlannerOptions options;
  options.max_expansions = 1;
  const Instance instance = instance_of(5, 1, {{{0, 0}, {4, 0}}});
  EXPECT_EQ(plan_complete(instance, options).status, LacamStatus::kLimit);
}

TEST(CompletePlanner, FollowsAroundACornerInContact) {
  // The second robot may arrive sqrt(2) after the first has left at a right angle.
  const Instance instance = instance_of(2, 3, {{{0, 1}, {1, 1}}, {{0, 0}, {0, 2}}}, {{1, 0}, {1, 2}});
  const CompleteResult result = planned(instance);
  EXPECT_DOUBLE_EQ(result.solution.trajectories.at(1).arrival_s(), 1 + std::sqrt(2.0));
}

TEST(CompletePlanner, ADifferentSpeedScalesAllTimes) {
  Instance instance = instance_of(2, 3, {{{0, 1}, {1, 1}}, {{0, 0}, {0, 2}}}, {{1, 0}, {1, 2}});
  for (Agent& agent : instance.agents) agent.speed_cells_per_s = 4;
  EXPECT_DOUBLE_EQ(planned(instance).solution.trajectories.at(1).arrival_s(), (1 + std::sqrt(2.0)) / 4);
}

TEST(CompletePlanner, TheOrderPutsThoseFirstWhoseStartsAreCrossed) {
  // The second robot follows the first over its start.
  const Instance instance = instance_of(4, 1, {{{1, 0}, {3, 0}}, {{0, 0}, {2, 0}}});
  const CompleteResult result = planned(instance, 5);
  EXPECT_EQ(result.order, (std::vector<AgentIndex>{0, 1}));
  EXPECT_EQ(result.ssi_kept_s, 5);
}

TEST(CompletePlanner, AGuaranteeThatNoOrderKeepsEndsWithTheCrossingThatBreaksIt) {
  // Three of four cells: each robot ends on the start of the next.
  const Paths ring = {{{0, 0}, {1, 0}}, {{1, 0}, {1, 1}}, {{1, 1}, {0, 0}}};
  const CompleteResult result = planned(instance_of(2, 2, ring), 60);
  ASSERT_EQ(result.status, LacamStatus::kSolved);
  EXPECT_LT(result.ssi_kept_s, 60);
  EXPECT_GE(result.ssi_kept_s, 0);
}

TEST(CompletePlanner, RefusesWhatIsBeyondItsModel) {
  Instance instance = instance_of(4, 4, {{{0, 0}, {1, 0}}, {{2, 2}, {3, 3}}});
  EXPECT_FALSE(find_beyond_complete(instance));
  instance.agents[1].radius_cells = 0.25;
  EXPECT_FALSE(find_beyond_complete(instance));
  instance.agents[1].id = "b";
  instance.agents[1].radius_cells = 0.75;
  ASSERT_TRUE(find_beyond_complete(instance));
  EXPECT_EQ(find_beyond_complete(instance)->what, "agent b: radius 0.75");
  EXPECT_EQ(find_beyond_complete(instance)->expected, "at most 0.5 for LaCAM");
  instance.agents[1].radius_cells = 0.5;
  instance.agents[1].speed_cells_per_s = 2;
  EXPECT_EQ(find_beyond_complete(instance)->what, "agent b: speed 2");
  EXPECT_EQ(find_beyond_complete(instance)->expected, "the speed of agent 0, 1, for LaCAM");
  instance.agents[1].speed_cells_per_s = 1;
  instance.obstacles.push_back({"o", 0.5, Trajectory{{1, 3}, {}}});
  EXPECT_EQ(find_beyond_complete(instance)->what, "the instance has dynamic obstacles");
}

TEST(ExactTime, ComparesAsTheNumbersThatItStandsFor) {
  for (int a = -30; a <= 30; ++a) {
    for (int b = -30; b <= 30; ++b) {
      const long double value = a + b * std::sqrt(2.0L);
      EXPECT_EQ((ExactTime{0, 0} < ExactTime{a, b}), value > 0) << a << " + " << b << " sqrt(2)";
      EXPECT_EQ((ExactTime{a, b} < ExactTime{0, 0}), value < 0) << a << " + " << b << " sqrt(2)";
    }
  }
  // Pell: 665857^2 - 2 * 470832^2 = 1, closer than a float could tell.
  EXPECT_TRUE((ExactTime{0, 470832} < ExactTime{665857, 0}));
  EXPECT_FALSE((ExactTime{665857, 0} < ExactTime{0, 470832}));
}

/// The least distance of two robots on unit moves out of a cell and into it, the second one
/// `lag` after the first: by many samples.
double least_distance(Cell left, Cell entered, double lag) {
  constexpr int kSamples = 20'000;
  double least = 10;
  for (int i = 0; i <= kSamples; ++i) {
    const double t = (lag + 1) * i / kSamples;
    const double out = std::min(t, 1.0);
    const double in = std::min(std::max(t - (lag - 1), 0.0), 1.0) - 1;
    least = std::min(least, std::hypot(out * left.x - in * entered.x, out * left.y - in * entered.y));
  }
  return least;
}

TEST(FollowLag, KeepsRobotsOneCellApartAndNoFarther) {
  const std::vector<Cell> directions = {{1, 0}, {0, 1}, {-1, 0}, {0, -1}};
  for (const Cell left : directions) {
    for (const Cell entered : directions) {
      const double lag = follow_lag(left, entered).seconds(1);
      if (left.x == -entered.x && left.y == -entered.y) {
        EXPECT_EQ(lag, 2);  // the follower comes from where the leader goes
        continue;
      }
      EXPECT_NEAR(least_distance(left, entered, lag), 1, 1e-6);
      EXPECT_LT(least_distance(left, entered, lag - 0.01), 0.9999);
    }
  }
}

}  // namespace
}  // namespace sipplab
