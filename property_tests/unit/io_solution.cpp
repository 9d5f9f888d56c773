// Solutions as XML, JSON and CSV, out and in. Those of other planners: io_foreign_solution.cpp.
#include "sipplab/solution_io.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <nlohmann/json.hpp>

#include "planner/grid/heading.hpp"
#include "planner/io/xml_instance.hpp"
#include "sipplab/instance_io.hpp"

namespace sipplab {
namespace {

/// Three robots with awkward ids; the last one never moves.
Instance awkward_instance() {
  Instance instance;
  instance.map = GridMap(8, 4);
  instance.agents = {{"0", {0, 0}, {7, 2}, 0.5, 1, 0, std::nullopt, 1},
                     {"a \"b\", <c> & d\n\xc3\xa9", {0, 2}, {7, 0}, 0.25, 0.3, 0, 90.0, 1},
                     {"007", {4, 3}, {4, 3}, 0.4, 2, 0, std::nullopt, 1}};
  return instance;
}

SolutionDocument awkward_document(const Instance& instance) {
  SolutionDocument document;
  document.valid = true;
  const double third = 1.0 / 3;
  const double first_s = third + std::sqrt(2.0);
  const double second_s = std::sqrt(2.0) / 0.3;
  document.solution.trajectories = {
      {{0, 0},
       {{0, third, {0, 0}, {0, 0}},
        {third, first_s, {0, 0}, {1, 1}},
        {first_s, first_s + std::sqrt(37.0), {1, 1}, {7, 2}}}},
      {{0, 2}, {{0, second_s, {0, 2}, {1, 1}}, {second_s, second_s + std::sqrt(37.0) / 0.3, {1, 1}, {7, 0}}}},
      {{4, 3}, {}}};
  document.order = {2, 0, 1};
  document.makespan_s = makespan_s(document.solution);
  document.flowtime_s = flowtime_s(document.solution);
  document.tries = 3;
  document.expansions = 123456789012;
  document.generations = 7;
  document.planning_seconds = 0.1 + 0.2;
  document.plan_hash = plan_hash(document.solution);
  document.made_by = "complete";
  document.ssi_kept_s = 1 + third;
  document.options.emplace();
  document.options->ssi_s = 2.5;
  document.options->order = InitialOrder::kLongestFirst;
  document.options->rescheduling = Rescheduling::kRandom;
  document.options->any_angle = false;
  document.options->connectedness = 4;
  document.options->seed = 18446744073709551615u;
  EXPECT_EQ(instance.agents.size(), document.solution.trajectories.size());
  return document;
}

void expect_equal(const SolutionDocument& read, const SolutionDocument& written) {
  EXPECT_EQ(read.status, written.status);
  EXPECT_EQ(read.valid, written.valid);
  EXPECT_EQ(read.solution, written.solution);
  EXPECT_EQ(read.order, written.order);
  EXPECT_EQ(read.makespan_s, written.makespan_s);
  EXPECT_EQ(read.flowtime_s, written.flowtime_s);
  EXPECT_EQ(read.tries, written.tries);
  EXPECT_EQ(read.expansions, written.expansions);
  EXPECT_EQ(read.generations, written.generations);
  EXPECT_EQ(read.planning_seconds, written.planning_seconds);
  EXPECT_EQ(read.plan_hash, written.plan_hash);
  EXPECT_EQ(read.made_by, written.made_by);
  EXPECT_EQ(read.ssi_kept_s, written.ssi_kept_s);
  ASSERT_EQ(read.options.has_value(), written.options.has_value());
  if (!read.options) return;
  EXPECT_EQ(read.options->ssi_s, written.options->ssi_s);
  EXPECT_EQ(read.options->order, written.options->order);
  EXPECT_EQ(read.options->rescheduling, written.options->rescheduling);
  EXPECT_EQ(read.options->any_angle, written.options->any_angle);
  EXPECT_EQ(read.options->connectedness, written.options->connectedness);
  EXPECT_EQ(read.options->weight, written.options->weight);
  EXPECT_EQ(read.options->seed, written.options->seed);
  EXPECT_EQ(read.options->rules, written.options->rules);
}

std::string error_of(const std::string& text, const Instance& instance) {
  const Input<SolutionDocument> document = parse_solution(text, "s", instance);
  return document ? "no error" : document.error().message();
}

TEST(IoSolution, JsonAndXmlSurviveTheRoundTripBitByBit) {
  const Instance instance = awkward_instance();
  SolutionDocument document = awkward_document(instance);
  for (const double ssi_s : {2.5, 0.0, kInfiniteSsi}) {
    document.options->ssi_s = ssi_s;
    for (const char* const format : {"json", "xml"}) {
      const Input<SolutionDocument> read =
          parse_solution(*write_solution(format, instance, document), "s", instance);
      ASSERT_TRUE(read) << read.error().message();
      expect_equal(*read, document);
    }
  }
}

/// The document of three robots with turns: before the first move, between two moves, in
/// the middle of a wait, and to the goal heading of a robot that never leaves.
SolutionDocument turning_document(const Instance& instance) {
  SolutionDocument document = awkward_document(instance);
  document.options->weight = 1 + 1.0 / 3;
  document.options->rules.turns = true;
  document.options->rules.wait_before_move_s = 0.1;
  document.options->rules.inflate_distance_cells = 1.0 / 3;
  document.options->rules.inflate_time_s = 2.0 / 3;
  const double third = 1.0 / 3;
  document.solution.trajectories = {
      {{0, 0},
       {{0, third, {0, 0}, {0, 0}, 315.0},
        {third, 1, {0, 0}, {0, 0}},
        {1, 2.5, {0, 0}, {1, 1}},
        {2.5, 2.75, {1, 1}, {1, 1}},
        {2.75, 3, {1, 1}, {1, 1}, heading_deg({1, 1}, {7, 2})},
        {3, 3.5, {1, 1}, {7, 2}}}},
      {{0, 2}, {}},
      {{4, 3},
       {{0, 0.5, {4, 3}, {4, 3}, 90.0}, {0.5, 1, {4, 3}, {4, 3}, 90.0}, {1, 1, {4, 3}, {4, 3}, 450.0}}}};
  document.plan_hash = plan_hash(document.solution);
  document.makespan_s = makespan_s(document.solution);
  document.flowtime_s = flowtime_s(document.solution);
  return document;
}

TEST(IoSolution, TurnsAndRulesSurviveTheRoundTripBitByBit) {
  const Instance instance = awkward_instance();
  const SolutionDocument document = turning_document(instance);
  for (const char* const format : {"json", "xml"}) {
    const Input<SolutionDocument> read =
        parse_solution(*write_solution(format, instance, document), "s", instance);
    ASSERT_TRUE(read) << read.error().message();
    expect_equal(*read, document);
  }
  const std::string csv = solution_to_csv(instance, document);
  EXPECT_EQ(csv.substr(0, csv.find('\n')), "agent,id,t0,t1,x0,y0,x1,y1,turn_to");
  const Input<SolutionDocument> read = parse_solution(csv, "s", instance);
  ASSERT_TRUE(read) << read.error().message();
  EXPECT_EQ(read->solution, document.solution);
}

TEST(IoSolution, TurnsOnTheMoveAreRefused) {
  const Instance instance = awkward_instance();
  EXPECT_EQ(error_of(R"({"trajectories": [{"id": 0, "motions": [{"t0": 0, "t1": 1, "x0": 0, "y0": 0, "x1": 1,
                       "y1": 0, "turn_to": 0}]}]})",
                     instance),
            "s:2: trajectories[0].motions[0].turn_to in a motion that changes place, expected turns in place "
            "alone");
  EXPECT_EQ(error_of("agent,id,t0,t1,x0,y0,x1,y1,turn_to\n0,0,0,1,0,0,1,0,90\n", instance),
            "s:2: turn_to in a motion that changes place, expected turns in place alone");
  EXPECT_EQ(error_of("agent,id,t0,t1,x0,y0,x1,y1,turn_to\n0,0,0,1,0,0,0,0,up\n", instance),
            "s:2: turn_to 'up', expected a number");
}

