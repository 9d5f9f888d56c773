// What improvement minimises, and its name as users write it.
#pragma once

#include <optional>
#include <string>
#include <string_view>

#include "planner/solution/solution.hpp"

namespace sipplab {

/// A weighted sum of flowtime and makespan; of two plans with the same sum the one with the
/// lesser flowtime is better, then the one with the lesser makespan.
struct Objective {
  double flowtime_weight = 1;  ///< >= 0; not both are 0
  double makespan_weight = 0;  ///< >= 0

  double of(double flowtime_s, double makespan_s) const {
    return flowtime_weight * flowtime_s + makespan_weight * makespan_s;
  }
  friend bool operator==(const Objective&, const Objective&) = default;
};

/// "flowtime", "makespan", or weights of both: "1:20" is flowtime + 20 makespan.
std::optional<Objective> parse_objective(std::string_view text);
/// Shortest text that parse_objective reads back as the same value.
std::string format_objective(const Objective& objective);

/// What a plan costs.
struct PlanCost {
  double flowtime_s = 0;
  double makespan_s = 0;
};

/// Whether one is strictly better than the other.
bool is_better(const Objective& objective, const PlanCost& one, const PlanCost& other);

}  // namespace sipplab
