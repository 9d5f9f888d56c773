// Re-scheduling by ejection, also called rip-up and re-route: a robot that finds no path takes one, and only
// robots that truly block it are planned again. Beyond [AY18], whose re-scheduling plans all robots again.
#pragma once

#include "sipplab/instance.hpp"
#include "sipplab/prioritized_planner.hpp"

namespace sipplab {

/// Ejections of one robot. Trials at the densities where ejection still succeeds saw a few dozen.
inline constexpr std::uint64_t kMostEjections = 1000;

/// Plans robots one by one in the initial order, as plan_prioritized() does. When a robot
/// fails,
///  (1) it is planned without the robots planned so far; those that its path is in conflict with are
///      candidates;
///  (2) candidates are put back one by one, those ejected most often first, if the robot still finds a path;
///  (3) the others are ejected: the robot takes its path, and they are planned next.
/// Keeping robots that were ejected often breaks cycles; a robot ejected `most_ejections` times ends the run
/// as failed. The trace says which robot ejected which. The final order keeps the guarantee of start-safe
/// intervals (StartPrecedence).
/// REQUIRES: !find_error(instance), options.rescheduling == Rescheduling::kEjection,
/// !options.rules.inflates().
PlanResult plan_by_ejection(const Instance& instance, const PlannerOptions& options,
                            SingleAgentPlanner& planner, std::uint64_t most_ejections = kMostEjections);

}  // namespace sipplab
