// One case of a sweep: a set of instances and the options to plan them with.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>

#include "bench/sweep/instance_set.hpp"
#include "db/records.hpp"
#include "planner/options/options.hpp"

namespace sipplab::bench {

struct SweepCase {
  std::string environment;
  std::string map_spec;
  std::string instance_set;
  std::size_t robots = 0;
  double radius_cells = kDefaultRadiusCells;
  double speed_cells_per_s = kDefaultSpeedCellsPerS;
  PlannerOptions options;
  std::size_t set = 0;       ///< which InstanceSet of the sweep
  std::string command = {};  ///< name of the CommandPlanner that plans it; empty: this planner
};

/// "any-angle-4": any-angle over 4 neighbours; "grid-8": moves between 8 neighbours alone.
/// "any-angle-4+turns+wait:0.5": the same for robots with headings that stand before they
/// move. "complete": the complete planner; "any-angle-4+complete": with it as fallback;
/// "any-angle-8+improve:300i,flowtime": improved. "any-angle-4+weight:1.05": by a weighted heuristic.
/// "cmd:NAME": another program, which `planner` of the history is named after.
std::string planner_name(std::string_view planner, bool any_angle, std::int64_t connectedness);

/// Where robots are planned, as tables show it: a generated map by its specification, which tells its
/// size as well, files by their folder.
std::string place_name(const std::string& map_spec, const std::string& environment);
std::string planner_name(const SweepCase& sweep_case);

/// Rules as the history has them, after the method's name: "+turns", "+wait:0.5",
/// "+distance:0.25", "+time:2"; nothing where there are none.
std::string rules_suffix(const MotionRules& rules);
/// " --turns --wait-before-move 0.5 --fallback complete --best": the flags of `sipplab plan` for the
/// suffix of a planner of the history.
std::string suffix_flags(std::string_view planner);

/// Whether `planner` of the history is another program.
bool is_another_program(std::string_view planner);

/// Whether `planner` of the history is the complete planner.
bool is_complete_planner(std::string_view planner);

/// "plan/warehouse/agents:64/ssi:5/reschedule:deterministic/order:shortest/planner:any-angle-4",
/// and "/seed:2" where more than one seed is tried.
std::string case_name(const SweepCase& sweep_case, bool with_seed);

/// "warehouse, 64 robots, ssi 5, deterministic, shortest, any-angle-4": for a line of progress.
std::string short_case_name(const SweepCase& sweep_case);

/// The row of the history.
db::CaseInfo case_row(const SweepCase& sweep_case);

}  // namespace sipplab::bench
