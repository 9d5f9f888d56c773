// Instances as files: see write_instance.hpp.
#include "planner/io/write_instance.hpp"

#include "planner/io/text.hpp"
#include "planner/io/write_xml.hpp"

namespace sipplab {

namespace {

/// A whole file with what `append` appends.
template <class Append>
std::string whole_file(const Append& append) {
  std::string out = "<?xml version=\"1.0\" ?>\n<root>\n";
  append(out);
  out += "</root>\n";
  return out;
}

}  // namespace

std::string write_instance_xml(const Instance& instance) {
  return whole_file([&](std::string& out) { append_instance_xml(out, instance); });
}

std::string write_task_xml(const Instance& instance) {
  return whole_file([&](std::string& out) { append_agents_xml(out, instance); });
}

std::string write_map_xml(const GridMap& map) {
  return whole_file([&](std::string& out) { append_map_xml(out, map); });
}

std::string write_obstacles_xml(const Instance& instance) {
  return whole_file([&](std::string& out) { append_obstacles_xml(out, instance); });
}

std::string write_config_xml(const PlannerOptions& options, const std::string& folder,
                             const std::string& file) {
  return whole_file([&](std::string& out) {
    append_options_xml(out, options);
    out += "\t<options>\n\t\t<loglevel>1</loglevel>\n\t\t<logpath>";
    append_escaped(out, folder);
    out += "</logpath>\n\t\t<logfilename>";
    append_escaped(out, file);
    out += "</logfilename>\n\t</options>\n";
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