TEST(IoSolution, ATurnIsPartOfWhatAPlanIsCalled) {
  const Instance instance = awkward_instance();
  Solution solution = turning_document(instance).solution;
  const std::string before = plan_hash(solution);
  solution.trajectories[2].motions[0].turn_to_deg = 270;
  EXPECT_NE(plan_hash(solution), before);
  solution.trajectories[2].motions[0].turn_to_deg.reset();
  EXPECT_NE(plan_hash(solution), before);
}

TEST(IoSolution, SectionsHaveTheHeadingsOfThePublishedLog) {
  Instance instance;
  instance.map = GridMap(3, 3);
  instance.agents = {{"0", {0, 2}, {1, 1}, 0.5, 1, 180, 90.0, 1}};
  SolutionDocument document;
  document.solution.trajectories = {
      {{0, 2},
       {{0, 0.75, {0, 2}, {0, 2}, 45.0}, {0.75, 2, {0, 2}, {1, 1}}, {2, 2.25, {1, 1}, {1, 1}, 90.0}}}};
  const std::string text = solution_to_xml(instance, document);
  for (
      const char* part :
      {R"(start.heading="180" goal.x="1" goal.y="1" goal.heading="90" size)",
       R"(start.x="0" start.y="2" start.heading="180" goal.x="0" goal.y="2" goal.heading="45" duration="0.75")",
       R"(start.x="0" start.y="2" start.heading="45" goal.x="1" goal.y="1" goal.heading="45" duration="1.25")",
       R"(start.x="1" start.y="1" start.heading="45" goal.x="1" goal.y="1" goal.heading="90" duration="0.25")"}) {
    EXPECT_NE(text.find(part), std::string::npos) << part << "\n" << text;
  }
}

