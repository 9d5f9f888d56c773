// Files joined to an instance: formats told from content, combinations, complaints.
#include "sipplab/instance_io.hpp"

#include <gtest/gtest.h>

#include <filesystem>
#include <limits>

#include "planner/io/text_file.hpp"

namespace sipplab {
namespace {

const std::string kData = std::string(SIPPLAB_SOURCE_DIR) + "/property_tests/data/";

/// A folder of its own for each test, removed afterwards.
class IoLoadInstance : public testing::Test {
 protected:
  void SetUp() override {
    folder_ = std::filesystem::path(testing::TempDir()) /
              (std::string("sipplab_") + testing::UnitTest::GetInstance()->current_test_info()->name());
    std::filesystem::create_directories(folder_);
  }
  void TearDown() override { std::filesystem::remove_all(folder_); }

  std::string write(const std::string& name, const std::string& text) const {
    const std::string path = (folder_ / name).string();
    EXPECT_FALSE(write_file(path, text));
    return path;
  }

  /// The complaint about these files, with "F/" for the folder of the test.
  std::string error_of(const InstanceFiles& files) const {
    const Input<LoadedInstance> loaded = load_instance(files);
    if (loaded) return "no error";
    std::string message = loaded.error().message();
    const std::string prefix = folder_.string() + "/";
    for (std::size_t at = message.find(prefix); at != std::string::npos; at = message.find(prefix)) {
      message.replace(at, prefix.size(), "F/");
    }
    EXPECT_EQ(message.find('\n'), std::string::npos);
    return message;
  }

  static InstanceFiles just(const std::string& path) {
    InstanceFiles files;
    files.instance = path;
    return files;
  }

