// Prioritized planning with start-safe intervals and re-scheduling.
// [AY18]: Andreychuk and Yakovlev, AAMAS 2018, sections 3 (start-safe intervals)
// and 4 (deterministic re-scheduling).
#pragma once

#include <memory>
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

/// One pass over an order; by ejection, the planning of robots until one fails.
struct Try {
  /// By ejection only the last try has one: the final order, or the first where none was found.
  PriorityOrder order;
  std::optional<AgentIndex> failed;  ///< the agent for which no trajectory was found
  std::vector<AgentIndex> ejected;   ///< by ejection: those that made room for it
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
  /// Every try in turn; the last one has the final order.
  std::vector<Try> trace;
  Method made_by = Method::kPrioritized;  ///< who made the plan, or failed last
  SearchStatistics statistics;            ///< over all tries
  double ssi_s = 0;                       ///< start-safe interval that the last try was to keep
  /// The promise of start-safe intervals holds for the final order in [0, ssi_kept_s]. As
  /// long as it was to be kept, except for plans of the complete planner, which makes them
  /// first and then looks for the order that keeps the promise the longest.
  double ssi_kept_s = 0;
  double planning_seconds = 0;  ///< wall clock, planning alone

  std::size_t tries() const { return trace.size(); }
  const PriorityOrder& order() const { return trace.back().order; }
};

/// Plans all agents with the given planner for one robot. The same instance,
/// options and planner give the same result unless the time limit strikes.
/// REQUIRES: !find_error(instance), ssi_s >= 0.
PlanResult plan_prioritized(const Instance& instance, const PlannerOptions& options,
                            SingleAgentPlanner& planner);

/// The planner for one robot that the options name: AA-SIPP, or SIPP where any_angle is false,
/// with headings and delays where the rules ask for them. The instance must outlive it.
std::unique_ptr<SingleAgentPlanner> single_agent_planner(const Instance& instance,
                                                         const PlannerOptions& options);

/// Plans by what the options name: single_agent_planner(), one robot after the other, or the
/// complete planner as their method or as their fallback. What the latter does is counted as
/// one more try, its steps as expansions and its configurations as generations.
///
/// REQUIRES: !find_beyond_complete(instance, options.rules) where the options name the complete
/// planner; else there is no plan of it.
PlanResult plan(const Instance& instance, const PlannerOptions& options);

/// The options of a run that goes on after others: with what is left of their limits.
/// REQUIRES: done.tries() <= options.max_restarts.
PlannerOptions left_of(const PlannerOptions& options, const PlanResult& done);

/// Adds the tries and the work of `before` to a result that came after it.
void prepend(const PlanResult& before, PlanResult& result);

/// Escalation: where the method fails with options.ssi_s, it is run again with each of
/// `longer_s` in turn. Tries and work are those of all runs, and so are the limits.
PlanResult plan_escalating(const Instance& instance, const PlannerOptions& options,
                           const std::vector<double>& longer_s);

}  // namespace sipplab
