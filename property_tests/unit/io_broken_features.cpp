// Each feature of AA-SIPP(m)'s files, broken: one line that says where and what.
#include <gtest/gtest.h>

#include <string>

#include "planner/io/xml_instance.hpp"
#include "sipplab/instance.hpp"

namespace sipplab {
namespace {

/// A whole file in which every feature is used.
constexpr const char* kEverything =
    R"(<root>
<agents number="2">
<defaultparameters size="0.4" movespeed="0.25" rotationspeed="0.2" start.heading="180" goal.heading="90"/>
<agent id="a" start.x="0" start.y="0" goal.x="3" goal.y="1" size="0.5" start.heading="40"/>
<agent id="b" start.x="3" start.y="3" goal.x="0" goal.y="3" goal.heading="whatever" movespeed="3"/>
</agents>
<map><grid width="4" height="4">
<row>0 0 0 0</row><row>0 0 0 0</row><row>0 0 0 0</row><row>0 0 0 0</row>
</grid></map>
<algorithm>
<planforturns>true</planforturns>
<waitbeforemove>0.5</waitbeforemove>
<inflatecollisionintervals>0.25</inflatecollisionintervals>
<inflatecollisiontime>0.125</inflatecollisiontime>
<timelimit>60</timelimit>
</algorithm>
<dynamicobstacles>
<obstacle id="c" size="0.3">
<section start.x="3" start.y="0" goal.x="3" goal.y="0" duration="2"/>
<section start.x="3" start.y="0" goal.x="1" goal.y="1" duration="4"/>
</obstacle>
</dynamicobstacles>
</root>
)";

struct Break {
  const char* from;
  const char* to;
  const char* message;
};

std::string broken(const Break& change) {
  std::string text = kEverything;
  const std::size_t at = text.find(change.from);
  EXPECT_NE(at, std::string::npos) << change.from;
  return text.replace(at, std::string(change.from).size(), change.to);
}

/// The one line that a user sees; empty if all is well.
std::string complaint(const std::string& text) {
  const Input<InstanceParts> parts = parse_xml_instance(text, "f");
  if (!parts) return parts.error().message();
  Instance instance{parts->map->map, parts->agents->items, parts->obstacles->items};
  const std::optional<InstanceError> error = find_error(instance);
  return error ? error->what + ", expected " + error->expected : "";
}

TEST(IoBrokenFeatures, UnbrokenThereIsNothingToSay) { EXPECT_EQ(complaint(kEverything), ""); }

TEST(IoBrokenFeatures, EachIsOneLine) {
  const Break kBreaks[] = {
      {R"(size="0.5")", R"(size="0")", "f:4: size '0' in <agent>, expected a radius in cells, 0.001 to 64"},
      {R"(size="0.4")", R"(size="nan")",
       "f:3: size 'nan' in <defaultparameters>, expected a radius in cells, 0.001 to 64"},
      {R"(movespeed="3")", R"(movespeed="-1")",
       "f:5: movespeed '-1' in <agent>, expected a speed in cells per second, 0.001 to 1000"},
      {R"(rotationspeed="0.2")", R"(rotationspeed="0")",
       "f:3: rotationspeed '0' in <defaultparameters>, expected half turns per second, 0.001 to 1000"},
      {R"(start.heading="40")", R"(start.heading="400")",
       "f:4: start.heading '400' in <agent>, expected degrees from 0 to 360"},
      {R"(goal.heading="whatever")", R"(goal.heading="-2")",
       "f:5: goal.heading '-2' in <agent>, expected degrees from 0 to 360"},
      {R"(duration="4")", R"(duration="-4")", "f:20: duration '-4' in <section>, expected seconds from 0"},
      {R"(duration="4")", R"(duration="0")",
       "f:20: a <section> that changes place in no time, expected a duration above 0"},
      {R"(start.x="3" start.y="0" goal.x="1")", R"(start.x="3" start.y="1" goal.x="1")",
       "f:20: a <section> that begins at (3, 1), expected the end of the one before, (3, 0)"},
      {R"(<section start.x="3" start.y="0" goal.x="3" goal.y="0" duration="2"/>
<section start.x="3" start.y="0")",
       R"(<section start.x="3" start.y="3" goal.x="3" goal.y="3" duration="2"/>
<section start.x="3" start.y="3")",
       "obstacle c: stands at (3, 3) on the start of agent b at time 0, expected a place that no start "
       "overlaps"},
      {R"(size="0.3")", R"(size="65")",
       "f:18: size '65' in <obstacle>, expected a radius in cells, 0.001 to 64"},
      {">true<", ">maybe<", "f:11: <planforturns> 'maybe', expected true or false"},
      {">0.5<", ">-0.5<", "f:12: <waitbeforemove> '-0.5', expected seconds from 0 to 100"},
      {">0.25<", ">101<", "f:13: <inflatecollisionintervals> '101', expected cells from 0 to 100"},
      {">0.125<", ">inf<", "f:14: <inflatecollisiontime> 'inf', expected seconds from 0 to 100"},
      {">60<", ">0<", "f:15: <timelimit> '0', expected a number of seconds > 0, or inf"},
  };
  for (const Break& change : kBreaks) EXPECT_EQ(complaint(broken(change)), change.message);
}

TEST(IoBrokenFeatures, MisspeltTagsAndAttributesAreRefusedIfTheyCouldChangeTheProblem) {
  EXPECT_TRUE(complaint(broken({"<planforturns>true</planforturns>", "<planforturn>true</planforturn>", ""}))
                  .starts_with("f:11: unknown tag <planforturn> in <algorithm>, expected only "));
  EXPECT_TRUE(complaint(broken({"movespeed=\"3\"", "movspeed=\"3\"", ""}))
                  .starts_with("f:5: unknown attribute 'movspeed' in <agent>, expected only id, start.x, "));
  EXPECT_TRUE(complaint(broken({"<agents", "<obstacles><obstacle/></obstacles><agents", ""}))
                  .find("unknown tag <obstacles> in <root>, expected only agents, map, ") !=
              std::string::npos);
  const Input<InstanceParts> parts =
      parse_xml_instance(broken({"duration=\"4\"", "duration=\"4\" speed=\"1\"", ""}), "f");
  ASSERT_TRUE(parts) << parts.error().message();
  EXPECT_EQ(parts->warnings,
            std::vector<std::string>{"f:20: unknown attribute 'speed' in <section>, ignored"});
}

TEST(IoBrokenFeatures, TheInflationTagIsADistanceAsThePublishedPlannerHasIt) {
  const Input<InstanceParts> parts = parse_xml_instance(kEverything, "f");
  ASSERT_TRUE(parts);
  const MotionRules rules = parts->options->options.applied_to({}).rules;
  EXPECT_EQ(rules.inflate_distance_cells, 0.25);
  EXPECT_EQ(rules.inflate_time_s, 0.125);
}

}  // namespace
}  // namespace sipplab
