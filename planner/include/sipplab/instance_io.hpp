// Instances from files and to files. Formats are told from the content, never from the
// name: AA-SIPP(m) XML in one file or in parts, the older XML of the AAMAS 2018
// archive, MovingAI .map and .scen, in any combination that makes sense. What is written is AA-SIPP(m) XML or
// MovingAI, and is read back.
#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "sipplab/error.hpp"
#include "sipplab/instance.hpp"
#include "sipplab/options.hpp"

namespace sipplab {

/// Paths. Each part (agents, map, options, obstacles) is taken from the file given
/// for it; if there is none, from `instance`, then from any other file that
/// holds it. A scenario without a map brings the map that it names: sought as
/// named, then beside the scenario, then in ../maps/.
struct InstanceFiles {
  std::optional<std::string> instance;
  std::optional<std::string> map;
  std::optional<std::string> task;
  std::optional<std::string> config;
  std::optional<std::string> obstacles;
  /// Only the first so many agents; asking for more than there are is an error.
  std::optional<std::size_t> agents;
  /// Of robots whose file states none, as MovingAI's scenarios; an error for other files.
  std::optional<double> radius_cells;
  std::optional<double> speed_cells_per_s;
  /// Let a goal pass that its robot cannot reach on the empty map.
  bool allow_unreachable = false;
};

struct LoadedInstance {
  Instance instance;  ///< find_error(instance) is empty
  StatedOptions options;
  std::vector<std::string> warnings;  ///< each one line, "file:line: ..."
};

/// Reads, checks and joins the files. Errors: the first thing that is wrong, with
/// file and line, unreachable goals included.
Input<LoadedInstance> load_instance(const InstanceFiles& files);

/// What a file is that holds no robots to plan for: "a solution", "a map", "XML without agents", "neither XML
/// nor a MovingAI file". Empty for one that is an instance or a broken one, and where it cannot be read.
std::string kind_without_robots(const std::string& path);

/// The map alone, from a MovingAI .map or any XML with a <map>.
Input<GridMap> load_map(const std::string& path);

/// Everything that an Instance holds; reading it back gives an equal one.
std::string write_instance_xml(const Instance& instance);

/// The same in parts, one file each, as AA-SIPP(m) takes them.
std::string write_task_xml(const Instance& instance);
std::string write_map_xml(const GridMap& map);
std::string write_obstacles_xml(const Instance& instance);

/// The planner's part of a configuration for AA-SIPP(m) and what follows its format, with
/// the file that the solution is to be written to.
std::string write_config_xml(const PlannerOptions& options, const std::string& folder,
                             const std::string& file);

/// The map: `.` free, `@` blocked.
std::string write_movingai_map(const GridMap& map);

/// Starts and goals, on a map of this file name. The format has no place for ids,
/// sizes, speeds, headings or obstacles; the optimal length is written as the
/// straight distance.
std::string write_movingai_scen(const Instance& instance, const std::string& map_name);

}  // namespace sipplab
