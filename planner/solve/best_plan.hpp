// The best plan that can be had in a given time: one at once from LaCAM, then
// methods from the paper's to coarser ones until one gives a better one, then improvement until the
// time is over.
#pragma once

#include "sipplab/solve.hpp"

namespace sipplab {

/// Steps:
///  (1) LaCAM, if it can plan such instances: a plan in hand within
///      milliseconds, though a poor one;
///  (2) the method of the options;
///  (3) the same with each longer start-safe interval;
///  (4) ejection, with the first interval and, if (1) gave no plan, with the longer ones;
/// of (2) to (4) each until it gives a plan or has had its restarts; if none does and (1) was cut short, the
/// complete planner again. If there are two plans, that of (1) is improved by unit moves as long as the other
/// one took, and the cheaper one is kept: it may keep starts safe for a shorter time. Then the plan is
/// improved until a limit is reached. If options.longer_ssi_s is empty, kLongerSsiS are tried.
/// Steps are limited by counts, and by shares of options.time_limit_s, which is for everything: the result is
/// repeatable if these are not used up and the iterations of options.improve end before the time limit.
/// A signal (options.stop) ends steps and improvement; there is a plan then if there was one before.
/// REQUIRES: as solve().
SolveResult best_plan(const Instance& instance, const PlannerOptions& options);

inline constexpr double kLongerSsiS[] = {9, 15};

/// Share of the time limit for the first plan: one that is given up has to begin again.
inline constexpr double kShareOfFirstPlan = 0.8;
/// Share of the time limit in which a better plan must have been found. The rest is for
/// improvement, which a plan of LaCAM needs more than any other. (On large maps this is used up: den312d, 270
/// robots, 10 s.)
inline constexpr double kShareBeforeImprovement = 0.08;

}  // namespace sipplab
