#include "planner/improve/objective.hpp"

#include <tuple>

#include "planner/prioritized/options.hpp"

namespace sipplab {

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

bool is_better(const Objective& objective, const PlanCost& one, const PlanCost& other) {
  const auto key = [&objective](const PlanCost& cost) {
    return std::tuple(objective.of(cost.flowtime_s, cost.makespan_s), cost.flowtime_s, cost.makespan_s);
  };
  return key(one) < key(other);
}

}  // namespace sipplab
