// Instances as files: see instance_io.hpp.
#include "sipplab/instance_io.hpp"

#include "planner/io/text.hpp"
#include "planner/io/write_xml.hpp"

namespace sipplab {

namespace {

/// A whole file with what `add` adds below the root.
template <class Add>
std::string whole_file(const Add& add) {
  pugi::xml_document document;
  add(document.append_child("root"));
  return file_text(document);
}

}  // namespace

std::string write_instance_xml(const Instance& instance) {
  return whole_file([&](pugi::xml_node root) { add_instance(root, instance); });
}

std::string write_task_xml(const Instance& instance) {
  return whole_file([&](pugi::xml_node root) { add_agents(root, instance); });
}

std::string write_map_xml(const GridMap& map) {
  return whole_file([&](pugi::xml_node root) { add_map(root, map); });
}

std::string write_obstacles_xml(const Instance& instance) {
  return whole_file([&](pugi::xml_node root) { add_obstacles(root, instance); });
}

std::string write_config_xml(const PlannerOptions& options, const std::string& folder,
                             const std::string& file) {
  return whole_file([&](pugi::xml_node root) {
    add_options(root, options);
    pugi::xml_node node = root.append_child("options");
    add_text(node, "loglevel", "1");
    add_text(node, "logpath", folder);
    add_text(node, "logfilename", file);
  });
}

std::string write_movingai_map(const GridMap& map) {
  std::string out = "type octile\nheight " + std::to_string(map.height()) + "\nwidth " +
                    std::to_string(map.width()) + "\nmap\n";
  out.reserve(out.size() + map.cell_count() + static_cast<std::size_t>(map.height()));
  for (std::int32_t y = 0; y < map.height(); ++y) {
    for (std::int32_t x = 0; x < map.width(); ++x) out += map.is_blocked({x, y}) ? '@' : '.';
    out += '\n';
  }
  return out;
}

std::string write_movingai_scen(const Instance& instance, const std::string& map_name) {
  // Buckets group scenarios by length in the benchmark set: four cells each.
  constexpr double kCellsPerBucket = 4;
  std::string out = "version 1\n";
  for (const Agent& agent : instance.agents) {
    const double length_cells = distance(agent.start, agent.goal);
    out += std::to_string(static_cast<int>(length_cells / kCellsPerBucket)) + "\t" + map_name;
    for (const std::int32_t number : {instance.map.width(), instance.map.height(), agent.start.x,
                                      agent.start.y, agent.goal.x, agent.goal.y}) {
      out += '\t';
      out += std::to_string(number);
    }
    out += '\t';
    append_real(out, length_cells);
    out += '\n';
  }
  return out;
}

}  // namespace sipplab
