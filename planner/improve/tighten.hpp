// Corners cut and earlier departures for all robots of a plan, one after the other.
#pragma once

#include <functional>

#include "planner/prioritized/partial_plan.hpp"
#include "sipplab/improve.hpp"

namespace sipplab {

/// Of all moves together.
double length_cells(const Trajectory& trajectory);

/// Lets every robot cut corners and go as early as the others let it (PartialPlan::tighten()), those that
/// stand longest first, in passes until one gains next to nothing. `after_pass` is told the cost after each
/// pass that gained something. The answer is the cost at the end. REQUIRES: all robots are planned, at this
/// cost.
PlanCost tighten_all(const Instance& instance, PartialPlan& plan, PlanCost cost, const SearchLimits& limits,
                     const std::function<void(const PlanCost&)>& after_pass = {});

/// What a plan costs after that: improve() begins with it. Requirements, order and options as there.
PlanCost tightened_cost(const Instance& instance, const Solution& given, const PriorityOrder& order,
                        const PlannerOptions& options);

}  // namespace sipplab
