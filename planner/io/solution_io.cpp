// Telling the formats of solutions apart: see solution_io.hpp.
#include "sipplab/solution_io.hpp"

#include <iterator>

#include "planner/io/solution_parts.hpp"
#include "planner/io/text.hpp"
#include "planner/io/text_file.hpp"
#include "sipplab/error.hpp"

namespace sipplab {

std::optional<SolutionFormat> parse_solution_format(std::string_view text) {
  if (text == "xml") return SolutionFormat::kXml;
  if (text == "json") return SolutionFormat::kJson;
  if (text == "csv") return SolutionFormat::kCsv;
  return std::nullopt;
}

std::string write_solution(SolutionFormat format, const Instance& instance,
                           const SolutionDocument& document) {
  switch (format) {
    case SolutionFormat::kXml:
      return solution_to_xml(instance, document);
    case SolutionFormat::kJson:
      return solution_to_json(instance, document);
    case SolutionFormat::kCsv:
      return solution_to_csv(instance, document);
  }
  PLANNER_ASSERT(false);
  return {};
}

namespace {

using ParseSolution = Input<SolutionDocument> (*)(std::string_view, const std::string&, const Instance&);

Input<SolutionDocument> parse_paths_by(std::string_view text, const std::string& file,
                                       const Instance& instance, CellOrder order) {
  return parse_solution_paths(text, file, instance, order);
}

constexpr SolutionReader kReaders[] = {
    {"xml", "XML in the style of AA-SIPP(m)'s log"},
    {"json", "JSON of this program"},
    {"csv", "CSV of this program"},
    {"lines", "0: (3,4,0) (5,4,2): cells and times"},
    {"aa-sipp", "the published AA-SIPP(m)'s log"},
    {"ccbs", "Continuous-CBS' log"},
    {"lacam", "result text of LaCAM, LaCAM2, LaCAM3 and PIBT"},
    {"paths", "Agent 0: (3,4)->(3,5)->, rows or columns first, as they fit"},
    {"eecbs", "the same, rows first: EECBS, CBSH2-RTC, PBS"},
    {"mapf-lns2", "the same, rows first: MAPF-LNS, MAPF-LNS2"},
    {"paths-xy", "the same, columns first"},
    {"yaml", "schedule of libMultiRobotPlanning"},
    {"tracker", "MAPF-tracker's moves, a line for each robot: 3ru2l"},
    {"tracker-csv", "MAPF-tracker's table"},
};
constexpr ParseSolution kParsers[] = {
    parse_solution_xml,
    parse_solution_json,
    parse_solution_csv,
    parse_solution_plain,
    parse_solution_xml,
    parse_solution_xml,
    parse_solution_lacam,
    [](std::string_view text, const std::string& file, const Instance& instance) {
      return parse_paths_by(text, file, instance, CellOrder::kGuess);
    },
    [](std::string_view text, const std::string& file, const Instance& instance) {
      return parse_paths_by(text, file, instance, CellOrder::kRowsFirst);
    },
    [](std::string_view text, const std::string& file, const Instance& instance) {
      return parse_paths_by(text, file, instance, CellOrder::kRowsFirst);
    },
    [](std::string_view text, const std::string& file, const Instance& instance) {
      return parse_paths_by(text, file, instance, CellOrder::kColumnsFirst);
    },
    parse_solution_yaml,
    parse_solution_tracker,
    parse_solution_tracker_table,
};
static_assert(std::size(kReaders) == std::size(kParsers));

/// The name of the format that a text begins in; empty for none.
std::string_view guessed_format(std::string_view text) {
  const std::string_view head = trimmed(text.substr(0, 4096));  // no format begins with more blanks than that
  if (head.substr(0, 1) == "<" || head.substr(0, 4) == "\xef\xbb\xbf<") return "xml";
  if (head.substr(0, 1) == "{") return "json";
  if (is_path_solution(head)) return "paths";
  if (is_plain_solution(head)) return "lines";
  if (is_lacam_solution(head)) return "lacam";
  if (is_tracker_table(head)) return "tracker-csv";
  if (head.substr(0, 5) == "agent") return "csv";
  if (is_yaml_solution(head)) return "yaml";
  return is_tracker_solution(head) ? "tracker" : "";
}

}  // namespace

std::span<const SolutionReader> solution_readers() { return kReaders; }

Input<SolutionDocument> parse_solution(std::string_view text, const std::string& file_name,
                                       const Instance& instance, std::string_view format) {
  if (format.empty()) format = guessed_format(text);
  for (std::size_t i = 0; i < std::size(kReaders); ++i) {
    if (kReaders[i].name == format) return kParsers[i](text, file_name, instance);
  }
  return Unexpected{InputError{file_name, 1, text.empty() ? "empty file" : "not a solution",
                               "XML with <log>, a JSON object, CSV that begins with 'agent,id,t0', lines "
                               "such as '0: (3,4,0) (5,4,2)', or the plan of a program in discrete time"}};
}

Input<SolutionDocument> load_solution(const std::string& path, const Instance& instance,
                                      std::string_view format) {
  const Input<std::string> text = read_text(path);
  if (!text) return Unexpected{text.error()};
  return parse_solution(*text, path, instance, format);
}

TrajectoryCollector::TrajectoryCollector(const Instance& instance)
    : instance_(instance), trajectories_(instance.agents.size()), taken_(instance.agents.size(), false) {
  for (AgentIndex i = 0; i < instance.agents.size(); ++i) {
    trajectories_[i].start = instance.agents[i].start;
    if (!agent_of_id_.emplace(instance.agents[i].id, i).second) ids_repeat_ = true;
  }
}

std::string TrajectoryCollector::add(const std::optional<std::string>& id, std::size_t position,
                                     Trajectory trajectory, const std::optional<Cell>& stated_start) {
  AgentIndex agent = position;
  if (id && !ids_repeat_) {
    const auto found = agent_of_id_.find(*id);
    if (found == agent_of_id_.end()) return "robot " + in_quotes(*id) + " that the instance does not have";
    agent = found->second;
  } else if (position >= trajectories_.size()) {
    return "trajectory " + std::to_string(position) + " for an instance of " +
           std::to_string(trajectories_.size()) + " robots";
  } else if (id && *id != instance_.agents[position].id) {
    return "robot " + in_quotes(*id) + " where the instance has " + in_quotes(instance_.agents[position].id);
  }
  if (taken_[agent]) return "a second trajectory of robot " + in_quotes(instance_.agents[agent].id);
  taken_[agent] = true;
  const Cell begin =
      trajectory.motions.empty() ? instance_.agents[agent].start : trajectory.motions.front().from;
  trajectory.start = stated_start.value_or(begin);
  trajectories_[agent] = std::move(trajectory);
  return {};
}

std::optional<AgentIndex> TrajectoryCollector::missing() const {
  for (AgentIndex i = 0; i < taken_.size(); ++i) {
    if (!taken_[i]) return i;
  }
  return std::nullopt;
}

}  // namespace sipplab
