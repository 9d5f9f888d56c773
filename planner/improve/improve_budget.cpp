#include "planner/improve/improve_budget.hpp"

#include <cmath>

#include "planner/prioritized/options.hpp"

namespace sipplab {
namespace {

/// Iterations that a user can ask for; a double counts them exactly.
constexpr double kMostIterations = 1e15;

}  // namespace

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
