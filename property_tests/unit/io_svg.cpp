// The picture of a solution: well-formed, complete, and bounded however much is drawn.
#include "sipplab/svg.hpp"

#include <gtest/gtest.h>

#include <limits>
#include <pugixml.hpp>

namespace sipplab {
namespace {

Instance small_instance() {
  Instance instance;
  instance.map = GridMap(6, 4);
  instance.map.set_blocked({2, 1}, true);
  instance.map.set_blocked({3, 1}, true);
  instance.agents = {{"<a> & \"b\"\n\x01", {0, 0}, {5, 0}, 0.5, 1, 0, std::nullopt, 1},
                     {"1", {5, 3}, {0, 3}, 0.25, 1, 0, std::nullopt, 1}};
  instance.obstacles = {{"cart", 0.3, {{4, 2}, {{0, 2, {4, 2}, {4, 3}}}}}};
  return instance;
}

Solution straight_solution(const Instance& instance) {
  Solution solution;
  for (const Agent& agent : instance.agents) {
    solution.trajectories.push_back(
        {agent.start,
         {{0, distance(agent.start, agent.goal) / agent.speed_cells_per_s, agent.start, agent.goal}}});
  }
  return solution;
}

std::size_t count(const std::string& text, const std::string& part) {
  std::size_t found = 0;
  for (std::size_t at = text.find(part); at != std::string::npos; at = text.find(part, at + 1)) ++found;
  return found;
}

bool is_well_formed(const std::string& svg) {
  pugi::xml_document document;
  return document.load_buffer(svg.data(), svg.size()) &&
         std::string(document.document_element().name()) == "svg";
}

TEST(IoSvg, ShowsEveryRobotWithATooltip) {
  const Instance instance = small_instance();
  const std::string svg = draw_svg(instance, straight_solution(instance), {}, {"A <title>", "below"});
  EXPECT_TRUE(is_well_formed(svg));
  EXPECT_EQ(count(svg, "<polyline stroke=\"#"), 2u);
  EXPECT_NE(svg.find("<title id=\"title\">A &lt;title&gt;</title>"), std::string::npos);
  EXPECT_NE(svg.find("robot 1: (5, 3) to (0, 3), radius 0.25, arrives at 5 s"), std::string::npos);
  EXPECT_NE(svg.find("moving obstacle cart"), std::string::npos);
  EXPECT_NE(svg.find("aria-labelledby"), std::string::npos);
  EXPECT_EQ(svg.find('\x01'), std::string::npos);
  EXPECT_EQ(count(svg, "violation"), 0u);
  // One path for all blocked cells, one run for the two in a row.
  EXPECT_NE(svg.find("d=\"M2 1h2v1h-2z\""), std::string::npos);
}

TEST(IoSvg, ASolutionThatIsAnimatedMovesByTheClock) {
  const Instance instance = small_instance();
  Solution solution = straight_solution(instance);
  solution.trajectories[1] = {{5, 3}, {{2, 4, {5, 3}, {3, 3}}, {5, 8, {3, 3}, {0, 3}}}};
  SvgOptions options;
  EXPECT_EQ(draw_svg(instance, solution, {}, options).find("<animate"), std::string::npos);
  options.animation_speed = 2;
  const std::string svg = draw_svg(instance, solution, {}, options);
  EXPECT_TRUE(is_well_formed(svg));
  EXPECT_EQ(count(svg, "<animateTransform "), 3u) << "two robots and an obstacle";
  // 8 s at twice the speed and 1.5 s of rest: 5.5 s a round, which is 11 s of the plan.
  EXPECT_EQ(count(svg, " dur=\"5.5s\" repeatCount=\"indefinite\""), 4u) << "and the bar of progress";
  EXPECT_NE(
      svg.find("keyTimes=\"0;0.181818;0.363636;0.454545;0.727273;1\" values=\"5 3;5 3;3 3;3 3;0 3;0 3\""),
      std::string::npos);

  solution.trajectories[0].motions[0].end_s = -1;
  EXPECT_EQ(draw_svg(instance, solution, {}, options).find("<animate"), std::string::npos)
      << "time runs backwards";
  EXPECT_EQ(draw_svg(instance, {}, {}, options).find("<animate"), std::string::npos)
      << "there is no solution";
}

TEST(IoSvg, ViolationsAreMarkedWithBothBodiesAndListed) {
  const Instance instance = small_instance();
  ValidationReport report;
  Violation violation;
  violation.kind = ViolationKind::kAgentCollision;
  violation.agent = 0;
  violation.other = 1;
  violation.time_s = 2.5;
  violation.depth_cells = 0.125;
  violation.message = "robots 0 and 1 overlap by 0.125 cells at 2.5 s";
  report.violations.push_back(violation);
  const std::string svg = draw_svg(instance, straight_solution(instance), report, {});
  EXPECT_TRUE(is_well_formed(svg));
  EXPECT_NE(svg.find("<circle cx=\"2.5\" cy=\"0\" r=\"0.5\" stroke=\"#d4142a\""), std::string::npos);
  EXPECT_NE(svg.find("<circle cx=\"2.5\" cy=\"3\" r=\"0.25\" stroke=\"#d4142a\""), std::string::npos);
  EXPECT_NE(svg.find("and 1, depth 0.125</text>"), std::string::npos);
  EXPECT_NE(svg.find("1: robots 0 and 1 overlap by 0.125 cells at 2.5 s"), std::string::npos);

  report.violations.assign(1000, violation);
  const std::string many = draw_svg(instance, straight_solution(instance), report, {});
  EXPECT_NE(many.find("and 988 more"), std::string::npos);
  EXPECT_LT(many.size(), 200'000u);
}

TEST(IoSvg, NonsenseInAReportIsNotDrawn) {
  const Instance instance = small_instance();
  ValidationReport report;
  for (const ViolationKind kind : {ViolationKind::kAgentCollision, ViolationKind::kObstacleCollision,
                                   ViolationKind::kStartSafeInterval, ViolationKind::kNotFinite}) {
    Violation violation;
    violation.kind = kind;
    violation.agent = 7;
    violation.other = 9;
    violation.time_s = std::numeric_limits<double>::quiet_NaN();
    report.violations.push_back(violation);
    violation.agent = 0;
    report.violations.push_back(violation);
  }
  const std::string svg = draw_svg(instance, {}, report, {});
  EXPECT_TRUE(is_well_formed(svg));
  EXPECT_EQ(svg.find("nan"), std::string::npos);
}

TEST(IoSvg, WithoutSolutionOrRobotsThereIsStillAMap) {
  EXPECT_TRUE(is_well_formed(draw_svg(small_instance(), {}, {}, {})));
  EXPECT_NE(draw_svg(small_instance(), {}, {}, {}).find("2 robots on a map of 6 x 4 cells, no solution"),
            std::string::npos);
  EXPECT_TRUE(is_well_formed(draw_svg(Instance{}, {}, {}, {})));
}

TEST(IoSvg, TenThousandRobotsStaySmall) {
  Instance instance;
  instance.map = GridMap(200, 100);
  for (std::int32_t i = 0; i < 10'000; ++i) {
    Agent agent;
    agent.id = std::to_string(i);
    agent.start = {i % 100, i / 100};
    agent.goal = {199 - i % 100, i / 100};
    instance.agents.push_back(agent);
  }
  const std::string svg = draw_svg(instance, straight_solution(instance), {}, {});
  EXPECT_LT(svg.size(), 10'000u * 500u);
  EXPECT_EQ(count(svg, "text-anchor"), 0u) << "no ids that are too small to read";
}

}  // namespace
}  // namespace sipplab
