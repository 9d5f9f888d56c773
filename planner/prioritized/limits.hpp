// What a run of planning may spend, and when the wall clock strikes.
#pragma once

#include <chrono>
#include <optional>

#include "planner/prioritized/options.hpp"
#include "planner/search/single_agent_planner.hpp"

namespace sipplab {

using Clock = std::chrono::steady_clock;

/// Beyond this many seconds a time limit is as good as none (and a clock would
/// overflow): about three years.
inline constexpr double kLongestTimeLimitS = 1e8;

/// None where the limit never strikes.
inline std::optional<Clock::time_point> deadline_after(Clock::time_point begin, double limit_s) {
  if (!(limit_s < kLongestTimeLimitS)) return std::nullopt;
  return begin + std::chrono::duration_cast<Clock::duration>(std::chrono::duration<double>(limit_s));
}

inline double seconds_since(Clock::time_point begin) {
  return std::chrono::duration<double>(Clock::now() - begin).count();
}

/// Those of a run that began then.
inline SearchLimits search_limits(const PlannerOptions& options, Clock::time_point begin) {
  SearchLimits limits;
  limits.max_expansions = options.max_expansions;
  limits.deadline = deadline_after(begin, options.time_limit_s);
  limits.stop = options.stop;
  return limits;
}

/// What is left of them after the work that was done.
inline SearchLimits left_of(const SearchLimits& limits, const SearchStatistics& done) {
  SearchLimits left = limits;
  left.max_expansions = limits.max_expansions - done.expansions;
  return left;
}

}  // namespace sipplab
