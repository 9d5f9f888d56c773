#include "planner/improve/objective.hpp"

#include <tuple>

namespace sipplab {

bool is_better(const Objective& objective, const PlanCost& one, const PlanCost& other) {
  const auto key = [&objective](const PlanCost& cost) {
    return std::tuple(objective.of(cost.flowtime_s, cost.makespan_s), cost.flowtime_s, cost.makespan_s);
  };
  return key(one) < key(other);
}

}  // namespace sipplab
