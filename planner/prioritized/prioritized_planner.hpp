// Prioritized planning with start-safe intervals and re-scheduling.
// [AY18]: Andreychuk and Yakovlev, AAMAS 2018, sections 3 (start-safe intervals)
// and 4 (deterministic re-scheduling).
#pragma once

#include <optional>
#include <string_view>
#include <vector>

#include "planner/core/expected.hpp"
#include "planner/instance/instance.hpp"
#include "planner/prioritized/options.hpp"
#include "planner/prioritized/priority_order.hpp"
#include "planner/search/single_agent_planner.hpp"
#include "planner/solution/solution.hpp"

namespace sipplab {

/// One pass over an order.
struct Try {
  PriorityOrder order;
  std::optional<AgentIndex> failed;  ///< the agent for which no trajectory was found
};

enum class PlanStatus {
  kSolved,
  kFailed,  ///< the method ended without a solution
  kLimit,   ///< a limit ended it first: the outcome is censored
};
/// "solved", "failed", "limit".
std::string_view name(PlanStatus status);

struct PlanResult {
  PlanStatus status = PlanStatus::kFailed;
  Solution solution;  ///< all trajectories when solved, else empty
  /// Every order tried, in turn; the last one is the final order.
  std::vector<Try> trace;
  SearchStatistics statistics;  ///< over all tries
  double planning_seconds = 0;  ///< wall clock, planning alone

  std::size_t tries() const { return trace.size(); }
  const PriorityOrder& order() const { return trace.back().order; }
};

/// Plans all agents with the given planner for one robot. The same instance,
/// options and planner give the same result unless the time limit strikes.
/// REQUIRES: !find_error(instance), ssi_s >= 0.
PlanResult plan_prioritized(const Instance& instance, const PlannerOptions& options,
                            SingleAgentPlanner& planner);

/// The same with the planner that the options name: AA-SIPP, or SIPP where any_angle is
/// false; with headings and delays where the rules ask for them.
PlanResult plan(const Instance& instance, const PlannerOptions& options);

}  // namespace sipplab
