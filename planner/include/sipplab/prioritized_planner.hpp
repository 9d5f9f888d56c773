// Prioritized planning with start-safe intervals and re-scheduling.
// [AY18]: Andreychuk and Yakovlev, AAMAS 2018, sections 3 (start-safe intervals)
// and 4 (deterministic re-scheduling).
#pragma once

#include <memory>
#include <optional>
#include <string_view>
#include <vector>

#include "sipplab/instance.hpp"
#include "sipplab/options.hpp"
#include "sipplab/single_agent_planner.hpp"
#include "sipplab/solution.hpp"

namespace sipplab {

/// Agents from highest to lowest priority, by input position.
using PriorityOrder = std::vector<AgentIndex>;

/// One pass over an order; with ejection, planning until a robot fails.
struct Try {
  /// With ejection only the last try has one: the final order, or the first if none was found.
  PriorityOrder order;
  std::optional<AgentIndex> failed;  ///< the agent for which no trajectory was found
  std::vector<AgentIndex> ejected;   ///< with ejection: those that made room for it
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
  Method made_by = Method::kPrioritized;  ///< what made the plan, or failed last
  SearchStatistics statistics;            ///< over all tries
  double ssi_s = 0;                       ///< start-safe interval that the last try had to keep
  /// The guarantee of start-safe intervals holds for the final order in [0, ssi_kept_s]. Equals ssi_s, except
  /// for plans of LaCAM, which makes them first and then looks for the order that keeps the
  /// guarantee the longest.
  double ssi_kept_s = 0;
  double planning_seconds = 0;  ///< wall clock, planning alone

  std::size_t tries() const { return trace.size(); }
  const PriorityOrder& order() const { return trace.back().order; }
};

/// Plans all agents with the given planner for one robot. The same instance, options and planner give the
/// same result unless the time limit ends it.
/// REQUIRES: !find_error(instance), ssi_s >= 0, options.rescheduling != Rescheduling::kEjection.
PlanResult plan_prioritized(const Instance& instance, const PlannerOptions& options,
                            SingleAgentPlanner& planner);

/// The planner for one robot that the options name: AA-SIPP, or SIPP if any_angle is false, with headings
/// and delays if the rules ask for them. The instance must outlive it. It REQUIRES the Reservations that
/// plan_prioritized() passes, not another implementation of them.
std::unique_ptr<SingleAgentPlanner> single_agent_planner(const Instance& instance,
                                                         const PlannerOptions& options);

}  // namespace sipplab
