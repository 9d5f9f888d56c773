// Telling the formats of solutions apart: see solution_io.hpp.
#include "sipplab/solution_io.hpp"

#include <algorithm>
#include <iterator>

#include "planner/io/solution_parts.hpp"
#include "planner/io/text.hpp"
#include "planner/io/text_file.hpp"
#include "sipplab/error.hpp"

namespace sipplab {

namespace {

/// Characters that decide the format; none begins with more blanks than that.
constexpr std::size_t kHeadLength = 4096;

bool is_xml(std::string_view head) {
  return head.substr(0, 1) == "<" || head.substr(0, 4) == "\xef\xbb\xbf<";
}
bool is_json(std::string_view head) { return head.substr(0, 1) == "{"; }
bool is_csv(std::string_view head) { return head.substr(0, 5) == "agent"; }

template <CellOrder order>
Input<SolutionDocument> parse_paths(std::string_view text, const std::string& file,
                                    const Instance& instance) {
  return parse_solution_paths(text, file, instance, order);
}

/// A writer that can tell every solution.
template <std::string (*write)(const Instance&, const SolutionDocument&)>
Expected<std::string, std::string> always(const Instance& instance, const SolutionDocument& document) {
  return write(instance, document);
}

constexpr SolutionFormat kFormats[] = {
    {"xml", "XML in the style of AA-SIPP(m)'s log", is_xml, parse_solution_xml, always<solution_to_xml>},
    {"json", "JSON of this program", is_json, parse_solution_json, always<solution_to_json>},
    {"paths", "Agent 0: (3,4)->(3,5)->, rows or columns first, as they fit", is_path_solution,
     parse_paths<CellOrder::kGuess>},
    {"lines", "0: (3,4,0) (5,4,2): cells and times", is_plain_solution, parse_solution_plain},
    {"lacam", "result text of LaCAM, LaCAM2, LaCAM3 and PIBT", is_lacam_solution, parse_solution_lacam},
    {"tracker", "MAPF-tracker's moves, a line for each robot: 3ru2l, or its table", is_tracker_solution,
     parse_solution_tracker, solution_to_tracker},
    {"csv", "CSV of this program", is_csv, parse_solution_csv, always<solution_to_csv>},
    {"yaml", "schedule of libMultiRobotPlanning", is_yaml_solution, parse_solution_yaml},
    {"aa-sipp", "the published AA-SIPP(m)'s log", nullptr, parse_solution_xml},
    {"ccbs", "Continuous-CBS' log", nullptr, parse_solution_xml},
    {"eecbs", "paths, rows first: EECBS, CBSH2-RTC, PBS", nullptr, parse_paths<CellOrder::kRowsFirst>},
    {"mapf-lns2", "paths, rows first: MAPF-LNS, MAPF-LNS2", nullptr, parse_paths<CellOrder::kRowsFirst>},
    {"paths-xy", "paths, columns first", nullptr, parse_paths<CellOrder::kColumnsFirst>},
};

const SolutionFormat* find_format(std::string_view name) {
  const auto* const found = std::find_if(std::begin(kFormats), std::end(kFormats),
                                         [&](const SolutionFormat& format) { return format.name == name; });
  return found == std::end(kFormats) ? nullptr : found;
}

const SolutionFormat* guess_format(std::string_view text) {
  const std::string_view head = trimmed(text.substr(0, kHeadLength));
  const auto* const found = std::find_if(
      std::begin(kFormats), std::end(kFormats),
      [&](const SolutionFormat& format) { return format.begins_so != nullptr && format.begins_so(head); });
  return found == std::end(kFormats) ? nullptr : found;
}

}  // namespace

std::span<const SolutionFormat> solution_formats() { return kFormats; }

std::string_view solution_format_of_file(std::string_view path) {
  const SolutionFormat* const format = find_format(path.substr(path.find_last_of('.') + 1));
  return format != nullptr && format->write != nullptr ? format->name : "xml";
}

Expected<std::string, std::string> write_solution(std::string_view format, const Instance& instance,
                                                  const SolutionDocument& document) {
  const SolutionFormat* const found = find_format(format);
  if (found == nullptr || found->write == nullptr) {
    return Unexpected{"no format " + in_quotes(format) + " is written"};
  }
  return found->write(instance, document);
}

Input<SolutionDocument> parse_solution(std::string_view text, const std::string& file_name,
                                       const Instance& instance, std::string_view format) {
  const SolutionFormat* const found = format.empty() ? guess_format(text) : find_format(format);
  if (found != nullptr) return found->parse(text, file_name, instance);
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
