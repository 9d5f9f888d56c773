// Planner options as an input file states them: see file_options.hpp.
#include "planner/io/file_options.hpp"

namespace sipplab {

void apply(const FileOptions& file_options, PlannerOptions& options) {
  const auto overwrite = [](const auto& stated, auto& option) {
    if (stated) option = *stated;
  };
  overwrite(file_options.any_angle, options.any_angle);
  overwrite(file_options.connectedness, options.connectedness);
  overwrite(file_options.weight, options.weight);
  overwrite(file_options.rescheduling, options.rescheduling);
  overwrite(file_options.order, options.order);
  overwrite(file_options.ssi_s, options.ssi_s);
  overwrite(file_options.time_limit_s, options.time_limit_s);
  overwrite(file_options.turns, options.rules.turns);
  overwrite(file_options.wait_before_move_s, options.rules.wait_before_move_s);
  overwrite(file_options.inflate_distance_cells, options.rules.inflate_distance_cells);
  overwrite(file_options.inflate_time_s, options.rules.inflate_time_s);
}

}  // namespace sipplab