TEST(IoSolution, CsvKeepsTheTrajectories) {
  const Instance instance = awkward_instance();
  const SolutionDocument document = awkward_document(instance);
  const std::string text = solution_to_csv(instance, document);
  EXPECT_EQ(text.substr(0, text.find('\n')), "agent,id,t0,t1,x0,y0,x1,y1");
  const Input<SolutionDocument> read = parse_solution(text, "s", instance);
  ASSERT_TRUE(read) << read.error().message();
  EXPECT_EQ(read->solution, document.solution);
}

TEST(IoSolution, JsonIsTheDocumentedDocument) {
  const Instance instance = awkward_instance();
  const std::string text = solution_to_json(instance, awkward_document(instance));
  const auto document = nlohmann::ordered_json::parse(text);
  std::vector<std::string> keys;
  for (const auto& item : document.items()) keys.push_back(item.key());
  EXPECT_EQ(keys, (std::vector<std::string>{
                      "status",    "valid",         "robots",      "makespan",         "flowtime",
                      "tries",     "expansions",    "generations", "planning_seconds", "plan_hash",
                      "order",     "trajectories",  "ssi",         "initial_order",    "reschedule",
                      "any_angle", "connectedness", "seed",        "time_limit",       "made_by",
                      "ssi_kept"}));
  EXPECT_EQ(document["trajectories"][0]["id"], 0);
  EXPECT_EQ(document["trajectories"][2]["id"], "007");
  EXPECT_EQ(document["trajectories"][2].dump(),
            R"({"id":"007","radius":0.4,"speed":2,"start":[4,3],"goal":[4,3],"motions":[]})");
  EXPECT_EQ(document["trajectories"][0]["motions"][0].dump(),
            R"({"t0":0,"t1":0.3333333333333333,"x0":0,"y0":0,"x1":0,"y1":0})");
}

TEST(IoSolution, JsonHoldsWhatXmlHolds) {
  const Instance instance = awkward_instance();
  const std::string text = solution_to_json(instance, awkward_document(instance));
  const auto complaint = [&](const char* key, const nlohmann::ordered_json& value) {
    auto document = nlohmann::ordered_json::parse(text);
    document[key] = value;
    const Input<SolutionDocument> read = parse_solution(document.dump(), "s", instance);
    return read ? std::string("none") : read.error().message();
  };
  EXPECT_EQ(complaint("ssi", 1e7), "none");
  EXPECT_NE(complaint("ssi", 1e8), "none");
  EXPECT_NE(complaint("ssi_kept", 1e300), "none");
  EXPECT_NE(complaint("tries", UINT64_MAX), "none");
  EXPECT_NE(complaint("planning_seconds", -1), "none");
  EXPECT_NE(complaint("makespan", -1), "none");
}

