#include "sipplab/options.hpp"

#include <array>
#include <charconv>
#include <cmath>

#include "planner/core/number.hpp"

namespace sipplab {
namespace {

/// Iterations that a user can ask for; a double counts them exactly.
constexpr double kMostIterations = 1e15;

}  // namespace

std::optional<double> parse_ssi(std::string_view text) {
  if (text == "inf" || text == "infinity") return kInfiniteSsi;
  const std::optional<double> value = parse_number<double>(text);
  if (!value || !std::isfinite(*value) || *value < 0) return std::nullopt;
  return *value + 0.0;  // no negative zero
}

std::string format_ssi(double ssi) {
  if (std::isinf(ssi)) return "inf";
  std::array<char, 32> buffer{};
  const auto [end, error] = std::to_chars(buffer.data(), buffer.data() + buffer.size(), ssi);
  return error == std::errc() ? std::string(buffer.data(), end) : std::string("?");
}

std::optional<Objective> parse_objective(std::string_view text) {
  if (text == "flowtime") return Objective{1, 0};
  if (text == "makespan") return Objective{0, 1};
  const std::size_t colon = text.find(':');
  if (colon == std::string_view::npos) return std::nullopt;
  // Weights are numbers of the same kind as spans of time: finite and >= 0.
  const std::optional<double> flowtime = parse_ssi(text.substr(0, colon));
  const std::optional<double> makespan = parse_ssi(text.substr(colon + 1));
  if (!flowtime || !makespan || *flowtime == kInfiniteSsi || *makespan == kInfiniteSsi) return std::nullopt;
  if (*flowtime == 0 && *makespan == 0) return std::nullopt;
  return Objective{*flowtime, *makespan};
}

std::string format_objective(const Objective& objective) {
  if (objective == Objective{1, 0}) return "flowtime";
  if (objective == Objective{0, 1}) return "makespan";
  return format_ssi(objective.flowtime_weight) + ":" + format_ssi(objective.makespan_weight);
}

std::optional<ImproveBudget> parse_improve_budget(std::string_view text) {
  const char unit = text.empty() ? ' ' : text.back();
  if (unit == 'i' || unit == 's') text.remove_suffix(1);
  // A span of plan time is a number of the same kind.
  const std::optional<double> number = parse_ssi(text);
  if (!number || !(*number > 0) || *number == kInfiniteSsi) return std::nullopt;
  ImproveBudget budget;
  if (unit != 'i') {
    budget.seconds = *number;
    return budget;
  }
  if (*number != std::floor(*number) || *number > kMostIterations) return std::nullopt;
  budget.iterations = static_cast<std::uint64_t>(*number);
  return budget;
}

std::string format_improve_budget(const ImproveBudget& budget) {
  if (budget.iterations < UINT64_MAX) return std::to_string(budget.iterations) + "i";
  return format_ssi(budget.seconds) + "s";
}

}  // namespace sipplab
