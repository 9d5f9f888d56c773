// One case of a sweep: a set of instances and the options to plan them with.
#pragma once

#include <cstddef>
#include <string>
#include <string_view>

#include "bench/sweep/instance_set.hpp"
#include "db/records.hpp"
#include "planner/options/option_label.hpp"

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

/// Where robots are planned, as tables show it: a generated map by its specification, which tells its
/// size as well, files by their folder.
std::string place_name(const std::string& map_spec, const std::string& environment);

/// As tables show it: what differs from the defaults, "sipplab connectedness:3 weight:1.05", "cmd:NAME
/// weight:1.05".
std::string planner_label(const SweepCase& sweep_case);
/// Whether a label is that of another program.
bool is_another_program(std::string_view planner);

/// "plan/warehouse/agents:64/ssi:5/reschedule:deterministic/order:shortest", what differs from the defaults,
/// "/connectedness:3/weight:1.05", and "/seed:2" where more than one seed is tried.
std::string case_name(const SweepCase& sweep_case, bool with_seed);

/// "warehouse, 64 robots, ssi 5, deterministic, shortest, sipplab": for a line of progress.
std::string short_case_name(const SweepCase& sweep_case);

/// The row of the history.
db::CaseInfo case_row(const SweepCase& sweep_case, OptionRows rows = option_rows());
/// The options of such a row.
PlannerOptions options_of(const db::CaseInfo& row, OptionRows rows = option_rows());
/// What the history calls an option: its column, else its key in the JSON object of all that have none.
/// Empty: it is not kept.
std::string history_key(const Option& option);
/// What a text, which the option takes, is there.
db::Value column_value(const Option& option, const std::string& text);

}  // namespace sipplab::bench
