// Generated instances: what they guarantee, for every seed, map and size.
#include <gtest/gtest.h>

#include <set>

#include "planner/instance/reachability.hpp"
#include "sipplab/generator.hpp"

namespace sipplab {
namespace {

MapSpec spec_of(const char* text) {
  const Expected<MapSpec, std::string> spec = parse_map_spec(text);
  EXPECT_TRUE(spec) << text;
  return spec ? *spec : MapSpec{};
}

std::string spec_error(const char* text) {
  const Expected<MapSpec, std::string> spec = parse_map_spec(text);
  return spec ? "no error" : spec.error();
}

Instance generated(const char* map, std::size_t agents, std::uint64_t seed, std::uint64_t index = 0,
                   double radius_cells = 0.5) {
  GeneratorOptions options;
  options.agents = agents;
  options.seed = seed;
  options.index = index;
  options.radii_cells = {radius_cells};
  const Expected<Instance, std::string> instance = generate_instance(spec_of(map), options);
  EXPECT_TRUE(instance) << (instance ? "" : instance.error());
  return instance ? *instance : Instance{};
}

TEST(GeneratorInstances, TheWarehouseIsThePapers) {
  const GridMap map = warehouse_map();
  EXPECT_EQ(map.width(), 35);
  EXPECT_EQ(map.height(), 21);
  EXPECT_EQ(map.blocked_count(), 100u);
  const std::set<std::int32_t> rows = {2, 6, 10, 14, 18};
  for (std::size_t i = 0; i < map.cell_count(); ++i) {
    const Cell cell = map.cell(i);
    const bool in_shelf = (cell.x >= 7 && cell.x <= 16) || (cell.x >= 18 && cell.x <= 27);
    EXPECT_EQ(map.is_blocked(cell), rows.count(cell.y) == 1 && in_shelf);
  }
}

TEST(GeneratorInstances, MapSpecs) {
  EXPECT_EQ(spec_of("empty:32x16").width, 32);
  EXPECT_EQ(spec_of("empty:32x16").height, 16);
  EXPECT_EQ(spec_of("random:8x8:0.25").density, 0.25);
  EXPECT_EQ(spec_of("some/where.map").path, "some/where.map");
  EXPECT_EQ(make_map(spec_of("random:10x10:0.25"), 3)->blocked_count(), 25u);
  const std::string expected =
      ", expected empty:WxH, random:WxH:DENSITY, caves:WxH:DENSITY, rooms:WxH:GAP, maze:WxH:GAP, warehouse, "
      "shelves:COLUMNSxROWS:LENGTHxWIDTH:GAP or the path of a map";
  EXPECT_EQ(spec_error(""), "map '': nothing" + expected);
  EXPECT_EQ(spec_error("empty:32"), "map 'empty:32': size '32'" + expected);
  EXPECT_EQ(spec_error("empty:3.5x2"), "map 'empty:3.5x2': size '3.5x2'" + expected);
  EXPECT_EQ(spec_error("random:8x8"), "map 'random:8x8': no density" + expected);
  EXPECT_EQ(spec_error("random:8x8:1"), "map 'random:8x8:1': density not within 0 <= density < 1" + expected);
  EXPECT_EQ(spec_error("random:8x8:nan"),
            "map 'random:8x8:nan': density not within 0 <= density < 1" + expected);
  EXPECT_EQ(spec_error("rooms:8x8"), "map 'rooms:8x8': no gap" + expected);
  EXPECT_EQ(spec_error("maze:8x8:0"), "map 'maze:8x8:0': gap not within 1 to 8192" + expected);
  EXPECT_EQ(spec_error("shelves:10x20:1"), "map 'shelves:10x20:1': no size of shelves" + expected);
  EXPECT_EQ(spec_error("shelves:10x20:10:1"), "map 'shelves:10x20:10:1': size '10'" + expected);
  EXPECT_EQ(spec_error("shelves:10x0:10x2:1"),
            "map 'shelves:10x0:10x2:1': number not within 1 to 8192" + expected);
  EXPECT_EQ(spec_error("shelves:8192x1:8192x1:1"),
            "map of 100671489 x 5 cells, expected 1 to 8192 along each side");
  EXPECT_EQ(spec_error("empty:1000000000x1000000000"),
            "map of 1000000000 x 1000000000 cells, expected 1 to 8192 along each side");
  EXPECT_EQ(spec_error("empty:0x4"), "map of 0 x 4 cells, expected 1 to 8192 along each side");
  EXPECT_EQ(make_map(spec_of("no/such.map"), 1).error(),
            "no/such.map: cannot be read: no such file or directory, expected a readable file");
}

std::string drawn(const char* text, std::uint64_t seed) {
  const GridMap map = *make_map(spec_of(text), seed);
  std::string rows;
  for (std::int32_t y = 0; y < map.height(); ++y) {
    for (std::int32_t x = 0; x < map.width(); ++x) rows += map.is_blocked({x, y}) ? '#' : '.';
    rows += '\n';
  }
  return rows;
}

// MovingAI's are warehouse-10-20-10-2-1 (5,699 free cells) and warehouse-20-40-10-2-2 (38,756).
TEST(GeneratorInstances, ShelvesStandAsInMovingAisWarehouses) {
  EXPECT_EQ(drawn("shelves:2x2:4x2:1", 1),
            "###############\n"
            "#.............#\n"
            "#..####.####..#\n"
            "#..####.####..#\n"
            "#.............#\n"
            "#..####.####..#\n"
            "#..####.####..#\n"
            "#.............#\n"
            "###############\n");
  const GridMap small = *make_map(spec_of("shelves:10x20:10x2:1"), 1);
  EXPECT_EQ(small.width(), 161);
  EXPECT_EQ(small.height(), 63);
  EXPECT_EQ(small.cell_count() - small.blocked_count(), 5699u);
  const GridMap large = *make_map(spec_of("shelves:20x40:10x2:2"), 1);
  EXPECT_EQ(large.width(), 340);
  EXPECT_EQ(large.height(), 164);
  EXPECT_EQ(large.cell_count() - large.blocked_count(), 38756u);
}

TEST(GeneratorInstances, AreProperAndEveryGoalIsInReach) {
  for (const char* map :
       {"empty:9x7", "random:12x12:0.3", "maze:20x20:4", "warehouse", "shelves:3x2:4x2:3"}) {
    for (const double radius_cells : {0.25, 0.5, 0.7, 1.2}) {
      for (std::uint64_t index = 0; index < 20; ++index) {
        const std::size_t agents = radius_cells > 1 ? 2 : 10;
        // Random maps are too crowded for the largest bodies.
        if (radius_cells > 1 && map == std::string("random:12x12:0.3")) continue;
        if (radius_cells == 0.7 && map == std::string("random:12x12:0.3")) continue;
        const Instance instance = generated(map, agents, 5, index, radius_cells);
        EXPECT_FALSE(find_error(instance)) << map << " " << radius_cells << " " << index;
        EXPECT_FALSE(find_unreachable_goal(instance)) << map << " " << radius_cells << " " << index;
        for (const Agent& agent : instance.agents) EXPECT_NE(agent.start, agent.goal);
      }
    }
  }
}

TEST(GeneratorInstances, AFullMapIsFilled) {
  const Instance instance = generated("empty:5x4", 20, 1);
  EXPECT_FALSE(find_error(instance));
  for (const Agent& agent : instance.agents) EXPECT_NE(agent.start, agent.goal);
  EXPECT_EQ(generated("empty:1x1", 1, 1).agents[0].goal, (Cell{0, 0}));
  EXPECT_NE(generated("empty:2x1", 1, 1).agents[0].goal, generated("empty:2x1", 1, 1).agents[0].start);
  EXPECT_TRUE(generated("empty:3x3", 0, 1).agents.empty());
}

TEST(GeneratorInstances, TooManyRobotsAreOneLine) {
  GeneratorOptions options;
  options.agents = 21;
  EXPECT_EQ(generate_instance(spec_of("empty:5x4"), options).error(),
            "21 robots of radius 0.5 do not fit on the map: starts were found for 20, expected fewer robots "
            "or a larger "
            "map");
  options.agents = 2;
  options.radii_cells = {2};
  EXPECT_EQ(generate_instance(spec_of("empty:5x5"), options).error(),
            "2 robots of radius 2 do not fit on the map: starts were found for 1, expected fewer robots or a "
            "larger map");
  for (const double radius_cells : {-1.0, 0.0009, 64.1}) {
    options.radii_cells = {radius_cells};
    EXPECT_EQ(generate_instance(spec_of("empty:5x4"), options).error(),
              "radius out of range, expected 0.001 to 64 cells");
  }
}

TEST(GeneratorInstances, BodiesAreDrawnFromWhatIsAskedFor) {
  GeneratorOptions options;
  options.agents = 40;
  options.radii_cells = {0.3, 0.5, 0.9, 1.4};
  options.speeds_cells_per_s = {0.5, 1, 2};
  options.rotation_speeds = {0.25, 1};
  options.headings = true;
  const Expected<Instance, std::string> instance = generate_instance(spec_of("empty:32x32"), options);
  ASSERT_TRUE(instance) << instance.error();
  EXPECT_FALSE(find_error(*instance));
  std::set<double> radii, speeds, rotation_speeds, headings;
  std::size_t whatever = 0;
  for (const Agent& agent : instance->agents) {
    radii.insert(agent.radius_cells);
    speeds.insert(agent.speed_cells_per_s);
    rotation_speeds.insert(agent.rotation_speed);
    headings.insert(agent.start_heading_deg);
    if (!agent.goal_heading_deg) ++whatever;
  }
  EXPECT_EQ(radii, (std::set<double>{0.3, 0.5, 0.9, 1.4}));
  EXPECT_EQ(speeds, (std::set<double>{0.5, 1, 2}));
  EXPECT_EQ(rotation_speeds, (std::set<double>{0.25, 1}));
  EXPECT_GT(headings.size(), 20u);
  EXPECT_GT(whatever, 5u);
  EXPECT_LT(whatever, 35u);

  // Speeds, headings and obstacles leave the places alone.
  options.speeds_cells_per_s = {1};
  options.headings = false;
  options.obstacles = 3;
  const Expected<Instance, std::string> plain = generate_instance(spec_of("empty:32x32"), options);
  ASSERT_TRUE(plain);
  EXPECT_FALSE(find_error(*plain));
  ASSERT_EQ(plain->obstacles.size(), 3u);
  for (const DynamicObstacle& obstacle : plain->obstacles) {
    EXPECT_FALSE(plain->map.contains(obstacle.trajectory.start));
    EXPECT_FALSE(plain->map.contains(obstacle.trajectory.end()));
    EXPECT_GE(obstacle.trajectory.motions.size(), 2u);
  }
  std::set<double> plain_radii;
  for (const Agent& agent : plain->agents) {
    plain_radii.insert(agent.radius_cells);
    EXPECT_EQ(agent.start_heading_deg, 0);
    EXPECT_FALSE(agent.goal_heading_deg);
    const auto position = static_cast<std::size_t>(&agent - plain->agents.data());
    EXPECT_EQ(agent.start, instance->agents[position].start);
    EXPECT_EQ(agent.goal, instance->agents[position].goal);
  }
  EXPECT_EQ(plain_radii, radii);

  for (std::vector<double> rotation_speeds_out : {std::vector<double>{}, {1, 0}, {2000}}) {
    options.rotation_speeds = rotation_speeds_out;
    EXPECT_EQ(generate_instance(spec_of("empty:5x4"), options).error(),
              "rotation speed out of range, expected 0.001 to 1000 half turns per second");
  }
}

TEST(GeneratorInstances, SeedAndIndexDecideAlone) {
  EXPECT_EQ(generated("warehouse", 20, 3, 7), generated("warehouse", 20, 3, 7));
  std::set<std::string> hashes;
  for (std::uint64_t seed = 0; seed < 10; ++seed) {
    for (std::uint64_t index = 0; index < 10; ++index) {
      hashes.insert(content_hash(generated("random:16x16:0.1", 5, seed, index)));
    }
  }
  EXPECT_EQ(hashes.size(), 100u);
}

// What is on record under a seed must stay what it is: a change here makes all
// earlier results on generated instances incomparable.
TEST(GeneratorInstances, AreTheSameOnEveryCompilerAndForEver) {
  const Instance instance = generated("random:16x16:0.2", 3, 1, 2);
  std::string places;
  for (const Agent& agent : instance.agents) {
    for (const Cell cell : {agent.start, agent.goal}) {
      places += std::to_string(cell.x) + "," + std::to_string(cell.y) + " ";
    }
  }
  EXPECT_EQ(places, "14,8 13,6 11,6 0,5 6,7 9,15 ");
  EXPECT_EQ(instance.map.blocked_count(), 51u);
}

}  // namespace
}  // namespace sipplab
