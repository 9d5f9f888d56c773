// From files to an Instance. Formats are told from the content, never from the
// name: AA-SIPP(m) XML in one file or in parts, the older XML of the AAMAS 2018
// archive, MovingAI .map and .scen, in any combination that makes sense.
#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "planner/instance/instance.hpp"
#include "planner/io/input_error.hpp"
#include "planner/options/option_table.hpp"

namespace sipplab {

/// Paths. Each part (agents, map, options, obstacles) is taken from the file given
/// for it; where there is none, from `instance`, then from any other file that
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

}  // namespace sipplab