TEST(IoSolution, RulesOfMotionNeedNoStartSafeInterval) {
  const Instance instance = awkward_instance();
  auto document = nlohmann::json::parse(solution_to_json(instance, awkward_document(instance)));
  document.erase("ssi");
  EXPECT_FALSE(parse_solution(document.dump(), "s", instance)->options);
  document["turns"] = true;
  document["wait_before_move"] = 0.5;
  const Input<SolutionDocument> read = parse_solution(document.dump(), "s", instance);
  ASSERT_TRUE(read && read->options);
  EXPECT_TRUE(read->options->rules.turns);
  EXPECT_EQ(read->options->rules.wait_before_move_s, 0.5);
  EXPECT_EQ(read->options->ssi_s, 0);
}

TEST(IoSolution, NothingFoundIsNullAndReadsBack) {
  const Instance instance = awkward_instance();
  SolutionDocument document;
  document.status = "limit";
  document.order = {0, 1, 2};
  document.planning_seconds = std::numeric_limits<double>::infinity();
  const auto json = nlohmann::json::parse(solution_to_json(instance, document));
  EXPECT_TRUE(json["makespan"].is_null());
  EXPECT_TRUE(json["planning_seconds"].is_null());
  EXPECT_TRUE(json["plan_hash"].is_null());
  EXPECT_TRUE(json["trajectories"].empty());
  document.planning_seconds = 1.5;
  for (const char* const format : {"json", "xml"}) {
    const Input<SolutionDocument> read =
        parse_solution(*write_solution(format, instance, document), "s", instance);
    ASSERT_TRUE(read) << read.error().message();
    expect_equal(*read, document);
  }
}

TEST(IoSolution, ZeroRobots) {
  const Instance instance;
  SolutionDocument document;
  document.makespan_s = document.flowtime_s = 0;
  for (const char* const format : {"json", "xml", "csv"}) {
    const Input<SolutionDocument> read =
        parse_solution(*write_solution(format, instance, document), "s", instance);
    ASSERT_TRUE(read) << read.error().message();
    EXPECT_EQ(read->status, "solved");
    EXPECT_TRUE(read->solution.trajectories.empty());
  }
}

TEST(IoSolution, XmlHoldsTheInstanceAsWell) {
  const Instance instance = awkward_instance();
  const std::string text = solution_to_xml(instance, awkward_document(instance));
  const Input<InstanceParts> parts = parse_xml_instance(text, "s");
  ASSERT_TRUE(parts) << parts.error().message();
  EXPECT_TRUE(parts->warnings.empty());
  EXPECT_EQ(parts->map->map, instance.map);
  EXPECT_EQ(parts->agents->items, instance.agents);
  EXPECT_EQ(parts->options->options.applied_to({}).ssi_s, 2.5);
}

TEST(IoSolution, WrongSolutionsAreWrittenAndReadAsTheyAre) {
  const Instance instance = awkward_instance();
  SolutionDocument document;
  // A gap in time and place, a move in no time, times that run backwards.
  document.solution.trajectories = {{{1, 1}, {{2, 1, {1, 1}, {1, 1}}, {5, 6, {3, 3}, {4, 4}}}},
                                    {{0, 2}, {{0, 0, {0, 2}, {7, 0}}}},
                                    {{4, 3}, {{-1, 1e308, {4, 3}, {-4, 3}}}}};
  for (const char* const format : {"json", "xml", "csv"}) {
    const Input<SolutionDocument> read =
        parse_solution(*write_solution(format, instance, document), "s", instance);
    ASSERT_TRUE(read) << read.error().message();
    EXPECT_EQ(read->solution, document.solution);
  }
}

