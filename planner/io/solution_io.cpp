// Telling the formats of solutions apart: see solution_io.hpp.
#include "sipplab/solution_io.hpp"

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

Input<SolutionDocument> parse_solution(std::string_view text, const std::string& file_name,
                                       const Instance& instance) {
  const std::string_view head = trimmed(text.substr(0, 4096));  // no format begins with more blanks than that
  if (head.substr(0, 1) == "<" || head.substr(0, 4) == "\xef\xbb\xbf<") {
    return parse_solution_xml(text, file_name, instance);
  }
  if (head.substr(0, 1) == "{") return parse_solution_json(text, file_name, instance);
  if (is_plain_solution(head)) return parse_solution_plain(text, file_name, instance);
  if (head.substr(0, 5) == "agent") return parse_solution_csv(text, file_name, instance);
  return Unexpected{InputError{file_name, 1, text.empty() ? "empty file" : "not a solution",
                               "XML with <log>, a JSON object, CSV that begins with 'agent,id,t0', or lines "
                               "such as '0: (3,4,0) (5,4,2)'"}};
}

Input<SolutionDocument> load_solution(const std::string& path, const Instance& instance) {
  const Input<std::string> text = read_text(path);
  if (!text) return Unexpected{text.error()};
  return parse_solution(*text, path, instance);
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
