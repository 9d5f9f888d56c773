// Prioritized planning with start-safe intervals and re-scheduling.
// [AY18]: Andreychuk and Yakovlev, AAMAS 2018, sections 3 (start-safe intervals)
// and 4 (deterministic re-scheduling).
#pragma once

#include <memory>

#include "planner/instance/instance.hpp"
#include "planner/prioritized/plan_result.hpp"

namespace sipplab {

/// Plans all agents with the given planner for one robot. The same instance, options and planner give the
/// same result unless the time limit ends it.
/// REQUIRES: !find_error(instance), ssi_s >= 0, options.rescheduling != Rescheduling::kEjection.
PlanResult plan_prioritized(const Instance& instance, const PlannerOptions& options,
                            SingleAgentPlanner& planner);

/// The planner for one robot that the options name: AA-SIPP, or SIPP where any_angle is false, with headings
/// and delays if the rules ask for them. The instance must outlive it.
std::unique_ptr<SingleAgentPlanner> single_agent_planner(const Instance& instance,
                                                         const PlannerOptions& options);

}  // namespace sipplab
