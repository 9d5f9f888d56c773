// Cases as text.
#include "planner/io/case_codec.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <string>

namespace sipplab {
namespace {

TEST(CaseCodec, ReadsEveryKindOfLine) {
  const auto plan_case = decode_case(
      "# a comment\n"
      "....\n"
      ".@..   # and another\n"
      "\n"
      "robot 0 0 to 3 1\n"
      "robot 3 0 to 0 1 speed 2 radius 0.25\r\n"
      "obstacle 2 0 radius 0.375 until 1.5 at 2 0 until 3 at -1 0\n"
      "ssi 2.5\norder random\nreschedule deterministic\nany-angle no\nconnectedness 5\nweight 1.5\nseed 7\n"
      "max-expansions 1000\nmax-restarts 20");
  ASSERT_TRUE(plan_case);
  const auto& [instance, options] = *plan_case;
  EXPECT_EQ(instance.map.width(), 4);
  EXPECT_EQ(instance.map.height(), 2);
  EXPECT_EQ(instance.map.blocked_count(), 1u);
  EXPECT_TRUE(instance.map.is_blocked({1, 1}));
  ASSERT_EQ(instance.agents.size(), 2u);
  EXPECT_EQ(instance.agents[0].goal, (Cell{3, 1}));
  EXPECT_EQ(instance.agents[0].radius_cells, 0.5);
  EXPECT_EQ(instance.agents[1].id, "1");
  EXPECT_EQ(instance.agents[1].radius_cells, 0.25);
  EXPECT_EQ(instance.agents[1].speed_cells_per_s, 2);
  ASSERT_EQ(instance.obstacles.size(), 1u);
  const Trajectory expected{{2, 0}, {{0, 1.5, {2, 0}, {2, 0}}, {1.5, 3, {2, 0}, {-1, 0}}}};
  EXPECT_EQ(instance.obstacles[0].trajectory, expected);
  EXPECT_EQ(instance.obstacles[0].radius_cells, 0.375);
  EXPECT_EQ(options.ssi_s, 2.5);
  EXPECT_EQ(options.order, InitialOrder::kRandom);
  EXPECT_EQ(options.rescheduling, Rescheduling::kDeterministic);
  EXPECT_FALSE(options.any_angle);
  EXPECT_EQ(options.connectedness, 5);
  EXPECT_EQ(options.weight, 1.5);
  EXPECT_EQ(options.seed, 7u);
  EXPECT_EQ(options.max_expansions, 1000u);
  EXPECT_EQ(options.max_restarts, 20u);
  EXPECT_TRUE(std::isinf(options.time_limit_s));
}

TEST(CaseCodec, WritesWhatAPersonWouldWrite) {
  const std::string text =
      "...\n.@.\nrobot 0 0 to 2 1 radius 0.25\nobstacle 2 0 radius 0.5 until 1.5 at 2 1\n"
      "ssi inf\norder fifo\nreschedule none\nany-angle yes\nconnectedness 3\nweight 1.125\nseed 7\n";
  const auto plan_case = decode_case(text);
  ASSERT_TRUE(plan_case);
  EXPECT_EQ(encode_case(*plan_case), text);
}

TEST(CaseCodec, RefusesWhatItDoesNotUnderstand) {
  for (const char* text : {
           "",
           "# nothing\n",
           "robot 0 0 to 0 0\n",
           "...\n..\n",
           "..x\n",
           "...\nrobot 0 0 2 0\n",
           "...\nrobot 0 0 to 2\n",
           "...\nrobot 0 0 to 2 0 radius\n",
           "...\nrobot 0 0 to 2 0 radius 0.5x\n",
           "...\nrobot 0 0 to 2 0 weight 5\n",
           "...\nrobot 0 0 to 99999999999 0\n",
           "...\nobstacle 0 0 until 1 to 2 0\n",
           "...\nssi -1\n",
           "...\nssi five\n",
           "...\nssi 5 6\n",
           "...\norder alphabetical\n",
           "...\nreschedule maybe\n",
           "...\nany-angle 2\n",
           "...\nconnectedness 6\n",
           "...\nweight 0.5\n",
           "...\nweight nan\n",
           "...\nseed -1\n",
           "...\nseed 1\n...\n",
       }) {
    EXPECT_FALSE(decode_case(text)) << text;
  }
}

TEST(CaseCodec, KeepsItsBounds) {
  const std::string widest(kMaxCaseSide, '.');
  EXPECT_TRUE(decode_case(widest));
  EXPECT_FALSE(decode_case(widest + "."));
  std::string rows;
  for (std::size_t i = 0; i < kMaxCaseSide; ++i) rows += ".\n";
  EXPECT_TRUE(decode_case(rows));
  EXPECT_FALSE(decode_case(rows + ".\n"));
  std::string robots = ".\n";
  for (std::size_t i = 0; i < kMaxCaseRobots; ++i) robots += "robot 0 0 to 0 0\n";
  EXPECT_TRUE(decode_case(robots));
  EXPECT_FALSE(decode_case(robots + "robot 0 0 to 0 0\n"));
}

}  // namespace
}  // namespace sipplab
