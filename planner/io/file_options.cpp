// Planner options as an input file states them: see file_options.hpp.
#include "planner/io/file_options.hpp"

#include "planner/io/text.hpp"

namespace sipplab {

void apply(const FileOptions& file_options, PlannerOptions& options) {
  const auto overwrite = [](const auto& stated, auto& option) {
    if (stated) option = *stated;
  };
  overwrite(file_options.any_angle, options.any_angle);
  overwrite(file_options.connectedness, options.connectedness);
  overwrite(file_options.rescheduling, options.rescheduling);
  overwrite(file_options.order, options.order);
  overwrite(file_options.ssi_s, options.ssi_s);
  overwrite(file_options.time_limit_s, options.time_limit_s);
}

std::vector<std::string> unplanned_features(const FileOptions& file_options) {
  std::vector<std::string> features;
  if (file_options.plan_for_turns.value_or(false)) features.push_back("planforturns");
  const auto add_time = [&features](const std::optional<double>& time_s, const std::string& tag) {
    if (time_s.value_or(0) > 0) features.push_back(tag + " " + format_real(*time_s));
  };
  add_time(file_options.wait_before_move_s, "waitbeforemove");
  add_time(file_options.inflate_collision_intervals_s, "inflatecollisionintervals");
  return features;
}

}  // namespace sipplab
