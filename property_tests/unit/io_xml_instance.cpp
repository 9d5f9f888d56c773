// AA-SIPP(m)'s XML and the older one of the archive, from memory.
#include "planner/io/xml_instance.hpp"

#include <gtest/gtest.h>

#include <limits>

namespace sipplab {
namespace {

constexpr const char* kAgents = R"(<agents number="1">
<agent id="0" start.x="0" start.y="0" goal.x="1" goal.y="0"/>
</agents>
)";

/// A document whose first line is <root>.
std::string in_root(const std::string& content) { return "<root>\n" + content + "</root>\n"; }

std::string error_of(const std::string& text) {
  const Input<InstanceParts> parts = parse_xml_instance(text, "f");
  return parts ? "no error" : parts.error().message();
}

/// For <agents> with this one agent, which stands on line 3.
std::string agent_error(const std::string& agent) {
  return error_of(in_root("<agents>\n" + agent + "\n</agents>\n"));
}

std::string xml_map_error(const std::string& grid) {
  return error_of(in_root("<map>\n" + grid + "\n</map>\n"));
}

TEST(IoXmlInstance, DefaultsAreThoseOfThePublishedPlanner) {
  const Input<InstanceParts> parts = parse_xml_instance(in_root(kAgents), "f");
  ASSERT_TRUE(parts) << parts.error().message();
  const Agent& agent = parts->agents->items.at(0);
  EXPECT_EQ(agent.radius_cells, 0.5);
  EXPECT_EQ(agent.speed_cells_per_s, 1);
  EXPECT_EQ(agent.rotation_speed, 1);
  EXPECT_EQ(agent.start_heading_deg, 0);
  EXPECT_FALSE(agent.goal_heading_deg);
  EXPECT_EQ(parts->agents->lines, std::vector<int>{3});
  EXPECT_FALSE(parts->map);
  EXPECT_FALSE(parts->options);
  EXPECT_TRUE(parts->warnings.empty());
}

TEST(IoXmlInstance, NotWellFormedTextNamesTheLine) {
  EXPECT_EQ(error_of("").substr(0, 5), "f:1: ");
  EXPECT_EQ(error_of("<root>\n<agents>\n"),
            "f:2: not well-formed XML: start-end tags mismatch, expected a complete document");
  EXPECT_EQ(error_of("<root>\n<agents number=\"1\n").substr(0, 28), "f:2: not well-formed XML: er");
  EXPECT_EQ(error_of("<root></root>\ngarbage"),
            "f:2: text 'garbage' outside of the root element, expected none");
  EXPECT_EQ(error_of("<root></root>\n<root/>"), "f:2: a second root element <root>, expected one");
  EXPECT_EQ(error_of("<rot/>"), "f:1: root element <rot>, expected <root>");
  EXPECT_EQ(error_of("<!-- nothing -->"), "f:1: no element, expected <root>");
  EXPECT_EQ(error_of(std::string("<root>\n\0</root>", 15)), "f:2: a zero byte, expected XML as UTF-8 text");
}

TEST(IoXmlInstance, AByteOrderMarkIsPassedOver) {
  EXPECT_TRUE(parse_xml_instance("\xef\xbb\xbf" + in_root(kAgents), "f"));
}

TEST(IoXmlInstance, BadAgentsNameTheirLine) {
  const std::string places = "start.x=\"0\" start.y=\"0\" goal.x=\"1\" goal.y=\"0\"";
  EXPECT_EQ(agent_error("<agent start.y=\"0\" goal.x=\"1\" goal.y=\"0\"/>"),
            "f:3: no start.x in <agent>, expected an integer");
  EXPECT_EQ(agent_error("<agent start.x=\"0.5\" start.y=\"0\" goal.x=\"1\" goal.y=\"0\"/>"),
            "f:3: start.x '0.5' in <agent>, expected an integer");
  EXPECT_EQ(agent_error("<agent start.x=\"9999999999\" start.y=\"0\" goal.x=\"1\" goal.y=\"0\"/>"),
            "f:3: start.x '9999999999' in <agent>, expected an integer between -2147483648 and 2147483647");
  for (const char* size : {"-1", "0", "nan", "inf", "65", "", "0.5x"}) {
    EXPECT_EQ(agent_error("<agent " + places + " size=\"" + size + "\"/>"),
              "f:3: size '" + std::string(size) + "' in <agent>, expected a radius in cells, 0.001 to 64");
  }
  EXPECT_EQ(agent_error("<agent " + places + " movespeed=\"0\"/>"),
            "f:3: movespeed '0' in <agent>, expected a speed in cells per second, 0.001 to 1000");
  EXPECT_EQ(agent_error("<agent " + places + " rotationspeed=\"-2\"/>"),
            "f:3: rotationspeed '-2' in <agent>, expected half turns per second, 0.001 to 1000");
  EXPECT_EQ(agent_error("<agent " + places + " start.heading=\"400\"/>"),
            "f:3: start.heading '400' in <agent>, expected degrees from 0 to 360");
  EXPECT_EQ(agent_error("<agent " + places + " goal.heading=\"north\"/>"),
            "f:3: goal.heading 'north' in <agent>, expected degrees from 0 to 360");
  EXPECT_EQ(agent_error("<agent " + places + " id=\"\xff\"/>"),
            "f:3: id '?' in <agent>, expected UTF-8 text");
  EXPECT_EQ(agent_error("<defaultparameters size=\"NaN\"/>"),
            "f:3: size 'NaN' in <defaultparameters>, expected a radius in cells, 0.001 to 64");
}

TEST(IoXmlInstance, HeadingsWrapAndMayBeOpen) {
  const std::string places = "start.x=\"0\" start.y=\"0\" goal.x=\"1\" goal.y=\"0\"";
  const Input<InstanceParts> parts =
      parse_xml_instance(in_root("<agents><defaultparameters goal.heading=\"90\"/><agent " + places +
                                 " start.heading=\"360\" goal.heading=\"360\"/><agent " + places +
                                 " goal.heading=\"-1\"/><agent " + places + "/></agents>"),
                         "f");
  ASSERT_TRUE(parts) << parts.error().message();
  EXPECT_EQ(parts->agents->items[0].start_heading_deg, 0);
  EXPECT_EQ(parts->agents->items[0].goal_heading_deg, 0);
  EXPECT_FALSE(parts->agents->items[1].goal_heading_deg);
  EXPECT_EQ(parts->agents->items[2].goal_heading_deg, 90);
}

TEST(IoXmlInstance, CountsMustAgree) {
  EXPECT_EQ(error_of(in_root("\n<agents number=\"2\">\n<agent start.x=\"0\" start.y=\"0\" goal.x=\"1\" "
                             "goal.y=\"0\"/></agents>\n")),
            "f:3: number '2' in <agents> that holds 1 <agent>, expected the two to be equal");
  EXPECT_EQ(error_of(in_root("<agents number=\"-1\"/>")),
            "f:2: number '-1' in <agents> that holds 0 <agent>, expected the two to be equal");
  EXPECT_EQ(error_of(in_root("<agents number=\"0\"/>")), "no error");
}

TEST(IoXmlInstance, BadMapsNameTheirLine) {
  EXPECT_EQ(xml_map_error(""), "f:2: no <grid> in <map>, expected one");
  EXPECT_EQ(xml_map_error("<grid width=\"2\"><row>0 0</row></grid>"),
            "f:3: no height in <grid>, expected an integer");
  EXPECT_EQ(xml_map_error("<grid width=\"-2\" height=\"1\"/>"),
            "f:3: map of -2 x 1 cells, expected 1 to 8192 along each side");
  EXPECT_EQ(xml_map_error("<grid width=\"1000000000\" height=\"1000000000\"/>"),
            "f:3: map of 1000000000 x 1000000000 cells, expected 1 to 8192 along each side");
  EXPECT_EQ(xml_map_error("<grid width=\"nan\" height=\"1\"/>"),
            "f:3: width 'nan' in <grid>, expected an integer");
  EXPECT_EQ(xml_map_error("<grid width=\"2\" height=\"2\">\n<row>0 0</row></grid>"),
            "f:3: 1 rows, expected 2");
  EXPECT_EQ(xml_map_error("<grid width=\"2\" height=\"1\">\n<row>0 0 0</row></grid>"),
            "f:4: row 0 has 3 cells, expected 2 cells");
  EXPECT_EQ(xml_map_error("<grid width=\"2\" height=\"1\">\n<row>0</row></grid>"),
            "f:4: row 0 has 1 cells, expected 2 cells");
  EXPECT_EQ(xml_map_error("<grid width=\"2\" height=\"2\">\n<row>0 0</row>\n<row/></grid>"),
            "f:5: row 1 has no text, expected 2 cells");
  EXPECT_EQ(xml_map_error("<grid width=\"2\" height=\"1\">\n<row>0 *</row></grid>"),
            "f:4: cell '*' in row 0, expected 0 where free, another integer where blocked");
  EXPECT_EQ(xml_map_error("<grid width=\"1\" height=\"1\"><row>0</row></grid>\n<grid/>"),
            "f:4: a second <grid> in <map>, expected one");
}

TEST(IoXmlInstance, UnknownTagsAndAttributesAreRefused) {
  const auto complaint = [](const std::string& text) {
    const Input<InstanceParts> parts = parse_xml_instance(in_root(text), "f");
    return parts ? "none" : parts.error().message();
  };
  EXPECT_EQ(complaint("<agents nubmer=\"0\"></agents>"),
            "f:2: unknown attribute 'nubmer' in <agents>, expected only number");
  EXPECT_EQ(complaint("<agents>\n<default_parameters size=\"0.3\"/></agents>"),
            "f:3: unknown tag <default_parameters> in <agents>, expected only defaultparameters, agent");
  EXPECT_EQ(complaint("<agents>\n<agent id=\"0\" start.x=\"0\" start.y=\"0\" goal.x=\"1\" goal.y=\"0\">\n"
                      "<vertex/></agent></agents>"),
            "f:4: unknown tag <vertex> in <agent>, expected none");
  EXPECT_EQ(complaint("stray").substr(0, 47), "f:1: text 'stray' in <root>, expected only agen");
}

TEST(IoXmlInstance, AFloodOfWarningsIsCounted) {
  std::string tags;
  for (int i = 0; i < 50; ++i) tags += "<x/>\n";
  const Input<InstanceParts> parts = parse_xml_instance(in_root("<options>" + tags + "</options>"), "f");
  ASSERT_TRUE(parts);
  ASSERT_EQ(parts->warnings.size(), 21u);
  EXPECT_EQ(parts->warnings.back(), "f: 30 more warnings of this kind");
}

TEST(IoXmlInstance, OptionsKeepRealNumbers) {
  const Input<InstanceParts> parts = parse_xml_instance(
      in_root("<algorithm><startsafeinterval> 2.5 </startsafeinterval><timelimit>0.25</timelimit>"
              "<rescheduling>no</rescheduling><prioritization>shortest_first</prioritization></algorithm>"),
      "f");
  ASSERT_TRUE(parts) << parts.error().message();
  PlannerOptions before;
  before.any_angle = false;
  const PlannerOptions options = parts->options->options.applied_to(before);
  EXPECT_EQ(options.ssi_s, 2.5);
  EXPECT_EQ(options.time_limit_s, 0.25);
  EXPECT_EQ(options.rescheduling, Rescheduling::kNone);
  EXPECT_EQ(options.order, InitialOrder::kShortestFirst);
  EXPECT_FALSE(options.any_angle);
}

TEST(IoXmlInstance, InfinityHasItsWords) {
  const Input<InstanceParts> parts = parse_xml_instance(
      in_root(
          "<algorithm><startsafeinterval>infinity</startsafeinterval><timelimit>-1</timelimit></algorithm>"),
      "f");
  ASSERT_TRUE(parts);
  const PlannerOptions options = parts->options->options.applied_to({});
  EXPECT_EQ(options.ssi_s, kInfiniteSsi);
  EXPECT_EQ(options.time_limit_s, std::numeric_limits<double>::infinity());
}

TEST(IoXmlInstance, BadOptionsNameTheirLine) {
  const auto option_error = [](const std::string& tag, const std::string& value) {
    return error_of(in_root("<algorithm>\n<" + tag + ">" + value + "</" + tag + "></algorithm>"));
  };
  EXPECT_EQ(option_error("allowanyangle", "maybe"), "f:3: <allowanyangle> 'maybe', expected true or false");
  EXPECT_EQ(option_error("connectedness", "6"), "f:3: <connectedness> '6', expected 2, 3, 4 or 5");
  EXPECT_EQ(option_error("connectedness", "2.5"), "f:3: <connectedness> '2.5', expected 2, 3, 4 or 5");
  EXPECT_EQ(option_error("weight", "0.5"), "f:3: <weight> '0.5', expected a number from 1 to 100");
  EXPECT_EQ(option_error("startsafeinterval", "-1"),
            "f:3: <startsafeinterval> '-1', expected seconds from 0 to 1e+07, or inf");
  EXPECT_EQ(option_error("timelimit", "0"), "f:3: <timelimit> '0', expected a number of seconds > 0, or inf");
  EXPECT_EQ(option_error("waitbeforemove", "101"),
            "f:3: <waitbeforemove> '101', expected seconds from 0 to 100");
  EXPECT_EQ(option_error("rescheduling", "rules"),
            "f:3: <rescheduling> 'rules', expected none, deterministic, random or ejection");
  EXPECT_EQ(option_error("prioritization", ""),
            "f:3: <prioritization> '', expected fifo, shortest, longest or random");
  EXPECT_EQ(option_error("method", "greedy"), "f:3: <method> 'greedy', expected prioritized or complete");
}

TEST(IoXmlInstance, BadObstaclesNameTheirLine) {
  const auto obstacle_error = [](const std::string& sections) {
    return error_of(
        in_root("<dynamicobstacles>\n<obstacle>\n" + sections + "</obstacle></dynamicobstacles>"));
  };
  const std::string first =
      "<section start.x=\"0\" start.y=\"0\" goal.x=\"1\" goal.y=\"0\" duration=\"1\"/>\n";
  EXPECT_EQ(obstacle_error(""), "f:3: an <obstacle> without <section>, expected at least one");
  EXPECT_EQ(obstacle_error(first +
                           "<section start.x=\"0\" start.y=\"0\" goal.x=\"1\" goal.y=\"0\" duration=\"1\"/>"),
            "f:5: a <section> that begins at (0, 0), expected the end of the one before, (1, 0)");
  EXPECT_EQ(
      obstacle_error("<section start.x=\"0\" start.y=\"0\" goal.x=\"1\" goal.y=\"0\" duration=\"-1\"/>"),
      "f:4: duration '-1' in <section>, expected seconds from 0");
  EXPECT_EQ(obstacle_error("<section start.x=\"0\" start.y=\"0\" goal.x=\"1\" goal.y=\"0\" duration=\"0\"/>"),
            "f:4: a <section> that changes place in no time, expected a duration above 0");
  EXPECT_EQ(obstacle_error("<section start.x=\"0\" start.y=\"0\" goal.x=\"1\" goal.y=\"0\"/>"),
            "f:4: no duration in <section>, expected seconds from 0");
  EXPECT_EQ(obstacle_error("<section start.x=\"0\" start.y=\"0\" goal.x=\"1\" goal.y=\"0\" duration=\"1\" "
                           "start.heading=\"east\"/>"),
            "f:4: start.heading 'east' in <section>, expected a number");
  const std::string exact = "<section start.x=\"0\" start.y=\"0\" goal.x=\"0\" goal.y=\"0\" duration=\"1\" ";
  EXPECT_EQ(obstacle_error(exact + "begin=\"1\" end=\"2\"/>"),
            "f:4: a <section> from 1 to 2 s, expected one that follows the section before, from 0 s on");
  EXPECT_EQ(obstacle_error(exact + "begin=\"0\" end=\"-1\"/>"),
            "f:4: end '-1' in <section>, expected seconds from 0");
}

TEST(IoXmlInstance, OlderDialectPairsTheLists) {
  const std::string head = "<map>\n<width>2</width>\n<height>1</height>\n";
  const std::string tail = "<grid><row>0 0</row></grid></map>";
  const Input<InstanceParts> parts = parse_xml_instance(
      in_root(head +
              "<agents>2</agents><startx>0</startx>\n<startx>1</startx><starty>0</starty><starty>0</starty>"
              "<finishx>1</finishx><finishx>0</finishx><finishy>0</finishy><finishy>0</finishy>" +
              tail),
      "f");
  ASSERT_TRUE(parts) << parts.error().message();
  EXPECT_EQ(parts->agents->items[1].start, (Cell{1, 0}));
  EXPECT_EQ(parts->agents->items[1].goal, (Cell{0, 0}));
  EXPECT_EQ(parts->agents->lines, (std::vector<int>{5, 6}));
  EXPECT_EQ(parts->map->map.width(), 2);

  EXPECT_EQ(error_of(in_root(head + "<agents>2</agents><startx>0</startx>" + tail)),
            "f:5: 1 <startx> for 2 agents, expected one for each agent");
  EXPECT_EQ(error_of(in_root(
                head + "<agents>1</agents><startx>0</startx><starty>0</starty><finishx>1</finishx>" + tail)),
            "f:5: 0 <finishy> for 1 agents, expected one for each agent");
  EXPECT_EQ(error_of(in_root(head + "<agents>1</agents>\n<startx>x</startx>" + tail)),
            "f:6: <startx> 'x', expected an integer");
  EXPECT_EQ(error_of(in_root("<agents/>\n" + head + "<agents>0</agents>" + tail)),
            "f:2: <agents> besides those in <map>, expected one of the two");
}

}  // namespace
}  // namespace sipplab
