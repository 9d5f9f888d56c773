// Formats: what is written reads back as it was, different formats mean the same, and
// damaged texts are refused in one line.
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <iterator>
#include <nlohmann/json.hpp>
#include <optional>
#include <ostream>
#include <pugixml.hpp>
#include <set>
#include <string>
#include <vector>

#include "planner/io/movingai.hpp"
#include "planner/io/text_file.hpp"
#include "planner/io/xml_instance.hpp"
#include "property_tests/support/encounters.hpp"
#include "property_tests/support/generators.hpp"
#include "property_tests/support/property.hpp"
#include "property_tests/support/scratch_folder.hpp"
#include "property_tests/support/shown.hpp"
#include "property_tests/support/texts.hpp"
#include "sipplab/instance_io.hpp"
#include "sipplab/solution_io.hpp"

namespace sipplab::formats_laws {
namespace {

constexpr const char* kFile = "some/file";

// --- instances that hold everything a format has to keep ----------------------------

rc::Gen<Cell> any_far_cell() {
  return rc::gen::weightedOneOf<Cell>(
      {{4, any_cell(9, 9)}, {1, rc::gen::exec([] {
                               const auto x = *rc::gen::arbitrary<std::int32_t>();
                               return Cell{x, *rc::gen::arbitrary<std::int32_t>()};
                             })}});
}

rc::Gen<double> any_radius_allowed() {
  return rc::gen::weightedOneOf<double>({{3, any_radius()}, {1, any_real_between(1e-9, kMaxRadiusCells)}});
}

rc::Gen<double> any_speed_allowed() {
  return rc::gen::weightedOneOf<double>(
      {{3, any_speed()}, {1, any_real_between(kMinSpeedCellsPerS, kMaxSpeedCellsPerS)}});
}

rc::Gen<double> any_heading() { return any_real_between(0, std::nextafter(360.0, 0.0)); }

rc::Gen<Agent> any_agent() {
  return rc::gen::exec([] {
    Agent agent;
    agent.id = *any_text();
    agent.start = *any_far_cell();
    agent.goal = *any_far_cell();
    agent.radius_cells = *any_radius_allowed();
    agent.speed_cells_per_s = *any_speed_allowed();
    if (*any_of({false, false, true})) agent.start_heading_deg = *any_heading();
    if (*any_of({false, true})) agent.goal_heading_deg = *any_heading();
    if (*any_of({false, false, true})) agent.rotation_speed = *any_real_between(1e-3, 1e3);
    return agent;
  });
}

rc::Gen<DynamicObstacle> any_obstacle() {
  return rc::gen::exec([] {
    const std::string id = *any_text();
    const double radius_cells = *any_radius_allowed();
    return DynamicObstacle{id, radius_cells, (*any_walk(9, 9)).trajectory()};
  });
}

rc::Gen<GridMap> any_map() {
  return rc::gen::exec([] {
    const auto any_side = rc::gen::resize(rc::kNominalSize, rc::gen::inRange<std::int32_t>(1, 12));
    const auto width = *any_side;
    GridMap map(width, *any_side);
    const auto blocked = *rc::gen::container<std::vector<bool>>(map.cell_count(), rc::gen::arbitrary<bool>());
    for (std::size_t i = 0; i < blocked.size(); ++i) map.set_blocked(map.cell(i), blocked[i]);
    return map;
  });
}

/// Need not keep the rules of find_error: a format keeps what it is given.
rc::Gen<Instance> any_instance() {
  return rc::gen::exec([] {
    Instance instance;
    instance.map = *any_map();
    instance.agents = *rc::gen::resize(6, rc::gen::container<std::vector<Agent>>(any_agent()));
    instance.obstacles =
        *rc::gen::resize(3, rc::gen::container<std::vector<DynamicObstacle>>(any_obstacle()));
    return instance;
  });
}

/// The parts of one file as an instance; nothing if it holds no map.
std::optional<Instance> joined(InstanceParts parts) {
  if (!parts.map) return std::nullopt;
  Instance instance;
  instance.map = std::move(parts.map->map);
  if (parts.agents) instance.agents = std::move(parts.agents->items);
  if (parts.obstacles) instance.obstacles = std::move(parts.obstacles->items);
  return instance;
}

void check_instance_survives(const Instance& instance) {
  const auto parts = parse_xml_instance(write_instance_xml(instance), kFile);
  RC_ASSERT(parts.has_value());
  RC_ASSERT(parts->warnings.empty());
  const auto read = joined(*parts);
  RC_ASSERT(read.has_value());
  RC_ASSERT(read->map == instance.map);
  RC_ASSERT(read->agents == instance.agents);
  RC_ASSERT(read->obstacles == instance.obstacles);
  RC_ASSERT(content_hash(*read) == content_hash(instance));
}

// --- the same problem in several formats --------------------------------------------

/// The dialect of the AAMAS 2018 archive.
std::string archive_xml(const Instance& instance) {
  const auto element = [](const std::string& name, std::int64_t value) {
    return "<" + name + ">" + std::to_string(value) + "</" + name + ">\n";
  };
  const GridMap& map = instance.map;
  std::string text = "<root>\n<map>\n" + element("width", map.width()) + element("height", map.height());
  text += element("agents", static_cast<std::int64_t>(instance.agents.size()));
  for (const Agent& agent : instance.agents) {
    text += element("startx", agent.start.x) + element("starty", agent.start.y) +
            element("finishx", agent.goal.x) + element("finishy", agent.goal.y);
  }
  text += "<grid>\n";
  for (std::int32_t y = 0; y < map.height(); ++y) {
    text += "<row>";
    for (std::int32_t x = 0; x < map.width(); ++x) text += map.is_blocked({x, y}) ? "1 " : "0 ";
    text += "</row>\n";
  }
  return text + "</grid>\n</map>\n</root>\n";
}

std::string hash_of(const InstanceFiles& files) {
  InstanceFiles all = files;
  all.allow_unreachable = true;
  const auto loaded = load_instance(all);
  if (!loaded) RC_FAIL(loaded.error().message());
  return content_hash(loaded->instance);
}

void means_the_same(PlanCase plan_case) {
  Instance& instance = plan_case.instance;
  // What all formats can say.
  instance.obstacles.clear();
  for (Agent& agent : instance.agents) agent.radius_cells = kDefaultRadiusCells;
  for (Agent& agent : instance.agents) agent.speed_cells_per_s = kDefaultSpeedCellsPerS;
  RC_PRE(!find_error(instance));

  const ScratchFolder folder;
  const auto file = [&folder](const char* name, const std::string& text) {
    const std::string path = (folder.path() / name).string();
    RC_ASSERT(!write_file(path, text));
    return path;
  };
  const std::string xml = file("one", write_instance_xml(instance));
  const std::string map = file("two", write_movingai_map(instance.map));
  const std::string scenario = file("three", write_movingai_scen(instance, "two"));
  const std::string archive = file("four", archive_xml(instance));
  Instance empty;
  empty.map = instance.map;
  const std::string map_xml = file("five", write_instance_xml(empty));

  const std::string expected = content_hash(instance);
  const auto files = [](std::optional<std::string> whole, std::optional<std::string> map_file,
                        std::optional<std::string> task) {
    InstanceFiles result;
    result.instance = std::move(whole);
    result.map = std::move(map_file);
    result.task = std::move(task);
    return result;
  };
  RC_ASSERT(hash_of(files(xml, {}, {})) == expected);
  RC_ASSERT(hash_of(files(archive, {}, {})) == expected);
  RC_ASSERT(hash_of(files({}, map, scenario)) == expected);
  RC_ASSERT(hash_of(files({}, map_xml, scenario)) == expected);
  RC_ASSERT(hash_of(files({}, map, xml)) == expected);
  RC_ASSERT(hash_of(files({}, map, archive)) == expected);
  if (!instance.agents.empty()) RC_ASSERT(hash_of(files(scenario, {}, {})) == expected);
  RC_CLASSIFY(instance.agents.empty(), "no robots");
  RC_CLASSIFY(instance.map.blocked_count() > 0, "blocked cells");
}

// --- solutions ----------------------------------------------------------------------

struct Told {
  Instance instance;
  SolutionDocument document;
};

/// Walks of random robots, right or wrong, and everything that is told about a plan.
Told any_told() {
  Told told;
  Scene scene = *any_scene();
  std::set<std::string> ids;
  for (Agent& agent : scene.instance.agents) {
    agent.id = *any_text();
    while (!ids.insert(agent.id).second) agent.id += 'x';
  }
  // Times that no planner would make.
  if (*rc::gen::inRange(0, 4) == 0) {
    for (Trajectory& trajectory : scene.solution.trajectories) {
      for (TimedMotion& motion : trajectory.motions) {
        motion.begin_s = *any_real_between(-1e6, 1e6);
        motion.end_s = *any_real_between(-1e300, 1e300);
      }
    }
  }
  // Some waits are turns, a few of them to where the robot faces already.
  if (*rc::gen::inRange(0, 3) == 0) {
    for (Trajectory& trajectory : scene.solution.trajectories) {
      for (TimedMotion& motion : trajectory.motions) {
        if (motion.is_wait())
          motion.turn_to_deg = *rc::gen::oneOf(any_of({0.0, 90.0}), any_real_between(-400, 400));
      }
    }
  }
  told.instance = std::move(scene.instance);
  SolutionDocument& document = told.document;
  document.status = *rc::gen::weightedElement<std::string>({{6, "solved"}, {1, "failed"}, {1, "limit"}});
  if (document.status == "solved") {
    document.solution = std::move(scene.solution);
    document.makespan_s = *any_real_between(0, 1e6);
    document.flowtime_s = *any_real_between(0, 1e9);
    document.plan_hash = plan_hash(document.solution);
    document.valid = *rc::gen::arbitrary<bool>();
    document.made_by = *rc::gen::element<std::string>("", "prioritized", "complete");
    if (*rc::gen::arbitrary<bool>()) document.ssi_kept_s = *any_of({0.0, 2.5, 1.0 / 3, kInfiniteSsi});
  }
  for (AgentIndex i = told.instance.agents.size(); i > 0; --i) document.order.push_back(i - 1);
  document.tries = *rc::gen::arbitrary<std::uint32_t>();
  document.expansions = *rc::gen::inRange<std::uint64_t>(0, std::uint64_t{1} << 53);
  document.generations = *rc::gen::arbitrary<std::uint32_t>();
  document.planning_seconds = *any_real_between(0, 1e5);
  if (*rc::gen::inRange(0, 3) > 0) {
    document.options = any_case_of(CaseFamily::kScattered)(rc::Random(1), 1).value().options;
    document.options->ssi_s = *any_of({0.0, 2.5, 1.0 / 3, kInfiniteSsi});
    document.options->order = static_cast<InitialOrder>(*rc::gen::inRange(0, 4));
    document.options->rescheduling = static_cast<Rescheduling>(*rc::gen::inRange(0, 3));
    document.options->any_angle = *rc::gen::arbitrary<bool>();
    document.options->connectedness = *rc::gen::inRange(2, 6);
    document.options->weight = *rc::gen::oneOf(rc::gen::just(1.0), any_real_between(1, kMaxWeight));
    document.options->seed = *rc::gen::arbitrary<std::uint64_t>();
    MotionRules& rules = document.options->rules;
    rules.turns = *rc::gen::arbitrary<bool>();
    for (double* margin : {&rules.wait_before_move_s, &rules.inflate_distance_cells, &rules.inflate_time_s}) {
      *margin = *rc::gen::oneOf(rc::gen::just(0.0), any_real_between(0, kMaxMotionMargin));
    }
  }
  return told;
}

void check_solution_survives(const Told& told, std::string_view format) {
  const SolutionDocument& written = told.document;
  const auto read = parse_solution(*write_solution(format, told.instance, written), kFile, told.instance);
  if (!read) RC_FAIL(read.error().message());
  if (format == "csv") {
    if (written.status == "solved") RC_ASSERT(read->solution == written.solution);
    return;
  }
  RC_ASSERT(read->solution == written.solution);
  RC_ASSERT(read->status == written.status);
  RC_ASSERT(read->valid == written.valid);
  RC_ASSERT(read->order == written.order);
  RC_ASSERT(read->makespan_s == written.makespan_s);
  RC_ASSERT(read->flowtime_s == written.flowtime_s);
  RC_ASSERT(read->tries == written.tries);
  RC_ASSERT(read->expansions == written.expansions);
  RC_ASSERT(read->generations == written.generations);
  RC_ASSERT(read->planning_seconds == written.planning_seconds);
  RC_ASSERT(read->plan_hash == written.plan_hash);
  RC_ASSERT(read->made_by == written.made_by);
  RC_ASSERT(read->ssi_kept_s == written.ssi_kept_s);
  RC_ASSERT(read->options == written.options);
}

constexpr std::string_view kSolutionFormats[] = {"xml", "json", "csv"};  // those that tell any solution

// --- what is told and not read back ---------------------------------------------------

double any_number() { return *rc::gen::inRange(0, 4000) / 8.0; }

PlanCost any_cost() { return {any_number(), any_number()}; }

/// A plan with everything that JSON tells beside it.
Told any_story() {
  Told told = any_told();
  SolutionDocument& document = told.document;
  for (int i = *rc::gen::inRange(0, 3); i > 0; --i) {
    document.ejections.push_back(
        {*rc::gen::inRange<AgentIndex>(0, 9),
         *rc::gen::container<std::vector<AgentIndex>>(rc::gen::inRange<AgentIndex>(0, 9))});
  }
  for (int i = *rc::gen::inRange(0, 3); i > 0; --i) {
    BestStep& step = document.steps.emplace_back();
    step.kind = *rc::gen::element(BestStep::Kind::kMethod, BestStep::Kind::kEscalation,
                                  BestStep::Kind::kEjection, BestStep::Kind::kFallback);
    step.ssi_s = *any_of({0.0, 2.5, kInfiniteSsi});
    step.status = *rc::gen::element(PlanStatus::kSolved, PlanStatus::kFailed, PlanStatus::kLimit);
    step.tries = *rc::gen::inRange<std::size_t>(0, 99);
    step.seconds = any_number();
    step.ended_s = step.seconds + any_number();
    if (step.status == PlanStatus::kSolved) step.cost = any_cost();
  }
  if (*rc::gen::arbitrary<bool>()) {
    ImprovementLog& log = document.improvement.emplace();
    for (int i = *rc::gen::inRange(1, 4); i > 0; --i) {
      log.curve.push_back({any_number(), *rc::gen::inRange<std::uint64_t>(0, 999), any_cost()});
    }
    log.bound = {any_number(), any_number()};
    log.iterations = *rc::gen::inRange<std::uint64_t>(0, 999);
    log.improvements = *rc::gen::inRange<std::uint64_t>(0, 999);
    log.keeps_guarantee = *rc::gen::arbitrary<bool>();
    log.objective = *rc::gen::element(Objective{1, 0}, Objective{0, 1}, Objective{1, 20});
  }
  return told;
}

using Json = nlohmann::json;

bool is_cost(const Json& json, const PlanCost& cost) {
  return json == Json{{"flowtime", cost.flowtime_s}, {"makespan", cost.makespan_s}};
}

double share_above(double cost, double bound) { return cost > bound ? (cost - bound) / cost : 0; }

void json_tells_the_story(const Told& told) {
  const SolutionDocument& document = told.document;
  const Json json = Json::parse(solution_to_json(told.instance, document));
  RC_ASSERT(json.at("robots") == told.instance.agents.size());
  const Json& trajectories = json.at("trajectories");
  RC_ASSERT(trajectories.size() == document.solution.trajectories.size());
  for (std::size_t i = 0; i < trajectories.size(); ++i) {
    const Agent& agent = told.instance.agents[i];
    const Trajectory& trajectory = document.solution.trajectories[i];
    RC_ASSERT(trajectories[i].at("radius") == agent.radius_cells);
    RC_ASSERT(trajectories[i].at("speed") == agent.speed_cells_per_s);
    RC_ASSERT(trajectories[i].at("start") == (Json{trajectory.start.x, trajectory.start.y}));
    RC_ASSERT(trajectories[i].at("goal") == (Json{agent.goal.x, agent.goal.y}));
    const Json& id = trajectories[i].at("id");
    RC_ASSERT((id.is_string() ? id.get<std::string>() : id.dump()) == agent.id);
  }
  const Json ejections = json.value("ejections", Json::array());
  RC_ASSERT(ejections.size() == document.ejections.size());
  for (std::size_t i = 0; i < ejections.size(); ++i) {
    RC_ASSERT(ejections[i].at("failed") == document.ejections[i].failed);
    RC_ASSERT(ejections[i].at("ejected") == Json(document.ejections[i].ejected));
  }
  const Json steps = json.value("steps", Json::array());
  RC_ASSERT(steps.size() == document.steps.size());
  for (std::size_t i = 0; i < steps.size(); ++i) {
    const BestStep& step = document.steps[i];
    RC_ASSERT(steps[i].at("kind") == std::string(name(step.kind)));
    RC_ASSERT(steps[i].at("status") == std::string(name(step.status)));
    RC_ASSERT(steps[i].at("ssi") == (step.ssi_s == kInfiniteSsi ? Json("inf") : Json(step.ssi_s)));
    RC_ASSERT(steps[i].at("tries") == step.tries);
    RC_ASSERT(steps[i].at("seconds") == step.seconds);
    RC_ASSERT(steps[i].at("ended") == step.ended_s);
    RC_ASSERT(steps[i].at("cost").is_null() == !step.cost);
    if (step.cost) RC_ASSERT(is_cost(steps[i].at("cost"), *step.cost));
  }
  RC_ASSERT(json.contains("improvement") == document.improvement.has_value());
  if (!document.improvement) return;
  const Json& improvement = json.at("improvement");
  const ImprovementLog& log = *document.improvement;
  RC_ASSERT(improvement.at("iterations") == log.iterations);
  RC_ASSERT(improvement.at("improvements") == log.improvements);
  RC_ASSERT(improvement.at("ssi_promise") == log.keeps_guarantee);
  RC_ASSERT(improvement.at("objective") == format_objective(log.objective));
  RC_ASSERT(is_cost(improvement.at("lower_bound"), {log.bound.flowtime_s, log.bound.makespan_s}));
  const PlanCost& last = log.curve.back().cost;
  RC_ASSERT(is_cost(improvement.at("gap"), {share_above(last.flowtime_s, log.bound.flowtime_s),
                                            share_above(last.makespan_s, log.bound.makespan_s)}));
  RC_ASSERT(improvement.at("curve").size() == log.curve.size());
  for (std::size_t i = 0; i < log.curve.size(); ++i) {
    Json point = improvement.at("curve")[i];
    RC_ASSERT(point.at("seconds") == log.curve[i].seconds);
    RC_ASSERT(point.at("iteration") == log.curve[i].iteration);
    point.erase("seconds");
    point.erase("iteration");
    RC_ASSERT(is_cost(point, log.curve[i].cost));
  }
}

/// The log in the style of AA-SIPP(m): of each robot what it is, and sections that follow each other.
void log_tells_of_each_robot(const Told& told) {
  const std::vector<Trajectory>& trajectories = told.document.solution.trajectories;
  pugi::xml_document document;
  RC_ASSERT(static_cast<bool>(document.load_string(solution_to_xml(told.instance, told.document).c_str())));
  const pugi::xml_node log = document.child("root").child("log");
  const bool with_headings = has_turns(told.document.solution);
  std::size_t position = 0;
  for (const pugi::xml_node node : log.children("agent")) {
    const Agent& agent = told.instance.agents[position];
    const Trajectory& trajectory = trajectories[position++];
    const auto number = [&](pugi::xml_node of, const char* name) { return of.attribute(name).as_double(-1); };
    RC_ASSERT(number(node, "size") == agent.radius_cells);
    RC_ASSERT(number(node, "movespeed") == agent.speed_cells_per_s);
    RC_ASSERT(number(node, "rotationspeed") == agent.rotation_speed);
    RC_ASSERT(node.attribute("goal.x").as_int() == agent.goal.x);
    RC_ASSERT(node.attribute("goal.y").as_int() == agent.goal.y);
    RC_ASSERT(static_cast<bool>(node.attribute("start.heading")) == with_headings);
    RC_ASSERT(number(node.child("path"), "duration") == trajectory.arrival_s());
    std::optional<double> facing_deg;
    for (const pugi::xml_node section : node.child("path").children("section")) {
      if (!with_headings) continue;
      const double from_deg = number(section, "start.heading");
      const double to_deg = number(section, "goal.heading");
      const int x = section.attribute("goal.x").as_int() - section.attribute("start.x").as_int();
      const int y = section.attribute("goal.y").as_int() - section.attribute("start.y").as_int();
      if (x != 0 || y != 0) {
        const double direction_deg = std::atan2(-y, x) * (180 / std::acos(-1.0));
        RC_ASSERT(std::abs(std::remainder(from_deg - direction_deg, 360)) < 1e-9);
        RC_ASSERT(from_deg == to_deg);
      } else if (facing_deg) {
        RC_ASSERT(from_deg == *facing_deg);
      }
      facing_deg = to_deg;
    }
  }
  RC_ASSERT(position == trajectories.size());
}

// --- damaged texts ------------------------------------------------------------------

/// One line that begins with the file, says something, and names a line of the text if it
/// can; what is missing at the end is on the line after the last.
void check_complaint(const InputError& error, const std::string& text) {
  const std::string message = error.message();
  for (const char c : message) RC_ASSERT(static_cast<unsigned char>(c) >= 0x20);
  RC_ASSERT(message.rfind(std::string(kFile) + ":", 0) == 0u);
  RC_ASSERT(!error.what.empty());
  const auto lines = static_cast<std::ptrdiff_t>(std::count(text.begin(), text.end(), '\n')) + 1;
  RC_ASSERT(error.line >= 0);
  RC_ASSERT(error.line <= lines + 1);
  RC_TAG("refused");
}

void read_damaged_xml(const std::string& text) {
  const auto parts = parse_xml_instance(text, kFile);
  if (!parts) return check_complaint(parts.error(), text);
  for (const std::string& warning : parts->warnings) {
    RC_ASSERT(warning.rfind(kFile, 0) == 0u);
    RC_ASSERT(warning.find('\n') == std::string::npos);
  }
  RC_TAG("read");
  // What was understood is an instance like any other.
  if (const auto instance = joined(*parts)) check_instance_survives(*instance);
}

void read_damaged_solution(const Told& told, const std::string& text) {
  const auto document = parse_solution(text, kFile, told.instance);
  if (!document) return check_complaint(document.error(), text);
  RC_TAG("read");
  if (document->solution.trajectories.empty()) return;
  Told again{told.instance, *document};
  const auto read = parse_solution(solution_to_json(again.instance, again.document), kFile, again.instance);
  RC_ASSERT(read.has_value());
  RC_ASSERT(read->solution == document->solution);
}

const PropertyRoom room("formats", [] {
  bool passed = true;

  passed &= property("an instance reads back from XML as it was", [] {
    const Instance instance = *any_instance();
    check_instance_survives(instance);
    RC_CLASSIFY(!instance.obstacles.empty(), "moving obstacles");
    RC_CLASSIFY(instance.agents.size() > 1, "several robots");
  });

  passed &= property("a map and a scenario read back from MovingAI's formats as they were", [] {
    Instance instance;
    instance.map = *any_map();
    const auto robots = *rc::gen::resize(rc::kNominalSize, rc::gen::inRange<std::size_t>(0, 8));
    for (std::size_t i = 0; i < robots; ++i) {
      Agent agent;
      agent.id = std::to_string(i);
      agent.start = *any_cell(instance.map.width(), instance.map.height());
      agent.goal = *any_cell(instance.map.width(), instance.map.height());
      instance.agents.push_back(agent);
    }
    const auto map = parse_movingai_map(write_movingai_map(instance.map), kFile);
    RC_ASSERT(map.has_value());
    RC_ASSERT(*map == instance.map);
    const auto scenario = parse_movingai_scen(write_movingai_scen(instance, "maps/a.map"), kFile);
    RC_ASSERT(scenario.has_value());
    RC_ASSERT(scenario->agents == instance.agents);
    if (robots == 0) return;
    RC_ASSERT(scenario->map_name == "maps/a.map");
    RC_ASSERT(scenario->map_width == instance.map.width());
    RC_ASSERT(scenario->map_height == instance.map.height());
  });

  passed &=
      property("one problem has one name, whatever format it comes in", [] { means_the_same(*any_case()); });

  passed &= property("a solution reads back from each format as it was", [] {
    const Told told = any_told();
    for (const std::string_view format : kSolutionFormats) check_solution_survives(told, format);
    RC_TAG(told.document.status);
    RC_CLASSIFY(told.document.options.has_value(), "with options");
  });

  passed &= property("JSON tells of robots, ejections, steps and improvement what they are",
                     [] { json_tells_the_story(any_story()); });

  passed &= property("the log in XML tells of each robot what it is, where it faces and when it arrives",
                     [] { log_tells_of_each_robot(any_told()); });

  passed &= property("a damaged XML instance is refused in one line, or is an instance",
                     [] { read_damaged_xml(*any_damage(write_instance_xml(*any_instance()))); });

  passed &= property("a damaged archive instance is refused in one line, or is an instance",
                     [] { read_damaged_xml(*any_damage(archive_xml((*any_case()).instance))); });

  passed &= property("damaged MovingAI files are refused in one line, or read", [] {
    const Instance instance = (*any_case()).instance;
    const std::string map_text = *any_damage(write_movingai_map(instance.map));
    const auto map = parse_movingai_map(map_text, kFile);
    if (!map) check_complaint(map.error(), map_text);
    if (map) RC_ASSERT(*parse_movingai_map(write_movingai_map(*map), kFile) == *map);
    const std::string scenario_text = *any_damage(write_movingai_scen(instance, "a.map"));
    const auto scenario = parse_movingai_scen(scenario_text, kFile);
    if (!scenario) check_complaint(scenario.error(), scenario_text);
    RC_CLASSIFY(map.has_value(), "map read");
    RC_CLASSIFY(scenario.has_value(), "scenario read");
  });

  passed &= property("a damaged solution is refused in one line, or is a solution", [] {
    const Told told = any_told();
    const std::string_view format = *rc::gen::elementOf(
        std::vector<std::string_view>(std::begin(kSolutionFormats), std::end(kSolutionFormats)));
    read_damaged_solution(told, *any_damage(*write_solution(format, told.instance, told.document)));
  });

  return passed;
});

}  // namespace
}  // namespace sipplab::formats_laws
