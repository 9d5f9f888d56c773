// Pieces of AA-SIPP(m)'s XML: see write_xml.hpp.
#include "planner/io/write_xml.hpp"

#include <cmath>

#include "planner/grid/heading.hpp"
#include "planner/io/text.hpp"

namespace sipplab {
namespace {

using pugi::xml_node;

void add_place(xml_node node, const char* x, const char* y, Cell cell) {
  node.append_attribute(x) = cell.x;
  node.append_attribute(y) = cell.y;
}

void add_agent(xml_node parent, const Agent& agent) {
  xml_node node = parent.append_child("agent");
  add_attribute(node, "id", agent.id);
  add_place(node, "start.x", "start.y", agent.start);
  add_place(node, "goal.x", "goal.y", agent.goal);
  const Agent defaults;
  const auto add_other = [&node](const char* name, double value, double usual) {
    if (value != usual) add_attribute(node, name, value);
  };
  add_other("size", agent.radius_cells, defaults.radius_cells);
  add_other("movespeed", agent.speed_cells_per_s, defaults.speed_cells_per_s);
  add_other("rotationspeed", agent.rotation_speed, defaults.rotation_speed);
  add_other("start.heading", agent.start_heading_deg, defaults.start_heading_deg);
  if (agent.goal_heading_deg) add_attribute(node, "goal.heading", *agent.goal_heading_deg);
}

void add_obstacle(xml_node parent, const DynamicObstacle& obstacle) {
  xml_node node = parent.append_child("obstacle");
  add_attribute(node, "id", obstacle.id);
  add_attribute(node, "size", obstacle.radius_cells);
  const Cell start = obstacle.trajectory.start;
  // An obstacle that never moves has a section all the same: it says where it is.
  add_sections(node, obstacle.trajectory.motions.empty() ? Trajectory{start, {{0, 0, start, start}}}
                                                         : obstacle.trajectory);
}

/// Takes what pugixml writes.
struct TextWriter final : pugi::xml_writer {
  std::string text;
  void write(const void* data, std::size_t size) override {
    text.append(static_cast<const char*>(data), size);
  }
};

}  // namespace

void add_attribute(xml_node node, const char* name, const std::string& value) {
  node.append_attribute(name) = value.c_str();
}

void add_attribute(xml_node node, const char* name, double value) {
  node.append_attribute(name) = format_real(value).c_str();
}

void add_text(xml_node parent, const char* name, const std::string& text) {
  parent.append_child(name).text() = text.c_str();
}

void add_agents(xml_node root, const Instance& instance) {
  xml_node agents = root.append_child("agents");
  agents.append_attribute("number") = static_cast<unsigned long long>(instance.agents.size());
  for (const Agent& agent : instance.agents) add_agent(agents, agent);
}

void add_map(xml_node root, const GridMap& map) {
  xml_node node = root.append_child("map");
  node.append_attribute("type") = "grid";
  xml_node grid = node.append_child("grid");
  grid.append_attribute("width") = map.width();
  grid.append_attribute("height") = map.height();
  for (std::int32_t y = 0; y < map.height(); ++y) {
    std::string row;
    for (std::int32_t x = 0; x < map.width(); ++x) {
      if (x > 0) row += ' ';
      row += map.is_blocked({x, y}) ? '1' : '0';
    }
    add_text(grid, "row", row);
  }
}

void add_obstacles(xml_node root, const Instance& instance) {
  if (instance.obstacles.empty()) return;
  xml_node obstacles = root.append_child("dynamicobstacles");
  for (const DynamicObstacle& obstacle : instance.obstacles) add_obstacle(obstacles, obstacle);
}

void add_instance(xml_node root, const Instance& instance) {
  add_agents(root, instance);
  add_map(root, instance.map);
  add_obstacles(root, instance);
}

void add_options(xml_node root, const PlannerOptions& options, OptionRows rows) {
  xml_node node = root.append_child("algorithm");
  for (const Option& option : rows) {
    if (*option.xml == '\0' || !is_told(option, options)) continue;
    add_text(node, option.xml, published_text(option, option.get(options)));
  }
}

void add_sections(xml_node parent, const Trajectory& trajectory, std::optional<double> start_heading_deg) {
  int id = 0;
  double now_deg = start_heading_deg.value_or(0);
  for (const TimedMotion& motion : trajectory.motions) {
    xml_node node = parent.append_child("section");
    node.append_attribute("id") = id++;
    add_place(node, "start.x", "start.y", motion.from);
    if (!motion.is_wait()) now_deg = heading_deg(motion.from, motion.to);
    const double before_deg = now_deg;
    if (start_heading_deg) add_attribute(node, "start.heading", before_deg);
    add_place(node, "goal.x", "goal.y", motion.to);
    now_deg = motion.turn_to_deg.value_or(now_deg);
    if (start_heading_deg) add_attribute(node, "goal.heading", now_deg);
    // Else it would be read as a wait.
    if (start_heading_deg && motion.is_turn() && now_deg == before_deg) node.append_attribute("turn") = true;
    // Times may be any numbers here: a wrong solution is written as it is.
    const double duration_s = motion.end_s - motion.begin_s;
    add_attribute(node, "duration", std::isfinite(duration_s) ? duration_s : 0.0);
    add_attribute(node, "begin", motion.begin_s);
    add_attribute(node, "end", motion.end_s);
  }
}

std::string file_text(const pugi::xml_document& document) {
  TextWriter writer;
  document.save(writer, "\t", pugi::format_indent, pugi::encoding_utf8);
  return std::move(writer.text);
}

}  // namespace sipplab
