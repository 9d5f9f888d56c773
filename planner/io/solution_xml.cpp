// Solutions in the style of AA-SIPP(m)'s log: see solution_io.hpp.
#include <cmath>
#include <limits>
#include <utility>

#include "planner/io/solution_parts.hpp"
#include "planner/io/step_plan.hpp"
#include "planner/io/text.hpp"
#include "planner/io/write_xml.hpp"
#include "planner/io/xml_options.hpp"
#include "planner/io/xml_reader.hpp"
#include "planner/io/xml_sections.hpp"
#include "sipplab/error.hpp"

namespace sipplab {
namespace {

using pugi::xml_node;

constexpr NumberRange kTimes{0, std::numeric_limits<double>::max(), "a number from 0"};
/// Counts are read as doubles; up to here each is exact.
constexpr NumberRange kCounts{0, 0x1p53, "a number from 0"};

void add_summary(xml_node log, const Instance& instance, const SolutionDocument& document) {
  xml_node node = log.append_child("summary");
  const auto add_count = [&node](const char* name, std::uint64_t count) {
    node.append_attribute(name) = static_cast<unsigned long long>(count);
  };
  add_attribute(node, "runtime", document.planning_seconds);
  add_count("tries", document.tries);
  if (document.status == "solved") {
    add_attribute(node, "agentssolved", std::to_string(instance.agents.size()) + " (100%)");
  }
  if (document.flowtime_s) add_attribute(node, "flowtime", *document.flowtime_s);
  if (document.makespan_s) add_attribute(node, "makespan", *document.makespan_s);
  add_attribute(node, "status", document.status);
  node.append_attribute("valid") = document.valid;
  add_count("expansions", document.expansions);
  add_count("generations", document.generations);
  if (!document.plan_hash.empty()) add_attribute(node, "planhash", document.plan_hash);
  if (!document.made_by.empty()) add_attribute(node, "madeby", document.made_by);
  if (document.ssi_kept_s) add_attribute(node, "ssikept", format_ssi(*document.ssi_kept_s));
}

void add_order(xml_node log, const std::vector<AgentIndex>& order) {
  std::string text;
  for (const AgentIndex agent : order) {
    if (!text.empty()) text += ' ';
    text += std::to_string(agent);
  }
  add_text(log, "order", text);
}

void add_trajectory(xml_node log, const Agent& agent, const Trajectory& trajectory, bool with_headings) {
  xml_node node = log.append_child("agent");
  add_attribute(node, "id", agent.id);
  node.append_attribute("start.x") = trajectory.start.x;
  node.append_attribute("start.y") = trajectory.start.y;
  if (with_headings) add_attribute(node, "start.heading", agent.start_heading_deg);
  node.append_attribute("goal.x") = agent.goal.x;
  node.append_attribute("goal.y") = agent.goal.y;
  if (with_headings) {
    add_attribute(node, "goal.heading",
                  agent.goal_heading_deg ? format_real(*agent.goal_heading_deg) : "whatever");
  }
  add_attribute(node, "size", agent.radius_cells);
  add_attribute(node, "movespeed", agent.speed_cells_per_s);
  add_attribute(node, "rotationspeed", agent.rotation_speed);
  xml_node path = node.append_child("path");
  path.append_attribute("pathfound") = true;
  add_attribute(path, "duration", trajectory.arrival_s());
  add_sections(path, trajectory, with_headings ? std::optional(agent.start_heading_deg) : std::nullopt);
}

std::uint64_t read_count(XmlReader& reader, xml_node node, const char* name) {
  return static_cast<std::uint64_t>(reader.optional_real(node, name, kCounts).value_or(0));
}

/// The published planner says how many robots it solved, "21 (65.625000%)", and no status.
const char* implied_status(xml_node summary, const Instance& instance) {
  const std::string_view text = trimmed(summary.attribute("agentssolved").value());
  const auto solved = parse_integer(text.substr(0, text.find(' ')));
  return solved && *solved < static_cast<std::int64_t>(instance.agents.size()) ? "failed" : "solved";
}

void read_summary(XmlReader& reader, xml_node summary, const Instance& instance, SolutionDocument& document) {
  document.planning_seconds = reader.optional_real(summary, "runtime", kTimes).value_or(0);
  for (const char* const name : {"runtime", "time", "tries", "flowtime", "makespan"}) {
    add_report(document, name, summary.attribute(name).value());
  }
  document.makespan_s = reader.optional_real(summary, "makespan", kTimes);
  document.flowtime_s = reader.optional_real(summary, "flowtime", kTimes);
  document.tries = read_count(reader, summary, "tries");
  document.expansions = read_count(reader, summary, "expansions");
  document.generations = read_count(reader, summary, "generations");
  document.status = summary.attribute("status").as_string(implied_status(summary, instance));
  if (document.status != "solved" && document.status != "failed" && document.status != "limit") {
    reader.fail(summary, "status " + in_quotes(document.status), "solved, failed or limit");
  }
  document.valid = std::string_view(summary.attribute("valid").value()) == "true";
  document.plan_hash = reader.words(summary, "planhash");
  document.made_by = reader.words(summary, "madeby");
  if (const auto ssi_kept = summary.attribute("ssikept")) {
    document.ssi_kept_s = parse_ssi(ssi_kept.value());
    if (!document.ssi_kept_s) {
      reader.fail(summary, "ssikept " + in_quotes(ssi_kept.value()), "seconds from 0, or inf");
    }
  }
  // Where files of version 1.0 have it.
  if (const auto seed = summary.attribute("seed"); seed && document.options) {
    document.options->seed = seed.as_ullong();
  }
}

void read_order(XmlReader& reader, xml_node node, const Instance& instance, std::vector<AgentIndex>& order) {
  const std::string text = XmlReader::text_of(node);
  std::string_view rest = trimmed(text);
  while (!rest.empty()) {
    const std::string_view token = rest.substr(0, rest.find_first_of(" \t\r\n"));
    const auto agent = parse_integer(token);
    if (!agent || *agent < 0 || static_cast<std::uint64_t>(*agent) >= instance.agents.size()) {
      return reader.fail(node, in_quotes(token) + " in <order>", "the position of a robot, counted from 0");
    }
    order.push_back(static_cast<AgentIndex>(*agent));
    rest = trimmed(rest.substr(token.size()));
  }
}

/// Of the robot in this <agent>, in cells per second. The published log rounds it;
/// where it stands for the instance's speed, that one counts.
std::optional<double> speed_of(XmlReader& reader, xml_node element, const Instance& instance,
                               std::size_t position) {
  constexpr double kLogRounding = 1e-6;  // relative; 8 digits are written
  constexpr NumberRange kSpeeds{kMinSpeedCellsPerS, kMaxSpeedCellsPerS, "a speed in cells per second"};
  const std::optional<double> logged = reader.optional_real(element, "movespeed", kSpeeds);
  if (!logged || position >= instance.agents.size()) return logged;
  const double exact = instance.agents[position].speed_cells_per_s;
  return std::abs(*logged - exact) <= kLogRounding * exact ? exact : *logged;
}

/// Leaves the solution empty when a robot has no path.
void read_trajectories(XmlReader& reader, xml_node log, const Instance& instance,
                       SolutionDocument& document) {
  TrajectoryCollector collector(instance);
  std::size_t position = 0;
  for (const xml_node element : log.children("agent")) {
    const xml_node path = reader.only_child(element, "path");
    if (!path) return reader.fail(element, "no <path> in <agent>", "one");
    if (std::string_view(path.attribute("pathfound").as_string("true")) == "false") {
      if (document.status == "solved") document.status = "failed";
      return;
    }
    SectionOptions options{speed_of(reader, element, instance, position), true, nullptr};
    if (position < instance.agents.size()) options.robot = &instance.agents[position];
    if (element.attribute("number")) {  // Continuous-CBS: robots have numbers, and cells rows and columns
      options.names = kRowsAndColumns;
      options.robot = nullptr;
      if (position < instance.agents.size()) {
        options.speed_cells_per_s = instance.agents[position].speed_cells_per_s;
      }
    }
    const pugi::xml_attribute id = element.attribute("id");
    Trajectory trajectory = read_sections(reader, path, options);
    std::optional<Cell> start;
    if (element.attribute("start.x")) start = read_cell(reader, element, "start.x", "start.y");
    if (reader.failed()) return;
    const std::string problem = collector.add(id ? std::optional<std::string>(id.value()) : std::nullopt,
                                              position++, std::move(trajectory), start);
    if (!problem.empty()) return reader.fail(element, problem, "one <agent> for each robot of the instance");
  }
  if (position == 0 && document.status != "solved") return;
  if (position == 0 && log.parent().child("agent").attribute("start_i")) {
    document.status = "failed";  // how Continuous-CBS says that it found none
    return;
  }
  if (const auto missing = collector.missing()) {
    return reader.fail(log, "no <agent> for robot " + in_quotes(instance.agents[*missing].id),
                       "one for each robot of the instance");
  }
  document.solution = collector.take();
}

bool is_xml(std::string_view head) {
  return head.substr(0, 1) == "<" || head.substr(0, 4) == "\xef\xbb\xbf<";
}

Input<SolutionDocument> parse_solution_xml(std::string_view text, const std::string& file_name,
                                           const Instance& instance) {
  Input<std::unique_ptr<XmlReader>> parsed = XmlReader::parse(text, file_name);
  if (!parsed) return Unexpected{parsed.error()};
  XmlReader& reader = **parsed;
  const xml_node log = reader.only_child(reader.root(), "log");
  if (!log) reader.fail(reader.root(), "no <log> in <root>", "one with the trajectories");
  SolutionDocument document;
  if (const auto options = read_options(reader)) {
    document.options = options->options.applied_to({});
  }
  read_summary(reader, reader.only_child(log, "summary"), instance, document);
  read_order(reader, reader.only_child(log, "order"), instance, document.order);
  if (!reader.failed()) read_trajectories(reader, log, instance, document);
  if (reader.failed()) return Unexpected{reader.error()};
  return document;
}

}  // namespace

std::string solution_to_xml(const Instance& instance, const SolutionDocument& document) {
  const std::vector<Trajectory>& trajectories = document.solution.trajectories;
  PLANNER_ASSERT(trajectories.empty() || trajectories.size() == instance.agents.size());
  pugi::xml_document file;
  xml_node root = file.append_child("root");
  add_instance(root, instance);
  if (document.options) add_options(root, *document.options);
  xml_node log = root.append_child("log");
  add_summary(log, instance, document);
  add_order(log, document.order);
  const bool with_headings = has_turns(document.solution);
  for (std::size_t i = 0; i < trajectories.size(); ++i) {
    add_trajectory(log, instance.agents[i], trajectories[i], with_headings);
  }
  return file_text(file);
}

SolutionFormat xml_format() {
  return {"xml", "XML in the style of AA-SIPP(m)'s log", is_xml, parse_solution_xml, always<solution_to_xml>};
}

}  // namespace sipplab