TEST(IoSolution, ARobotThatNeverMovesHasAPlaceInEveryFormat) {
  Instance instance = awkward_instance();
  SolutionDocument document;
  // The last one stands beside its start, and the second one's first motion begins elsewhere.
  document.solution.trajectories = {
      {{0, 0}, {}}, {{0, 3}, {{0, 0, {0, 2}, {0, 2}}, {0, 1, {0, 2}, {7, 0}}}}, {{4, 2}, {}}};
  for (const char* const format : {"json", "xml", "csv"}) {
    const Input<SolutionDocument> read =
        parse_solution(*write_solution(format, instance, document), "s", instance);
    ASSERT_TRUE(read) << read.error().message();
    EXPECT_EQ(read->solution, document.solution);
  }
  const Input<SolutionDocument> plain = parse_solution("0: (0,0,0)\n1: (0,3,0)\n2: (4,2,0)\n", "s", instance);
  ASSERT_TRUE(plain) << plain.error().message();
  EXPECT_EQ(plain->solution.trajectories[2].start, (Cell{4, 2}));
}

TEST(IoSolution, StatedPlacesAreCells) {
  const Instance instance = awkward_instance();
  const auto complaint = [&](const std::string& places) {
    return error_of(R"({"trajectories": [{"id": "007", )" + places + R"(, "motions": []}]})", instance);
  };
  EXPECT_EQ(complaint(R"("goal": [4])"),
            "s:1: trajectories[0].goal is missing or of the wrong kind, expected a cell, [x, y]");
  EXPECT_EQ(
      complaint(R"("start": [4, 0.5])"),
      "s:1: trajectories[0].start[1] is missing or of the wrong kind, expected an integer within 32 bits");
}

TEST(IoSolution, RobotsAreToldById) {
  const Instance instance = awkward_instance();
  const std::string text =
      R"({"trajectories": [{"id": "007", "motions": []}, {"id": 0, "motions": [{"t0": 0, "t1": 1, "x0": 0, "y0": 0, "x1": 1, "y1": 0}]},
          {"id": "a \"b\", <c> & d\né", "motions": []}]})";
  const Input<SolutionDocument> read = parse_solution(text, "s", instance);
  ASSERT_TRUE(read) << read.error().message();
  EXPECT_EQ(read->solution.trajectories[0].motions.size(), 1u);
  EXPECT_EQ(read->solution.trajectories[2].start, (Cell{4, 3}));
}

TEST(IoSolution, BadJsonNamesTheLine) {
  const Instance instance = awkward_instance();
  EXPECT_EQ(error_of("{\n\"status\": \"solved\",\n", instance),
            "s:3: not well-formed JSON, expected a complete document");
  EXPECT_EQ(error_of("{\"makespan\": 1e999}", instance),
            "s:1: not well-formed JSON, expected a complete document");
  EXPECT_EQ(error_of("{}", instance), "s:1: trajectories is missing or of the wrong kind, expected a list");
  EXPECT_EQ(error_of(R"({"status": "won", "trajectories": []})", instance),
            "s:1: status is missing or of the wrong kind, expected solved, failed or limit");
  EXPECT_EQ(error_of(R"({"robots": 2, "trajectories": []})", instance),
            "s:1: robots is 2, expected the 3 of the instance");
  EXPECT_EQ(
      error_of(R"({"order": [3], "trajectories": []})", instance),
      "s:1: order[0] is missing or of the wrong kind, expected the position of a robot, counted from 0");
  EXPECT_EQ(error_of(R"({"trajectories": [{"id": 5, "motions": []}]})", instance),
            "s:1: robot '5' that the instance does not have, expected one trajectory for each robot of the "
            "instance");
  EXPECT_EQ(error_of(R"({"trajectories": [{"id": 0, "motions": []}, {"id": 0, "motions": []}]})", instance),
            "s:1: a second trajectory of robot '0', expected one trajectory for each robot of the instance");
  EXPECT_EQ(
      error_of(R"({"trajectories": [{"id": 0, "motions": []}]})", instance),
      "s:1: no trajectory of robot 'a \"b\", <c> & d?\xc3\xa9', expected one for each robot of the instance");
  EXPECT_EQ(error_of(R"({"trajectories": [{"id": 0, "motions": [{"t0": 0, "t1": "1"}]}]})", instance),
            "s:1: trajectories[0].motions[0].t1 is missing or of the wrong kind, expected a finite number");
  EXPECT_EQ(
      error_of(
          R"({"trajectories": [{"id": 0, "motions": [{"t0": 0, "t1": 1, "x0": 18446744073709551615}]}]})",
          instance),
      "s:1: trajectories[0].motions[0].x0 is missing or of the wrong kind, expected an integer within 32 "
      "bits");
  EXPECT_EQ(error_of("{\"trajectories\": [\n{\"id\": 0,\n\"motions\": [{\n\"t0\": 0,\n\"t1\": \"1\"}]}]}",
                     instance),
            "s:5: trajectories[0].motions[0].t1 is missing or of the wrong kind, expected a finite number");
  EXPECT_EQ(error_of("{\n\"trajectories\":\n[{\"id\": 0, \"motions\": []},\n{\"id\": 5, \"motions\": []}]}",
                     instance),
            "s:4: robot '5' that the instance does not have, expected one trajectory for each robot of the "
            "instance");
}

