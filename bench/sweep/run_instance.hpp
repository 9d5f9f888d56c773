// One measurement: plan an instance, have the validator check the plan, and put
// down what came out.
#pragma once

#include "db/records.hpp"
#include "planner/instance/instance.hpp"
#include "planner/prioritized/options.hpp"
#include "planner/prioritized/prioritized_planner.hpp"

namespace sipplab::bench {

/// What the planner returned, before the validator has spoken: not for the history.
db::ResultRow described(const PlannerOptions& options, const PlanResult& result);

/// The row of the history for what the planner returned, repetition aside. A plan that
/// the validator rejects has status invalid and the first violation as its message.
db::ResultRow judged(const Instance& instance, const PlannerOptions& options, const PlanResult& result);

/// plan() and judged().
db::ResultRow run_instance(const Instance& instance, const PlannerOptions& options);

}  // namespace sipplab::bench
