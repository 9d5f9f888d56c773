// Instances as files that load_instance reads back: AA-SIPP(m) XML in one file, or
// MovingAI .map and .scen.
#pragma once

#include <string>

#include "planner/instance/instance.hpp"
#include "planner/options/options.hpp"

namespace sipplab {

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
