#include "bench/cli/case_filter.hpp"

#include <optional>
#include <string_view>

#include "planner/io/text.hpp"
#include "planner/options/options.hpp"

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
  if (key == "reschedule") return filter.reschedule = text, true;
  if (key == "order") return filter.order = text, true;
  if (key == "robots") return (filter.robots = parse_whole(text)).has_value();
  if (key == "connectedness") return (filter.connectedness = parse_whole(text)).has_value();
  if (key == "ssi") return (filter.ssi_s = parse_ssi(text)).has_value();
  if (key == "any-angle" && (text == "yes" || text == "no")) return filter.any_angle = text == "yes", true;
  return false;
}

}  // namespace

void add_case_flag(CLI::App& command, std::vector<std::string>& parts) {
  command
      .add_option("--case", parts,
                  "number of a case, or what it has: robots=64,ssi=3,environment=warehouse; also map, "
                  "reschedule, order, connectedness, any-angle=yes|no, planner=cmd:NAME")
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
          ", expected the number of a case, or one of environment=, map=, robots=, ssi=, reschedule=, "
          "order=, connectedness=, any-angle=yes|no, planner="};
    }
  }
  return filter;
}

}  // namespace sipplab::cli
