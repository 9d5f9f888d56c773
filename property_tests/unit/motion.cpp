// What a search knows of robots with headings.
#include "planner/search/motion.hpp"

#include <gtest/gtest.h>

namespace sipplab {
namespace {

TEST(TurningMotion, KnowsTheEarliestArrivalWithEachHeading) {
  Agent agent;  // half a turn takes a second
  MotionRules rules;
  rules.turns = true;
  const Headings headings;
  const TurningMotion motion(agent, rules, headings);
  Arena arena;
  TurningMotion::Nodes nodes(arena);
  for (NodeId id = 0; id < 2; ++id) {
    nodes.push_back({});
    TurningMotion::lay_out(nodes[id], id, 7);
  }
  const auto reach = [&](double heading_deg, double arrival_s) {
    nodes[motion.node_for(nodes, 0, heading_deg, 7)].reach(1, 0, arrival_s);
  };
  EXPECT_EQ(motion.known_s(nodes, 0, 0), kForever);
  reach(0, 5);
  EXPECT_EQ(motion.known_s(nodes, 0, 0), 5) << "an answer holds until the next arrival";
  EXPECT_EQ(motion.known_s(nodes, 0, 90), 5.5) << "and for one heading";
  EXPECT_EQ(motion.known_s(nodes, 0, 180), 6);
  reach(180, 5.25);
  EXPECT_EQ(motion.known_s(nodes, 0, 180), 5.25);
  EXPECT_EQ(motion.known_s(nodes, 0, 0), 5);
  EXPECT_EQ(motion.known_s(nodes, 1, 0), kForever) << "and for one node";
  // Any that is early enough will do, and is not remembered for the earliest.
  reach(90, 4);
  EXPECT_EQ(motion.known_s(nodes, 0, 0, 5.5), 5);
  EXPECT_EQ(motion.known_s(nodes, 0, 0), 4.5);
}

}  // namespace
}  // namespace sipplab
