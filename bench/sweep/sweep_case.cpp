#include "bench/sweep/sweep_case.hpp"

#include <fmt/format.h>

#include <algorithm>

namespace sipplab::bench {
namespace {

constexpr std::string_view kProgramPrefix = "cmd:";

/// The history keeps counts as signed integers; its largest means "no limit".
std::uint64_t row_count(std::uint64_t limit) { return std::min(limit, db::kNoCountLimit); }

/// As the history has it.
std::string planner_of(const SweepCase& sweep_case) {
  if (!sweep_case.command.empty()) return std::string(kProgramPrefix) + sweep_case.command;
  return (sweep_case.options.any_angle ? "aa-sipp" : "sipp") + refinement_suffix(sweep_case.refinement);
}

}  // namespace

bool is_another_program(std::string_view planner) {
  return planner.substr(0, kProgramPrefix.size()) == kProgramPrefix;
}

std::string_view refinement_suffix_of(std::string_view planner) {
  const std::size_t plus = planner.find('+');
  if (is_another_program(planner) || plus == std::string_view::npos) return {};
  return planner.substr(plus);
}

std::string planner_name(std::string_view planner, bool any_angle, std::int64_t connectedness) {
  if (is_another_program(planner)) return std::string(planner);
  return fmt::format("{}-{}{}", any_angle ? "any-angle" : "grid", 1 << connectedness,
                     refinement_suffix_of(planner));
}

std::string planner_name(const SweepCase& sweep_case) {
  const PlannerOptions& options = sweep_case.options;
  return planner_name(planner_of(sweep_case), options.any_angle, options.connectedness);
}

std::string case_name(const SweepCase& sweep_case, bool with_seed) {
  const PlannerOptions& options = sweep_case.options;
  const bool generated = sweep_case.map_spec != "files";
  return fmt::format("plan/{}/agents:{}/ssi:{}/reschedule:{}/order:{}/planner:{}",
                     generated ? sweep_case.map_spec : sweep_case.environment, sweep_case.robots,
                     format_ssi(options.ssi_s), name(options.rescheduling), name(options.order),
                     planner_name(sweep_case)) +
         (with_seed ? fmt::format("/seed:{}", options.seed) : "");
}

std::string short_case_name(const SweepCase& sweep_case) {
  const PlannerOptions& options = sweep_case.options;
  return fmt::format("{}, {} robots, ssi {}, {}, {}, {}", sweep_case.environment, sweep_case.robots,
                     format_ssi(options.ssi_s), name(options.rescheduling), name(options.order),
                     planner_name(sweep_case));
}

db::CaseInfo case_row(const SweepCase& sweep_case) {
  const PlannerOptions& options = sweep_case.options;
  db::CaseInfo row;
  row.environment = sweep_case.environment;
  row.map_spec = sweep_case.map_spec;
  row.instance_set = sweep_case.instance_set;
  row.robots = static_cast<std::int64_t>(sweep_case.robots);
  row.ssi_s = options.ssi_s;
  row.planner = planner_of(sweep_case);
  row.order = std::string(name(options.order));
  row.reschedule = std::string(name(options.rescheduling));
  row.any_angle = options.any_angle;
  row.connectedness = options.connectedness;
  row.radius_cells = sweep_case.radius_cells;
  row.speed_cells_per_s = sweep_case.speed_cells_per_s;
  row.time_limit_s = options.time_limit_s;
  row.max_expansions = row_count(options.max_expansions);
  row.max_restarts = row_count(options.max_restarts);
  row.seed = options.seed;
  return row;
}

}  // namespace sipplab::bench
