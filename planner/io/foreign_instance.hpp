// Instances in the formats of other planners.
#pragma once

#include <string>

#include "sipplab/instance.hpp"
#include "sipplab/options.hpp"

namespace sipplab {

/// Map, starts and goals as libMultiRobotPlanning takes them; agents are called agent0 and so on.
std::string write_lmrp_yaml(const Instance& instance);
/// Continuous-CBS' map: height and width are elements there, and come before the rows.
std::string write_ccbs_map(const GridMap& map);
/// Starts and goals as it takes them, by rows and columns.
std::string write_ccbs_task(const Instance& instance);
/// Its configuration: the largest radius (at most its 0.5), neighbours and time limit as the options say.
std::string write_ccbs_config(const Instance& instance, const PlannerOptions& options);

}  // namespace sipplab
