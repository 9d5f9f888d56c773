// Which of two plans is better.
#pragma once

#include "sipplab/improve.hpp"

namespace sipplab {

/// Whether one is strictly better than the other.
bool is_better(const Objective& objective, const PlanCost& one, const PlanCost& other);

}  // namespace sipplab
