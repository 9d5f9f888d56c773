// What a plan costs, and which of two is better.
#pragma once

#include "planner/options/options.hpp"

namespace sipplab {

/// What a plan costs.
struct PlanCost {
  double flowtime_s = 0;
  double makespan_s = 0;
};

/// Whether one is strictly better than the other.
bool is_better(const Objective& objective, const PlanCost& one, const PlanCost& other);

}  // namespace sipplab
