// What a planning run may spend.
#pragma once

#include "planner/core/clock.hpp"
#include "sipplab/options.hpp"
#include "sipplab/single_agent_planner.hpp"

namespace sipplab {

/// Those of a run that began at `begin`.
inline SearchLimits search_limits(const PlannerOptions& options, Clock::time_point begin) {
  SearchLimits limits;
  limits.max_expansions = options.max_expansions;
  limits.deadline = deadline_after(begin, options.time_limit_s);
  limits.stop = options.stop;
  return limits;
}

/// What is left of them after the work done.
inline SearchLimits left_of(const SearchLimits& limits, const SearchStatistics& done) {
  SearchLimits left = limits;
  left.max_expansions = limits.max_expansions - done.expansions;
  return left;
}

}  // namespace sipplab
