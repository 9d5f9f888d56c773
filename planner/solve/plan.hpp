// A first plan: the method that the options name, longer start-safe intervals if it fails, and the
// fallback.
#pragma once

#include "sipplab/instance.hpp"
#include "sipplab/prioritized_planner.hpp"

namespace sipplab {

/// Plans by what the options name: prioritized planning with its re-scheduling, or LaCAM as
/// their method or as their fallback. What the latter does is counted as one more try, its steps as
/// expansions and its configurations as generations. Escalation: if the method fails with options.ssi_s,
/// it is run again with each of options.longer_ssi_s in turn. Tries and work are those of all runs, and so
/// are the limits. Of the options, those of improvement are not looked at: see solve(). REQUIRES:
/// !find_error(instance) and !find_beyond(instance, options).
PlanResult plan(const Instance& instance, const PlannerOptions& options);

/// The options of a run that goes on after others: with what is left of their limits.
/// REQUIRES: done.tries() <= options.max_restarts.
PlannerOptions left_of(const PlannerOptions& options, const PlanResult& done);

/// Adds the tries and the work of `before` to a result that came after it.
void prepend(const PlanResult& before, PlanResult& result);

}  // namespace sipplab
