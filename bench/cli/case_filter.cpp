#include "bench/cli/case_filter.hpp"

#include <optional>
#include <string_view>

#include "bench/sweep/sweep_case.hpp"
#include "planner/io/text.hpp"
#include "planner/options/option_table.hpp"

namespace sipplab::cli {
namespace {

std::optional<std::int64_t> parse_whole(std::string_view text) {
  const std::optional<double> number = parse_real(text);
  if (!number || *number < 0 || *number > 1e15) return std::nullopt;
  const auto whole = static_cast<std::int64_t>(*number);
  if (static_cast<double>(whole) != *number) return std::nullopt;
  return whole;
}

/// True when `text` was understood and stored.
bool set(db::CaseFilter& filter, std::string_view key, const std::string& text) {
  if (key == "environment" || key == "env") return filter.environment = text, true;
  if (key == "map") return filter.map = text, true;
  if (key == "planner") return filter.planner = text, true;
  if (key == "robots") return (filter.robots = parse_whole(text)).has_value();
  const Option* option = find_option(key);
  if (option == nullptr || bench::history_key(*option).empty() || !takes(*option, text)) return false;
  // As a case has it: of a choice one word, of numbers one.
  PlannerOptions options;
  option->set(options, text);
  const bool is_kept = *option->column != '\0' || differs(*option, options);
  filter.options[bench::history_key(*option)] =
      is_kept ? bench::column_value(*option, option->get(options)) : db::Value{db::Null{}};
  return true;
}

}  // namespace

void add_case_flag(CLI::App& command, std::vector<std::string>& parts) {
  command
      .add_option("--case", parts,
                  "number of a case, or its values: robots=64,ssi=3,environment=warehouse; also map, "
                  "planner=cmd:NAME, and every option of the planner, weight=1.05,turns=yes")
      ->delimiter(',')
      ->type_name("CASE");
}

Expected<db::CaseFilter, std::string> parse_case_filter(const std::vector<std::string>& parts) {
  db::CaseFilter filter;
  for (const std::string& part : parts) {
    const std::size_t equals = part.find('=');
    const bool understood =
        equals == std::string::npos
            ? (filter.id = parse_whole(part)).has_value()
            : set(filter, std::string_view(part).substr(0, equals), part.substr(equals + 1));
    if (!understood) {
      return Unexpected{
          "--case " + in_quotes(part) +
          ", expected the number of a case, or one of environment=, map=, robots=, planner=, and options of "
          "the planner, such as ssi=5, reschedule=none, any-angle=no"};
    }
  }
  return filter;
}

}  // namespace sipplab::cli
