// The rules of an instance, one planted mistake after another, and its name.
#include "sipplab/instance.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>

#include "planner/core/random.hpp"
#include "planner/io/case_codec.hpp"
#include "property_tests/support/extremes.hpp"

namespace sipplab {
namespace {

Instance instance_of(const char* text) {
  const auto plan_case = decode_case(text);
  EXPECT_TRUE(plan_case) << text;
  return plan_case ? plan_case->instance : Instance{};
}

std::string error_of(const Instance& instance) {
  const auto error = find_error(instance);
  return error ? error->what + ", expected " + error->expected : "";
}

Instance two_robots() { return instance_of("...\n.@.\n...\nrobot 0 0 to 2 0\nrobot 1 0 to 0 2\n"); }

TEST(FindError, AcceptsAnInstanceWithoutRobots) { EXPECT_EQ(error_of(Instance{}), ""); }

TEST(FindError, AcceptsTouchingStartsAndBodiesThatTouchTheMap) { EXPECT_EQ(error_of(two_robots()), ""); }

struct Mistake {
  const char* name;
  std::function<void(Agent&)> make;
  const char* error;
};

TEST(FindError, NamesEachMistakeInAnAgent) {
  const Mistake mistakes[] = {
      {"radius NaN", [](Agent& a) { a.radius_cells = kNan; },
       "agent 1: radius nan, expected a number from 0.001 to 64"},
      {"radius 0", [](Agent& a) { a.radius_cells = 0; },
       "agent 1: radius 0, expected a number from 0.001 to 64"},
      {"radius negative", [](Agent& a) { a.radius_cells = -0.5; },
       "agent 1: radius -0.5, expected a number from 0.001 to 64"},
      {"radius huge", [](Agent& a) { a.radius_cells = 65; },
       "agent 1: radius 65, expected a number from 0.001 to 64"},
      {"speed 0", [](Agent& a) { a.speed_cells_per_s = 0; },
       "agent 1: speed 0, expected a number from 0.001 to 1000"},
      {"speed infinite", [](Agent& a) { a.speed_cells_per_s = kInfinity; },
       "agent 1: speed inf, expected a number from 0.001 to 1000"},
      {"rotation speed 0", [](Agent& a) { a.rotation_speed = 0; },
       "agent 1: rotation speed 0, expected a number from 0.001 to 1000"},
      {"start heading 360", [](Agent& a) { a.start_heading_deg = 360; },
       "agent 1: start heading 360, expected a number from 0 to less than 360"},
      {"goal heading NaN", [](Agent& a) { a.goal_heading_deg = kNan; },
       "agent 1: goal heading nan, expected a number from 0 to less than 360"},
      {"start outside",
       [](Agent& a) {
         a.start = {3, 0};
       },
       "agent 1: start (3, 0) is outside the grid, expected a cell of the 3 x 3 grid"},
      {"start far outside",
       [](Agent& a) {
         a.start = {-2147483647 - 1, 2147483647};
       },
       "agent 1: start (-2147483648, 2147483647) is outside the grid, expected a cell of the 3 x 3 grid"},
      {"goal outside",
       [](Agent& a) {
         a.goal = {0, -1};
       },
       "agent 1: goal (0, -1) is outside the grid, expected a cell of the 3 x 3 grid"},
      {"start blocked",
       [](Agent& a) {
         a.start = {1, 1};
       },
       "agent 1: start (1, 1) is blocked, expected a free cell"},
      {"goal blocked",
       [](Agent& a) {
         a.goal = {1, 1};
       },
       "agent 1: goal (1, 1) is blocked, expected a free cell"},
      {"too wide for the grid", [](Agent& a) { a.radius_cells = 0.75; },
       "agent 1: body of radius 0.75 at start (1, 0) leaves the grid, expected a body inside the grid"},
      {"start on a start",
       [](Agent& a) {
         a.start = {0, 0};
       },
       "agent 1: start (0, 0) overlaps the start of agent 0, expected starts that at most touch"},
      {"goal on a goal",
       [](Agent& a) {
         a.goal = {2, 0};
       },
       "agent 1: goal (2, 0) overlaps the goal of agent 0, expected goals that at most touch"},
  };
  for (const Mistake& mistake : mistakes) {
    Instance instance = two_robots();
    mistake.make(instance.agents[1]);
    EXPECT_EQ(error_of(instance), mistake.error) << mistake.name;
    ASSERT_TRUE(find_error(instance)) << mistake.name;
    EXPECT_EQ(find_error(instance)->agent, AgentIndex{1}) << mistake.name;
  }
}

TEST(FindError, ReportsAgentsInInputOrder) {
  Instance instance = two_robots();
  instance.agents[0].goal = {1, 1};
  instance.agents[1].radius_cells = kNan;
  EXPECT_EQ(find_error(instance)->agent, AgentIndex{0});
}

TEST(FindError, MeasuresBodiesAgainstBlockedCellsExactly) {
  // The corner of the blocked cell is sqrt(0.5) away from (1, 1).
  Instance instance = instance_of("....\n....\n..@.\n....\nrobot 1 1 to 1 1\n");
  Agent& agent = instance.agents[0];
  agent.radius_cells = std::sqrt(0.5);
  EXPECT_EQ(error_of(instance), "");
  agent.radius_cells = std::sqrt(0.5) + 1e-8;
  EXPECT_NE(error_of(instance), "");
}

TEST(FindError, TakesOverlapWithinRoundingAsTouching) {
  Instance instance = instance_of(".....\n.....\n.....\nrobot 1 1 to 1 1\nrobot 2 1 to 3 1 radius 0.5\n");
  instance.agents[1].radius_cells = 0.5 + 5e-10;
  EXPECT_EQ(error_of(instance), "");
  instance.agents[1].radius_cells = 0.5 + 2e-9;
  EXPECT_NE(error_of(instance), "");
}

TEST(FindError, FindsOverlapsOfLargeAndSmallBodies) {
  Instance instance;
  instance.map = GridMap(40, 40);
  Agent large;
  large.start = large.goal = {20, 20};
  large.radius_cells = 10;
  Agent small;
  small.start = {29, 20};
  small.goal = {0, 0};
  for (const auto& [first, second] : {std::pair(large, small), std::pair(small, large)}) {
    instance.agents = {first, second};
    EXPECT_NE(error_of(instance), "");
  }
  small.start = {31, 20};
  instance.agents = {large, small};
  EXPECT_EQ(error_of(instance), "");
  // (26, 28) is exactly 10 away, and 0.5 more than that is touching.
  small.start = {26, 28};
  instance.agents = {large, small};
  EXPECT_NE(error_of(instance), "");
}

TEST(FindError, NamesTheFirstOfSeveralOverlappedStarts) {
  Instance instance = instance_of(
      "......\n......\n......\n......\nrobot 2 1 to 0 0\nrobot 3 2 to 0 1\nrobot 3 1 to 4 1 radius 1.25\n");
  EXPECT_EQ(error_of(instance),
            "agent 2: start (3, 1) overlaps the start of agent 0, expected starts that at most touch");
}

TEST(FindError, AgreesWithAllPairsOnRandomStarts) {
  Random random(7);
  int wrong_pairs = 0;
  for (int round = 0; round < 300; ++round) {
    Instance instance;
    instance.map = GridMap(80, 80);
    for (int i = 0; i < 12; ++i) {
      Agent agent;
      agent.radius_cells = 0.25 * static_cast<double>(1 + random.below(28));
      agent.start = {static_cast<std::int32_t>(10 + random.below(60)),
                     static_cast<std::int32_t>(10 + random.below(60))};
      agent.goal = agent.start;
      instance.agents.push_back(agent);
    }
    std::optional<AgentIndex> expected;
    for (AgentIndex i = 0; i < instance.agents.size() && !expected; ++i) {
      for (AgentIndex j = 0; j < i; ++j) {
        const Agent& a = instance.agents[i];
        const Agent& b = instance.agents[j];
        if (distance(a.start, b.start) < a.radius_cells + b.radius_cells) expected = i;
      }
    }
    const auto error = find_error(instance);
    ASSERT_EQ(error.has_value(), expected.has_value());
    if (expected) {
      ++wrong_pairs;
      EXPECT_EQ(error->agent, expected);
    }
  }
  EXPECT_GT(wrong_pairs, 30);
  EXPECT_LT(wrong_pairs, 300);
}

TEST(FindError, NamesEachMistakeInAnObstacle) {
  const char* kBase = ".....\n.....\nrobot 0 0 to 1 0\n";
  const std::pair<const char*, const char*> mistakes[] = {
      {"obstacle 3 1 radius 0", "obstacle 0: radius 0, expected a number from 0.001 to 64"},
      {"obstacle 3 1 radius nan", "obstacle 0: radius nan, expected a number from 0.001 to 64"},
      {"obstacle 3 1 until 1 at 4 1 until 1 at 3 1",
       "obstacle 0: motion 1 ends at time 1, expected a time after 1 and up to 10000000"},
      {"obstacle 3 1 until nan at 4 1",
       "obstacle 0: motion 0 ends at time nan, expected a time after 0 and up to 10000000"},
      {"obstacle 3 1 until inf at 4 1",
       "obstacle 0: motion 0 ends at time inf, expected a time after 0 and up to 10000000"},
      {"obstacle 3 1 until 0.0009765625 at 4 1",
       "obstacle 0: motion 0 has speed 1024, expected at most 1000"},
      {"obstacle 0 0 until 1 at 4 1",
       "obstacle 0: stands at (0, 0) on the start of agent 0 at time 0, expected a place that no start "
       "overlaps"},
      {"obstacle 99999 0",
       "obstacle 0: position (99999, 0) is far outside the grid, expected at most 8192 cells from it"},
  };
  for (const auto& [line, error] : mistakes) {
    EXPECT_EQ(error_of(instance_of((std::string(kBase) + line).c_str())), error);
  }
  EXPECT_EQ(
      error_of(instance_of((std::string(kBase) + "obstacle -3 1 until 2 at 1 0 until 3 at 1 0").c_str())),
      "");
}

TEST(FindError, SeesGapsInAnObstaclesPath) {
  Instance instance = instance_of(".....\nrobot 0 0 to 1 0\nobstacle 3 0 until 1 at 4 0 until 2 at 3 0\n");
  ASSERT_EQ(error_of(instance), "");
  Instance place = instance;
  place.obstacles[0].trajectory.motions[1].from = {2, 0};
  EXPECT_EQ(error_of(place), "obstacle 0: motion 1 begins at (2, 0), expected (4, 0), where the obstacle is");
  Instance time = instance;
  time.obstacles[0].trajectory.motions[1].begin_s = 1.5;
  EXPECT_EQ(error_of(time), "obstacle 0: motion 1 begins at time 1.5, expected time 1");
}

TEST(ContentHash, IsThatOfEveryMachine) {
  // Pinned: a change of the encoding needs a new domain in content_hash.
  EXPECT_EQ(content_hash(two_robots()), "14d20489157294c2d00a771b5a58f04c");
}

TEST(ContentHash, SeesEveryPartButIds) {
  const Instance base = instance_of("...\n.@.\nrobot 0 0 to 2 0\nobstacle 2 1 until 2 at 2 0\n");
  const auto hash_after = [&](const std::function<void(Instance&)>& change) {
    Instance changed = base;
    change(changed);
    return content_hash(changed);
  };
  EXPECT_EQ(hash_after([](Instance& it) { it.agents[0].id = "seven"; }), content_hash(base));
  EXPECT_EQ(hash_after([](Instance& it) { it.obstacles[0].id = "seven"; }), content_hash(base));
  const std::function<void(Instance&)> changes[] = {
      [](Instance& it) {
        it.map.set_blocked({0, 1}, true);
      },
      [](Instance& it) { it.map = GridMap(2, 3); },
      [](Instance& it) {
        it.agents[0].start = {1, 0};
      },
      [](Instance& it) {
        it.agents[0].goal = {1, 0};
      },
      [](Instance& it) { it.agents[0].radius_cells = 0.4; },
      [](Instance& it) { it.agents[0].speed_cells_per_s = 2; },
      [](Instance& it) { it.agents[0].start_heading_deg = 90; },
      [](Instance& it) { it.agents[0].goal_heading_deg = 0; },
      [](Instance& it) { it.agents[0].rotation_speed = 2; },
      [](Instance& it) { it.agents.push_back(it.agents[0]); },
      [](Instance& it) { it.obstacles[0].radius_cells = 0.4; },
      [](Instance& it) { it.obstacles[0].trajectory.motions[0].end_s = 3; },
      [](Instance& it) { it.obstacles.clear(); },
  };
  for (const auto& change : changes) EXPECT_NE(hash_after(change), content_hash(base));
}

}  // namespace
}  // namespace sipplab
