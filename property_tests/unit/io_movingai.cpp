// MovingAI maps and scenarios, good and bad.
#include "planner/io/movingai.hpp"

#include <gtest/gtest.h>

#include "sipplab/instance_io.hpp"

namespace sipplab {
namespace {

std::string movingai_map_error(const std::string& text) {
  const Input<GridMap> map = parse_movingai_map(text, "m");
  return map ? "no error" : map.error().message();
}

std::string scen_error(const std::string& text) {
  const Input<MovingaiScenario> scenario = parse_movingai_scen(text, "s");
  return scenario ? "no error" : scenario.error().message();
}

TEST(IoMovingai, KnowsWhichLettersAreFreeAndWhichAreBlocked) {
  const Input<GridMap> map = parse_movingai_map("type octile\nheight 2\nwidth 5\nmap\n.GSE@\nOTW##\n", "m");
  ASSERT_TRUE(map);
  EXPECT_EQ(map->width(), 5);
  EXPECT_EQ(map->height(), 2);
  for (std::int32_t x = 0; x < 5; ++x) {
    EXPECT_EQ(map->is_blocked({x, 0}), x == 4);
    EXPECT_TRUE(map->is_blocked({x, 1}));
  }
}

TEST(IoMovingai, LineBreaksOfWindowsAndAMissingLastOneAreFine) {
  const Input<GridMap> map = parse_movingai_map("type octile\r\nheight 1\r\nwidth 2\r\nmap\r\n.@", "m");
  ASSERT_TRUE(map);
  EXPECT_TRUE(map->is_blocked({1, 0}));
}

TEST(IoMovingai, WrittenMapsReadBackEqual) {
  GridMap map(3, 2);
  map.set_blocked({2, 0}, true);
  map.set_blocked({0, 1}, true);
  const Input<GridMap> again = parse_movingai_map(write_movingai_map(map), "m");
  ASSERT_TRUE(again);
  EXPECT_EQ(*again, map);
}

TEST(IoMovingai, BadMapsAreOneLineThatNamesTheLine) {
  const std::string head = "type octile\nheight 2\nwidth 3\nmap\n";
  EXPECT_EQ(movingai_map_error(""),
            "m:1: the text ends within the header of the map, expected a line 'map' and rows of cells");
  EXPECT_EQ(movingai_map_error("type octile\nheight 2\nmap\n"),
            "m:3: no width before the map, expected lines 'height H' and 'width W'");
  EXPECT_EQ(
      movingai_map_error("type octile\nheigth 2\n"),
      "m:2: line 'heigth 2' in the header of a map, expected 'type octile', 'height H', 'width W' or 'map'");
  EXPECT_EQ(movingai_map_error("type octile\nheight -2\n"), "m:2: height -2, expected 1 to 8192");
  EXPECT_EQ(movingai_map_error("type octile\nheight nan\n"), "m:2: height 'nan', expected a number of cells");
  EXPECT_EQ(movingai_map_error("type octile\nheight 1000000000\nwidth 1000000000\nmap\n"),
            "m:2: height 1000000000, expected 1 to 8192");
  EXPECT_EQ(movingai_map_error("type octile\nheight 2\nheight 2\n"), "m:3: a second height, expected one");
  EXPECT_EQ(movingai_map_error(head + "...\n"),
            "m:6: the text ends after 1 rows of the map, expected 2 rows");
  EXPECT_EQ(movingai_map_error(head + "...\n....\n"), "m:6: row 1 has 4 cells, expected 3");
  EXPECT_EQ(movingai_map_error(head + "..\n...\n"), "m:5: row 0 has 2 cells, expected 3");
  EXPECT_EQ(movingai_map_error(head + "...\n\n...\n"), "m:6: row 1 has 0 cells, expected 3");
  const std::string expected =
      ", expected '.', 'G', 'S' or 'E' where free, '@', 'O', 'T', 'W' or '#' where blocked";
  EXPECT_EQ(movingai_map_error(head + "...\n. .\n"), "m:6: unprintable cell in row 1" + expected);
  EXPECT_EQ(movingai_map_error(head + "..x\n...\n"), "m:5: cell 'x' in row 0" + expected);
  EXPECT_EQ(movingai_map_error(head + "...\n.3.\n"),
            "m:6: cell '3' in row 1 (weighted terrain, which has no meaning here)" + expected);
  EXPECT_EQ(movingai_map_error(head + "...\n...\n\n...\n"),
            "m:8: text '...' after the last row, expected 2 rows");
}

TEST(IoMovingai, AnnouncedSizesAreNotAllocatedBeforeTheyAreSeen) {
  EXPECT_EQ(movingai_map_error("type octile\nheight 8192\nwidth 8192\nmap\n"),
            "m:5: the text ends after 0 rows of the map, expected 8192 rows");
}

TEST(IoMovingai, ScenarioRowsBecomeAgents) {
  const Input<MovingaiScenario> scenario = parse_movingai_scen(
      "version 1.0\n0\ta map.map\t5\t3\t0\t1\t2\t0\t2.41\n\n7\ta map.map\t5\t3\t4\t2\t0\t0\t6\r\n", "s");
  ASSERT_TRUE(scenario) << scenario.error().message();
  EXPECT_EQ(scenario->map_name, "a map.map");
  EXPECT_EQ(scenario->map_width, 5);
  EXPECT_EQ(scenario->map_height, 3);
  ASSERT_EQ(scenario->agents.size(), 2u);
  EXPECT_EQ(scenario->agents[0].start, (Cell{0, 1}));
  EXPECT_EQ(scenario->agents[0].goal, (Cell{2, 0}));
  EXPECT_EQ(scenario->agents[1].id, "1");
  EXPECT_EQ(scenario->agent_lines, (std::vector<int>{2, 4}));
}

TEST(IoMovingai, FieldsMayBePartedByBlanks) {
  const Input<MovingaiScenario> scenario = parse_movingai_scen("version 1\n0 m.map 5 3 0 1 2 0 2.41\n", "s");
  ASSERT_TRUE(scenario);
  EXPECT_EQ(scenario->agents[0].goal, (Cell{2, 0}));
}

TEST(IoMovingai, BadScenariosAreOneLineThatNamesTheLine) {
  const std::string row = "0\tm.map\t5\t3\t0\t1\t2\t0\t2.41\n";
  EXPECT_EQ(scen_error(""), "s:1: line '', expected 'version 1'");
  EXPECT_EQ(scen_error("version 2\n"), "s:1: line 'version 2', expected 'version 1'");
  EXPECT_EQ(scen_error("version 1\n0\tm.map\t5\t3\t0\t1\t2\t0\n"),
            "s:2: row of 8 fields, expected 9: bucket, map, map width, map height, start x, start y, goal x, "
            "goal y, "
            "length");
  EXPECT_EQ(scen_error("version 1\n" + row + "0\tm.map\t5\t3\t0\t1.5\t2\t0\t2.41\n"),
            "s:3: start y '1.5', expected an integer from 0");
  EXPECT_EQ(scen_error("version 1\n0\tm.map\t5\t3\t0\t1\t-2\t0\t2.41\n"),
            "s:2: goal x '-2', expected an integer from 0");
  EXPECT_EQ(scen_error("version 1\n0\tm.map\t5\t3\t0\t1\t2\t99999999999\t2.41\n"),
            "s:2: goal y '99999999999', expected an integer from 0");
  EXPECT_EQ(scen_error("version 1\nx\tm.map\t5\t3\t0\t1\t2\t0\t2.41\n"),
            "s:2: bucket 'x', expected an integer");
  EXPECT_EQ(scen_error("version 1\n0\tm.map\t5\t3\t0\t1\t2\t0\tnan\n"),
            "s:2: optimal length 'nan', expected a number");
  EXPECT_EQ(scen_error("version 1\n" + row + "0\tother.map\t5\t3\t0\t1\t2\t0\t2.41\n"),
            "s:3: map 'other.map' of 5 x 3, expected the map of the rows before: 'm.map' of 5 x 3");
}

}  // namespace
}  // namespace sipplab
