#include "planner/io/foreign_instance.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "planner/io/text.hpp"
#include "planner/io/write_xml.hpp"

namespace sipplab {

std::string write_lmrp_yaml(const Instance& instance) {
  const GridMap& map = instance.map;
  std::string text = fmt::format("map:\n  dimensions: [{}, {}]\n  obstacles:{}\n", map.width(), map.height(),
                                 map.blocked_count() == 0 ? " []" : "");
  for (std::size_t i = 0; i < map.cell_count(); ++i) {
    const Cell cell = map.cell(i);
    if (map.is_blocked(cell)) text += fmt::format("  - [{}, {}]\n", cell.x, cell.y);
  }
  text += instance.agents.empty() ? "agents: []\n" : "agents:\n";
  for (AgentIndex i = 0; i < instance.agents.size(); ++i) {
    const Agent& agent = instance.agents[i];
    text += fmt::format("- name: agent{}\n  start: [{}, {}]\n  goal: [{}, {}]\n", i, agent.start.x,
                        agent.start.y, agent.goal.x, agent.goal.y);
  }
  return text;
}

std::string write_ccbs_map(const GridMap& map) {
  pugi::xml_document document;
  pugi::xml_node node = document.append_child("root").append_child("map");
  add_text(node, "height", std::to_string(map.height()));
  add_text(node, "width", std::to_string(map.width()));
  pugi::xml_node grid = node.append_child("grid");
  for (std::int32_t y = 0; y < map.height(); ++y) {
    std::string row;
    for (std::int32_t x = 0; x < map.width(); ++x) row += map.is_blocked({x, y}) ? " 1" : " 0";
    add_text(grid, "row", row.substr(1));
  }
  return file_text(document);
}

std::string write_ccbs_task(const Instance& instance) {
  pugi::xml_document document;
  pugi::xml_node root = document.append_child("root");
  for (const Agent& agent : instance.agents) {
    pugi::xml_node node = root.append_child("agent");
    node.append_attribute("start_i") = agent.start.y;
    node.append_attribute("start_j") = agent.start.x;
    node.append_attribute("goal_i") = agent.goal.y;
    node.append_attribute("goal_j") = agent.goal.x;
  }
  return file_text(document);
}

std::string write_ccbs_config(const Instance& instance, const PlannerOptions& options) {
  constexpr double kLargestOfCcbs = 0.5;
  constexpr double kNoLimit = -1;
  pugi::xml_document document;
  pugi::xml_node algorithm = document.append_child("root").append_child("algorithm");
  const double limit_s = std::isinf(options.time_limit_s) ? kNoLimit : options.time_limit_s;
  const double radius = std::min(largest_radius_cells(instance), kLargestOfCcbs);
  for (const auto& [name, value] : {std::pair<const char*, std::string>{"precision", "0.0000001"},
                                    {"use_cardinal", "1"},
                                    {"use_disjoint_splitting", "1"},
                                    {"hlh_type", "2"},
                                    {"connectedness", std::to_string(options.connectedness)},
                                    {"focal_weight", "1.0"},
                                    {"agent_size", format_real(radius)},
                                    {"timelimit", format_real(limit_s)}}) {
    add_text(algorithm, name, value);
  }
  return file_text(document);
}

}  // namespace sipplab
