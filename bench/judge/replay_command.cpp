#include "bench/judge/replay_command.hpp"

#include <fmt/format.h>

#include <charconv>
#include <cstdint>
#include <optional>
#include <string_view>
#include <system_error>

#include "bench/sweep/shell_command.hpp"
#include "bench/sweep/sweep_case.hpp"

namespace sipplab::bench {
namespace {

/// The number behind " key:" in "warehouse agents:64 seed:1 index:3".
std::optional<std::uint64_t> number_after(std::string_view text, std::string_view key) {
  const std::size_t at = text.find(key);
  if (at == std::string_view::npos) return std::nullopt;
  const std::string_view digits = text.substr(at + key.size());
  std::uint64_t value = 0;
  const auto [end, error] = std::from_chars(digits.data(), digits.data() + digits.size(), value);
  if (error != std::errc() || end == digits.data()) return std::nullopt;
  return value;
}

/// What `sipplab generate` needs besides for robots that are not as usual: words of the
/// instance's name behind its index.
std::string body_flags(std::string_view name) {
  std::string flags;
  for (const std::string_view word : {"radius", "speed", "obstacles"}) {
    const std::size_t at = name.find(fmt::format(" {}:", word));
    if (at == std::string_view::npos) continue;
    const std::string_view values = name.substr(at + word.size() + 2);
    flags += fmt::format(" --{} {}", word, values.substr(0, values.find(' ')));
  }
  if (name.find(" headings") != std::string_view::npos) flags += " --headings";
  return flags;
}

}  // namespace

std::string option_flags(const PlannerOptions& options, OptionRows rows) {
  std::string flags;
  for (const Option& option : rows) {
    if (!is_told(option, options)) continue;
    const std::string text = option.get(options);
    if (option.kind == OptionKind::kYesNo) {
      flags += fmt::format(" --{}{}", text == "yes" ? "" : "no-", option.name);
    } else {
      flags += fmt::format(" --{} {}", option.name, text);
    }
  }
  return flags;
}

std::string replay_command(const db::CaseInfo& parameters, const std::string& instance_name) {
  const std::optional<std::uint64_t> index = number_after(instance_name, " index:");
  const std::optional<std::uint64_t> seed = number_after(instance_name, " seed:");
  const bool is_ours = !is_another_program(parameters.planner);
  const bool is_scenario = instance_name.ends_with(".scen");  // which states neither
  const auto body = [&](const char* flag, double value, double usual) {
    return is_scenario && value != usual && value > 0 ? fmt::format(" {} {}", flag, value) : std::string();
  };
  const std::string bodies = body("--radius", parameters.radius_cells, kDefaultRadiusCells) +
                             body("--speed", parameters.speed_cells_per_s, kDefaultSpeedCellsPerS);
  const auto plan = [&](const std::string& file) {
    if (!is_ours) return fmt::format("give {} to {}", file, parameters.planner);
    return fmt::format("sipplab plan --instance {}{}{}", file, bodies, option_flags(options_of(parameters)));
  };
  if (parameters.map_spec == "files" || !index || !seed) {
    return plan(shell_word(instance_name));
  }
  return fmt::format("sipplab generate --map {} --agents {} --seed {} --count {}{} -o replay {} {}",
                     shell_word(parameters.map_spec), parameters.robots, *seed, *index + 1,
                     body_flags(instance_name), is_ours ? "&&" : "and",
                     plan(fmt::format("replay/{}.xml", *index)));
}

}  // namespace sipplab::bench
