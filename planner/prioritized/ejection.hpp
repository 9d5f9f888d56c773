// Re-scheduling by ejection, also called rip-up and re-route: a robot that finds no way
// takes one, and only those that truly stand in it are planned again.
// Beyond [AY18], whose re-scheduling plans everybody again.
#pragma once

#include "planner/instance/instance.hpp"
#include "planner/prioritized/plan_result.hpp"

namespace sipplab {

/// Plans robots one by one in the initial order, as plan_prioritized() does. When a robot
/// fails,
///  (1) it is planned without those that are planned already; all of these that its way is
///      in conflict with are candidates;
///  (2) candidates are put back one by one, those that were ejected most often first, as long
///      as the robot still finds a way;
///  (3) those left are ejected: the robot takes its way, and they are planned next.
/// That robots which were ejected often stay is what breaks cycles; a robot ejected
/// kMostEjections times ends the run as failed. The trace says who ejected whom.
/// The final order keeps the promise of start-safe intervals (StartPrecedence).
/// REQUIRES: !find_error(instance), options.rescheduling == Rescheduling::kEjection,
/// !options.rules.inflates().
PlanResult plan_by_ejection(const Instance& instance, const PlannerOptions& options,
                            SingleAgentPlanner& planner);

/// Trials at the densities where ejection still succeeds saw some dozens.
inline constexpr std::uint64_t kMostEjections = 1000;

}  // namespace sipplab
