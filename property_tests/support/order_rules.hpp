// The rules by which each priority order follows from the failure before it: [AY18], section 4. Seen from
// outside, on the trace of a plan. Ejection repairs one plan and tries no orders: it has none of these rules.
#pragma once

#include <set>
#include <string>

#include "planner/io/plan_case.hpp"
#include "planner/solve/plan.hpp"

namespace sipplab {

bool is_permutation_of(PriorityOrder order, std::size_t agents);

/// What is wrong with one step of a method, empty if nothing is. `tried` holds all orders up to `order`, in
/// which robot `failed` found no path; `next` is null if the method gave up.
std::string find_wrong_step(Rescheduling rescheduling, const std::set<PriorityOrder>& tried,
                            const PriorityOrder& order, AgentIndex failed, const PriorityOrder* next);

/// What is wrong with the tries of a plan of this case, empty if nothing is.
std::string find_wrong_try(const PlanCase& plan_case, const PlanResult& result);

}  // namespace sipplab
