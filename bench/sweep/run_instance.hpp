// One measurement: plan an instance, have the validator check the plan, and put
// down what came out.
#pragma once

#include "db/records.hpp"
#include "sipplab/solve.hpp"

namespace sipplab::bench {

/// What the planner returned, before the validator has spoken: not for the history.
db::ResultRow described(const PlannerOptions& options, const PlanResult& result);

/// The same of solve(): the last plan, the work of all steps, and the limit that ended the improvement.
db::ResultRow described(const PlannerOptions& options, const SolveResult& solved);

/// The row of the history for what the planner returned, repetition aside. A plan that
/// the validator rejects has status invalid and the first violation as its message.
db::ResultRow judged(const Instance& instance, const PlannerOptions& options, const PlanResult& result);

/// Makespan, flowtime and hash of a plan of any planner.
void add_solution(const Solution& solution, db::ResultRow& row);

/// The validator's verdict on a plan; if it rejects the plan, status invalid and the message.
/// `rounding`: overlaps up to this many cells, and durations wrong by up to this many seconds,
/// are the rounding of a file and no violations.
void add_verdict(const Instance& instance, const Solution& solution, const ValidationOptions& options,
                 db::ResultRow& row, double rounding = 0);

/// The verdict on a plan with the earliest times for its paths and orders, and beside it what the plan was as
/// given. If no such times exist: status invalid and a message that begins with "not_executable".
void judge_retimed(const Instance& instance, const Solution& given, const MotionRules& rules,
                   db::ResultRow& row, double rounding = 0);

/// solve(), judged by the guarantees that are kept, with the curve of its improvement. Planning time is that
/// of all steps. If the clock ended the improvement, the result says so. With `retimed` the plan is
/// re-timed, and keeps no guarantee of start-safe intervals.
db::ResultRow run_instance(const Instance& instance, const PlannerOptions& options, bool retimed = false);

}  // namespace sipplab::bench
