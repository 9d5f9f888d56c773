#include "bench/sweep/sweep_case.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "planner/io/text.hpp"

namespace sipplab::bench {
namespace {

constexpr std::string_view kProgramPrefix = "cmd:";
/// Ends the name of a planner that has the complete one as its fallback.
constexpr std::string_view kFallbackSuffix = "+complete";
constexpr std::string_view kComplete = "complete";
constexpr std::string_view kWeight = "weight";

/// The history keeps counts as signed integers; its largest means "no limit".
std::uint64_t row_count(std::uint64_t limit) { return std::min(limit, db::kNoCountLimit); }

/// Of the heuristic, after the method's name; nothing for the plain search.
std::string weight_suffix(double weight) {
  return weight == 1 ? "" : fmt::format("+{}:{}", kWeight, format_real(weight));
}

/// "+improve:300i,flowtime", "+best,flowtime"; empty where nothing is wanted.
std::string refinement_suffix(const PlannerOptions& options) {
  if (!options.best && !options.improve) return "";
  std::string suffix = options.best ? "+best" : "+improve";
  if (options.improve) suffix += ":" + format_improve_budget(*options.improve);
  return suffix + "," + format_objective(options.objective);
}

/// The flags of `sipplab plan` that a suffix stands for.
std::string refinement_flags(std::string_view suffix) {
  const std::string_view kind_and_budget = suffix.substr(1, suffix.find(',') - 1);
  const std::size_t colon = kind_and_budget.find(':');
  std::string flags;
  if (kind_and_budget.substr(0, colon) == "best") flags += " --best";
  if (colon != std::string_view::npos) {
    flags += " --improve " + std::string(kind_and_budget.substr(colon + 1));
  }
  return flags + " --objective " + std::string(suffix.substr(suffix.find(',') + 1));
}

/// As the history has it.
std::string planner_of(const SweepCase& sweep_case) {
  if (!sweep_case.command.empty()) return std::string(kProgramPrefix) + sweep_case.command;
  const PlannerOptions& options = sweep_case.options;
  if (options.method == Method::kComplete) {
    return std::string(kComplete) + refinement_suffix(options);
  }
  return (options.any_angle ? "aa-sipp" : "sipp") + weight_suffix(options.weight) +
         rules_suffix(options.rules) +
         std::string(options.fallback == Fallback::kComplete ? kFallbackSuffix : "") +
         refinement_suffix(options);
}

/// Whether a part of a planner's name begins what refinement_suffix() wrote.
bool is_refinement(std::string_view part) {
  const std::string_view kind = part.substr(0, part.find_first_of(":,"));
  return kind == "best" || kind == "improve";
}

/// A rule of numbers, its word in the history and its flag.
struct Margin {
  std::string_view word;
  std::string_view flag;
  double MotionRules::*value;
};
constexpr Margin kMargins[] = {
    {"wait", "--wait-before-move", &MotionRules::wait_before_move_s},
    {"distance", "--inflate-distance", &MotionRules::inflate_distance_cells},
    {"time", "--inflate-time", &MotionRules::inflate_time_s},
};

}  // namespace

std::string rules_suffix(const MotionRules& rules) {
  std::string suffix = rules.turns ? "+turns" : "";
  for (const Margin& margin : kMargins) {
    if (const double value = rules.*margin.value; value > 0) {
      suffix += fmt::format("+{}:{}", margin.word, format_real(value));
    }
  }
  return suffix;
}

std::string suffix_flags(std::string_view planner) {
  std::string flags;
  for (std::size_t at = planner.find('+'); at != std::string_view::npos;) {
    const std::size_t next = planner.find('+', at + 1);
    const std::string_view part = planner.substr(at + 1, next - at - 1);
    const std::string_view word = part.substr(0, part.find(':'));
    if (word == "turns") flags += " --turns";
    if (word == kComplete) flags += " --fallback complete";
    if (word == kWeight) flags += fmt::format(" --weight {}", part.substr(word.size() + 1));
    if (is_refinement(part)) return flags + refinement_flags(planner.substr(at));  // it comes last
    for (const Margin& margin : kMargins) {
      if (word == margin.word) flags += fmt::format(" {} {}", margin.flag, part.substr(word.size() + 1));
    }
    at = next;
  }
  return flags;
}

bool is_another_program(std::string_view planner) {
  return planner.substr(0, kProgramPrefix.size()) == kProgramPrefix;
}

std::string planner_name(std::string_view planner, bool any_angle, std::int64_t connectedness) {
  if (is_another_program(planner) || is_complete_planner(planner)) return std::string(planner);
  return fmt::format("{}-{}{}", any_angle ? "any-angle" : "grid", 1 << connectedness,
                     planner.substr(std::min(planner.find('+'), planner.size())));
}

std::string place_name(const std::string& map_spec, const std::string& environment) {
  return map_spec == "files" ? environment : map_spec;
}

bool is_complete_planner(std::string_view planner) {
  return planner.substr(0, planner.find('+')) == kComplete;
}

std::string planner_name(const SweepCase& sweep_case) {
  const PlannerOptions& options = sweep_case.options;
  return planner_name(planner_of(sweep_case), options.any_angle, options.connectedness);
}

std::string case_name(const SweepCase& sweep_case, bool with_seed) {
  const PlannerOptions& options = sweep_case.options;
  return fmt::format("plan/{}/agents:{}/ssi:{}/reschedule:{}/order:{}/planner:{}",
                     place_name(sweep_case.map_spec, sweep_case.environment), sweep_case.robots,
                     format_ssi(options.ssi_s), name(options.rescheduling), name(options.order),
                     planner_name(sweep_case)) +
         (with_seed ? fmt::format("/seed:{}", options.seed) : "");
}

std::string short_case_name(const SweepCase& sweep_case) {
  const PlannerOptions& options = sweep_case.options;
  return fmt::format("{}, {} robots, ssi {}, {}, {}, {}",
                     place_name(sweep_case.map_spec, sweep_case.environment), sweep_case.robots,
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
