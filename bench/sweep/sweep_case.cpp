#include "bench/sweep/sweep_case.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <limits>

namespace sipplab::bench {
namespace {

constexpr std::string_view kProgramPrefix = "cmd:";

/// The history keeps counts as signed integers; its largest means "no limit".
std::int64_t row_count(const std::string& text) {
  return static_cast<std::int64_t>(std::min<std::uint64_t>(std::stoull(text), db::kNoCountLimit));
}

std::string text_of(const db::Value& value) {
  if (const auto* count = std::get_if<std::int64_t>(&value)) {
    const bool is_limit = *count < static_cast<std::int64_t>(db::kNoCountLimit);
    return std::to_string(is_limit ? static_cast<std::uint64_t>(*count)
                                   : std::numeric_limits<std::uint64_t>::max());
  }
  if (const auto* number = std::get_if<double>(&value)) return format_ssi(*number);
  const auto* text = std::get_if<std::string>(&value);
  return text != nullptr ? *text : std::string();
}

}  // namespace

std::string place_name(const std::string& map_spec, const std::string& environment) {
  return map_spec == "files" ? environment : map_spec;
}

std::string planner_label(const SweepCase& sweep_case) {
  const std::string label = label_of(sweep_case.options);
  if (sweep_case.command.empty()) return label;
  // Another program is told the options, too: with others it is another planner.
  return std::string(kProgramPrefix) + sweep_case.command +
         label.substr(std::min(label.find(' '), label.size()));
}

bool is_another_program(std::string_view planner) {
  return planner.substr(0, kProgramPrefix.size()) == kProgramPrefix;
}

std::string case_name(const SweepCase& sweep_case, bool with_seed) {
  const PlannerOptions& options = sweep_case.options;
  std::string differences = planner_label(sweep_case);
  // Benchmarks have no blanks in their names. Another program is named, this one is not.
  std::replace(differences.begin(), differences.end(), ' ', '/');
  differences = sweep_case.command.empty()
                    ? differences.substr(std::min(differences.find('/'), differences.size()))
                    : "/planner:" + differences;
  return fmt::format("plan/{}/agents:{}/ssi:{}/reschedule:{}/order:{}{}",
                     place_name(sweep_case.map_spec, sweep_case.environment), sweep_case.robots,
                     format_ssi(options.ssi_s), name(options.rescheduling), name(options.order),
                     differences) +
         (with_seed ? fmt::format("/seed:{}", options.seed) : "");
}

std::string short_case_name(const SweepCase& sweep_case) {
  const PlannerOptions& options = sweep_case.options;
  return fmt::format("{}, {} robots, ssi {}, {}, {}, {}",
                     place_name(sweep_case.map_spec, sweep_case.environment), sweep_case.robots,
                     format_ssi(options.ssi_s), name(options.rescheduling), name(options.order),
                     planner_label(sweep_case));
}

std::string history_key(const Option& option) { return *option.column != '\0' ? option.column : option.json; }

db::Value column_value(const Option& option, const std::string& text) {
  switch (option.kind) {
    case OptionKind::kYesNo:
      return std::int64_t{text == "yes" ? 1 : 0};
    case OptionKind::kNumber:
      return parse_ssi(text).value_or(0);
    case OptionKind::kCount:
      return row_count(text);
    case OptionKind::kWord:
      break;
  }
  return text;
}

db::CaseInfo case_row(const SweepCase& sweep_case, OptionRows rows) {
  db::CaseInfo row;
  row.environment = sweep_case.environment;
  row.map_spec = sweep_case.map_spec;
  row.instance_set = sweep_case.instance_set;
  row.robots = static_cast<std::int64_t>(sweep_case.robots);
  row.planner = planner_label(sweep_case);
  row.radius_cells = sweep_case.radius_cells;
  row.speed_cells_per_s = sweep_case.speed_cells_per_s;
  for (const Option& option : rows) {
    const bool has_column = *option.column != '\0';
    const std::string key = history_key(option);
    if (key.empty() || (!has_column && !differs(option, sweep_case.options))) continue;
    row.options[key] = column_value(option, option.get(sweep_case.options));
  }
  return row;
}

PlannerOptions options_of(const db::CaseInfo& row, OptionRows rows) {
  PlannerOptions options;
  for (const Option& option : rows) {
    const auto value = row.options.find(history_key(option));
    if (value != row.options.end()) option.set(options, text_of(value->second));
  }
  return options;
}

}  // namespace sipplab::bench