TEST(IoSolution, BadXmlAndCsvNameTheLine) {
  const Instance instance = awkward_instance();
  EXPECT_EQ(error_of("<root>\n</root>", instance),
            "s:1: no <log> in <root>, expected one with the trajectories");
  EXPECT_EQ(error_of("<root>\n<log>\n<agent id=\"0\"/></log></root>", instance),
            "s:3: no <path> in <agent>, expected one");
  EXPECT_EQ(error_of("<root>\n<log>\n</log></root>", instance),
            "s:2: no <agent> for robot '0', expected one for each robot of the instance");
  EXPECT_EQ(error_of("<root>\n<log>\n<summary planhash=\"54\xc3\"/></log></root>", instance),
            "s:3: planhash '54?' in <summary>, expected UTF-8 text");
  EXPECT_EQ(error_of("<root>\n<log><order>0 9</order></log></root>", instance),
            "s:2: '9' in <order>, expected the position of a robot, counted from 0");
  const std::string header = "agent,id,t0,t1,x0,y0,x1,y1\n";
  EXPECT_EQ(error_of("agent,t0\n", instance), "s:1: header 'agent,t0', expected agent,id,t0,t1,x0,y0,x1,y1");
  EXPECT_EQ(error_of(header + "0,0,0,1,0,0,1\n", instance),
            "s:2: 7 fields, expected 8: agent,id,t0,t1,x0,y0,x1,y1");
  EXPECT_EQ(error_of(header + "0,0,0,1,0,0,1,0,0,0\n", instance),
            "s:2: too many fields, expected 8: agent,id,t0,t1,x0,y0,x1,y1");
  EXPECT_EQ(error_of(header + "3,0,0,1,0,0,1,0\n", instance), "s:2: agent '3', expected a position below 3");
  EXPECT_EQ(error_of(header + "0,1,0,1,0,0,1,0\n", instance),
            "s:2: id '1', expected that of the instance, '0'");
  EXPECT_EQ(error_of(header + "0,0,0,nan,0,0,1,0\n", instance), "s:2: time 'nan', expected a number");
  EXPECT_EQ(error_of(header + "0,0,0,1,0,0,1,0.5\n", instance), "s:2: coordinate '0.5', expected a number");
  EXPECT_EQ(error_of(header + "0,\"0\n\n", instance),
            "s:2: a quote that is not closed, expected a closing \"");
  EXPECT_EQ(error_of("", instance).substr(0, 16), "s:1: empty file,");
  EXPECT_EQ(error_of("hello", instance).substr(0, 20), "s:1: not a solution,");
}

TEST(IoSolution, WrittenInstancesReadBackEqual) {
  Instance instance = awkward_instance();
  instance.map.set_blocked({2, 1}, true);
  instance.agents[0].rotation_speed = 0.3;
  instance.agents[0].start_heading_deg = 12.5;
  instance.obstacles = {
      {"o<1>", 1.0 / 3, {{6, 1}, {{0, 0.1, {6, 1}, {6, 1}}, {0.1, 0.1 + 1.0 / 3, {6, 1}, {5, 1}}}}},
      {"still", 0.2, {{6, 3}, {}}}};
  const Input<InstanceParts> parts = parse_xml_instance(write_instance_xml(instance), "f");
  ASSERT_TRUE(parts) << parts.error().message();
  EXPECT_TRUE(parts->warnings.empty());
  EXPECT_EQ((Instance{parts->map->map, parts->agents->items, parts->obstacles->items}), instance);
}

}  // namespace
}  // namespace sipplab