  std::filesystem::path folder_;
};

/// Rows of 0 and 1 with the agents' places as "x y x y".
std::string document(const std::vector<std::string>& rows, const std::vector<std::string>& agents,
                     const std::string& size = "0.5") {
  std::string text = "<root><map><grid width=\"" + std::to_string((rows[0].size() + 1) / 2) + "\" height=\"" +
                     std::to_string(rows.size()) + "\">\n";
  for (const std::string& row : rows) text += "<row>" + row + "</row>\n";
  text += "</grid></map><agents><defaultparameters size=\"" + size + "\"/>\n";
  for (const std::string& agent : agents) {
    std::string numbers = agent;
    for (const char* name : {"start.x", "start.y", "goal.x", "goal.y"}) {
      const std::size_t blank = numbers.find(' ');
      text += (name == std::string("start.x") ? "<agent " : " ") + std::string(name) + "=\"" +
              numbers.substr(0, blank) + "\"";
      numbers = blank == std::string::npos ? "" : numbers.substr(blank + 1);
    }
    text += "/>\n";
  }
  return text + "</agents></root>\n";
}

TEST_F(IoLoadInstance, AllInOneFile) {
  const Input<LoadedInstance> loaded = load_instance(just(kData + "corridor.xml"));
  ASSERT_TRUE(loaded) << loaded.error().message();
  EXPECT_TRUE(loaded->warnings.empty());
  const Instance& instance = loaded->instance;
  EXPECT_EQ(instance.map.width(), 6);
  EXPECT_EQ(instance.map.height(), 3);
  EXPECT_EQ(instance.map.blocked_count(), 4u);
  ASSERT_EQ(instance.agents.size(), 3u);
  EXPECT_EQ(instance.agents[0], (Agent{"north", {0, 0}, {5, 0}, 0.25, 0.5, 90, std::nullopt, 2}));
  EXPECT_EQ(instance.agents[1], (Agent{"south", {5, 2}, {0, 2}, 0.4, 1.5, 90, 0.0, 2}));
  EXPECT_EQ(instance.agents[2], (Agent{"2", {2, 1}, {3, 1}, 0.4, 0.5, 0, std::nullopt, 1}));
  ASSERT_EQ(instance.obstacles.size(), 2u);
  EXPECT_EQ(
      instance.obstacles[0],
      (DynamicObstacle{"cart", 0.25, {{3, 0}, {{0, 1.5, {3, 0}, {3, 0}}, {1.5, 5.5, {3, 0}, {3, 2}}}}}));
  EXPECT_EQ(instance.obstacles[1].radius_cells, 0.3);

  PlannerOptions expected;
  expected.any_angle = false;
  expected.connectedness = 4;
  expected.order = InitialOrder::kLongestFirst;
  expected.ssi_s = 2.5;
  expected.time_limit_s = std::numeric_limits<double>::infinity();
  expected.rules.turns = true;
  expected.rules.wait_before_move_s = 0.5;
  PlannerOptions options;
  options.rescheduling = Rescheduling::kRandom;
  EXPECT_EQ(loaded->options.applied_to(options), expected);
}

TEST_F(IoLoadInstance, WrittenInPartsItLoadsAsItWas) {
  const Input<LoadedInstance> whole = load_instance(just(kData + "corridor.xml"));
  ASSERT_TRUE(whole) << whole.error().message();
  PlannerOptions options = whole->options.applied_to({});
  options.weight = 1.25;

  InstanceFiles parts;
  parts.task = write("task.xml", write_task_xml(whole->instance));
  parts.map = write("map.xml", write_map_xml(whole->instance.map));
  parts.config = write("config.xml", write_config_xml(options, "out", "plan.xml"));
  parts.obstacles = write("obstacles.xml", write_obstacles_xml(whole->instance));
  const Input<LoadedInstance> joined = load_instance(parts);
  ASSERT_TRUE(joined) << joined.error().message();
  EXPECT_TRUE(joined->warnings.empty()) << joined->warnings.front();
  EXPECT_EQ(joined->instance, whole->instance);
  EXPECT_EQ(joined->options.applied_to({}), options);
}

TEST_F(IoLoadInstance, OlderXmlOfTheArchive) {
  const Input<LoadedInstance> loaded = load_instance(just(kData + "corridor_older.xml"));
  ASSERT_TRUE(loaded) << loaded.error().message();
  EXPECT_TRUE(loaded->warnings.empty());
  EXPECT_EQ(loaded->instance.agents.size(), 2u);
  EXPECT_TRUE(loaded->instance.map.is_blocked({2, 1}));
  EXPECT_TRUE(loaded->options.states("any-angle") && loaded->options.applied_to({}).any_angle);
}

TEST_F(IoLoadInstance, AScenarioBringsItsMap) {
  const Input<LoadedInstance> loaded = load_instance(just(kData + "scen/notch.scen"));
  ASSERT_TRUE(loaded) << loaded.error().message();
  EXPECT_EQ(loaded->instance.agents.size(), 2u);
  EXPECT_EQ(loaded->instance.map.width(), 5);

  const std::string row = "version 1\n0\t/somewhere/else/notch.map\t5\t3\t0\t0\t4\t2\t5\n";
  const std::string lonely = write("lonely.scen", row);
  EXPECT_EQ(error_of(just(lonely)),
            "F/lonely.scen:2: map '/somewhere/else/notch.map' not found, expected it beside the scenario or "
            "in ../maps, "
            "or a map given besides");
  const Input<std::string> map = read_file(kData + "maps/notch.map");
  ASSERT_TRUE(map);
  write("notch.map", *map);
  EXPECT_EQ(error_of(just(lonely)), "no error");

  // As some editors save them.
  const std::string byte_order_mark = "\xef\xbb\xbf";
  write("notch.map", byte_order_mark + *map);
  EXPECT_EQ(error_of(just(write("marked.scen", byte_order_mark + row))), "no error");
}

TEST_F(IoLoadInstance, AnObstacleOnAStartIsFoundWhereTheObstacleIs) {
  InstanceFiles files;
  files.map = kData + "maps/notch.map";
  files.task =
      write("task.xml",
            "<root><agents><agent start.x=\"0\" start.y=\"0\" goal.x=\"4\" goal.y=\"2\"/></agents></root>");
  files.obstacles = write("obstacles.xml",
                          "<root><dynamicobstacles>\n\n<obstacle id=\"o\">\n"
                          "<section start.x=\"0\" start.y=\"0\" goal.x=\"0\" goal.y=\"0\" duration=\"9\"/>\n"
                          "</obstacle></dynamicobstacles></root>");
  EXPECT_EQ(error_of(files).substr(0, 42), "F/obstacles.xml:3: obstacle o: stands at (");
}

TEST_F(IoLoadInstance, AnyFormatsGoTogether) {
  InstanceFiles files;
  files.task =
      write("task.xml",
            "<root><agents><agent start.x=\"0\" start.y=\"0\" goal.x=\"4\" goal.y=\"2\"/></agents></root>");
  files.map = kData + "maps/notch.map";
  files.config = write("config.txt", "<root><algorithm><connectedness>3</connectedness></algorithm></root>");
  files.obstacles = kData + "corridor.xml";
  const Input<LoadedInstance> loaded = load_instance(files);
  ASSERT_TRUE(loaded) << loaded.error().message();
  EXPECT_EQ(loaded->instance.map.width(), 5);
  EXPECT_EQ(loaded->instance.agents.size(), 1u);
  EXPECT_EQ(loaded->options.applied_to({}).connectedness, 3);
  EXPECT_EQ(loaded->instance.obstacles.size(), 2u);

  files.task = kData + "scen/notch.scen";
  files.map = write("map.xml",
                    "<root><map><grid width=\"5\" height=\"3\"><row>0 0 0 0 0</row><row>0 0 0 0 "
                    "0</row><row>0 0 0 0 0</row></grid></map></root>");
  files.obstacles.reset();
  const Input<LoadedInstance> mixed = load_instance(files);
  ASSERT_TRUE(mixed) << mixed.error().message();
  EXPECT_EQ(mixed->instance.map.blocked_count(), 0u);
  EXPECT_EQ(mixed->instance.agents.size(), 2u);
}

TEST_F(IoLoadInstance, AFileGivenForAPartGoesBeforeTheInstance) {
  InstanceFiles files = just(kData + "corridor_older.xml");
  files.config = kData + "corridor.xml";
  const Input<LoadedInstance> loaded = load_instance(files);
  ASSERT_TRUE(loaded) << loaded.error().message();
  EXPECT_EQ(loaded->instance.agents.size(), 2u);
  EXPECT_EQ(loaded->options.applied_to({}).connectedness, 4);
}

TEST_F(IoLoadInstance, OnlyTheFirstAgents) {
  InstanceFiles files = just(kData + "corridor.xml");
  files.agents = 1;
  const Input<LoadedInstance> loaded = load_instance(files);
  ASSERT_TRUE(loaded) << loaded.error().message();
  ASSERT_EQ(loaded->instance.agents.size(), 1u);
  EXPECT_EQ(loaded->instance.agents[0].id, "north");
  files.agents = 0;
  EXPECT_EQ(error_of(files), "no error");
  files.agents = 4;
  EXPECT_EQ(error_of(files), kData + "corridor.xml:3: 3 agents, expected the 4 that are asked for");
}

TEST_F(IoLoadInstance, ZeroAgentsAreAnInstance) {
  const Input<LoadedInstance> loaded = load_instance(just(write("none.xml", document({"0 0"}, {}))));
  ASSERT_TRUE(loaded) << loaded.error().message();
  EXPECT_TRUE(loaded->instance.agents.empty());
}

TEST_F(IoLoadInstance, WhatIsNoInstanceIsOneLine) {
  EXPECT_EQ(error_of(just(write("empty", ""))),
            "F/empty:1: empty file, expected XML with <root>, or text that begins with 'type' (a map) or "
            "'version' (a "
            "scenario)");
  EXPECT_EQ(error_of(just(write("noise", "hello"))),
            "F/noise:1: neither XML nor a MovingAI file, expected XML with <root>, or text that begins with "
            "'type' (a "
            "map) or 'version' (a scenario)");
  EXPECT_EQ(error_of(just((folder_ / "missing").string())),
            "F/missing: cannot be read: no such file or directory, expected a readable file");
  std::filesystem::create_directory(folder_ / "folder");
  EXPECT_EQ(error_of(just((folder_ / "folder").string())), "F/folder: is a directory, expected a file");
  EXPECT_EQ(error_of({}), "no agents, expected <agents> or a MovingAI scenario");
  EXPECT_EQ(error_of(just(kData + "maps/notch.map")),
            kData + "maps/notch.map:1: no agents, expected <agents> or a MovingAI scenario");
  EXPECT_EQ(error_of(just(write("task", "<root><agents/></root>"))),
            "F/task:1: no map, expected a <map> or a MovingAI map");
  InstanceFiles files = just(kData + "corridor.xml");
  files.map = kData + "scen/notch.scen";
  EXPECT_EQ(error_of(files),
            kData + "scen/notch.scen:1: no map in this file, expected a <map> or a MovingAI map");
}

TEST_F(IoLoadInstance, AMapOfAnotherSizeThanTheScenarioSays) {
  InstanceFiles files;
  files.task = write("s", "version 1\n0\tnotch.map\t6\t3\t0\t0\t4\t2\t5\n");
  files.map = kData + "maps/notch.map";
  EXPECT_EQ(error_of(files), "F/s:2: a scenario for a map of 6 x 3, expected the size of the map in " +
                                 kData + "maps/notch.map, 5 x 3");
}

// The first line of the file, then the rows, then one line with <agents>.
TEST_F(IoLoadInstance, AgentsThatBreakARuleNameTheirLine) {
  const auto line_of = [&](const std::vector<std::string>& rows, const std::vector<std::string>& agents) {
    const std::string message = error_of(just(write("f", document(rows, agents))));
    return message.substr(0, message.find(", expected"));
  };
  const std::vector<std::string> rows = {"0 0 0", "0 1 0"};
  EXPECT_EQ(line_of(rows, {"0 0 2 0", "0 1 2 1"}), "no error");
  EXPECT_EQ(line_of(rows, {"0 0 2 0", "1 1 2 1"}).substr(0, 4), "F/f:");
  EXPECT_EQ(line_of(rows, {"0 0 2 0", "1 1 2 1"}).substr(0, 6), "F/f:6:") << "blocked start";
  EXPECT_EQ(line_of(rows, {"0 0 2 0", "0 1 1 1"}).substr(0, 6), "F/f:6:") << "blocked goal";
  EXPECT_EQ(line_of(rows, {"3 0 2 0", "0 1 2 1"}).substr(0, 6), "F/f:5:") << "start out of the grid";
  EXPECT_EQ(line_of(rows, {"0 0 2 -1", "0 1 2 1"}).substr(0, 6), "F/f:5:") << "goal out of the grid";
  EXPECT_EQ(line_of(rows, {"0 0 2 0", "2 1 0 1", "0 0 1 0"}).substr(0, 6), "F/f:7:") << "two on one start";
  EXPECT_EQ(line_of(rows, {"0 0 2 0", "2 1 2 0"}).substr(0, 6), "F/f:6:") << "two on one goal";
}

TEST_F(IoLoadInstance, UnreachableGoalsNameTheirLineUnlessAllowed) {
  InstanceFiles files = just(write("f", document({"0 1 0", "0 1 0"}, {"0 0 0 1", "0 1 2 1"})));
  EXPECT_EQ(error_of(files),
            "F/f:6: agent 1: goal (2, 1) cannot be reached from start (0, 1), expected free space between "
            "them that is "
            "wide enough for the robot");
  files.allow_unreachable = true;
  EXPECT_EQ(error_of(files), "no error");
}

TEST_F(IoLoadInstance, EveryCutOfAFileIsAnErrorOrAnInstance) {
  const Input<std::string> text = read_file(kData + "corridor.xml");
  ASSERT_TRUE(text);
  for (std::size_t length = 0; length + 2 < text->size(); length += 7) {
    const std::string message = error_of(just(write("cut", text->substr(0, length))));
    EXPECT_EQ(message.substr(0, 6), "F/cut:") << "cut after " << length << " bytes";
  }
}

}  // namespace
}  // namespace sipplab
