#include "bench/sweep/run_instance.hpp"

#include <cmath>
#include <ctime>
#include <optional>
#include <string>
#include <string_view>

#include "bench/sweep/instruction_count.hpp"
#include "planner/core/clock.hpp"
#include "planner/core/number.hpp"
#include "planner/improve/objective.hpp"
#include "planner/retime/retime.hpp"
#include "planner/retime/steps.hpp"

namespace sipplab::bench {
namespace {

db::ResultStatus row_status(PlanStatus status) {
  switch (status) {
    case PlanStatus::kSolved:
      return db::ResultStatus::kSolved;
    case PlanStatus::kFailed:
      return db::ResultStatus::kFailed;
    case PlanStatus::kLimit:
      return db::ResultStatus::kLimit;
  }
  return db::ResultStatus::kFailed;
}

/// The history keeps the first 64 of the hash's 128 bits.
std::optional<std::uint64_t> leading_bits(std::string_view hexadecimal) {
  constexpr std::size_t kDigits = 16;
  constexpr int kBase = 16;
  return parse_number<std::uint64_t>(hexadecimal.substr(0, kDigits), kBase);
}

std::string limit_struck(const PlanResult& result, const PlannerOptions& options) {
  if (result.status != PlanStatus::kLimit) return "";
  if (result.statistics.expansions >= options.max_expansions) return "expansions";
  if (result.made_by == Method::kComplete) {
    return result.planning_seconds < options.time_limit_s ? "memory" : "time";
  }
  if (result.tries() > options.max_restarts) return "restarts";
  return "time";
}

std::int64_t nanoseconds(double seconds) {
  constexpr double kNanosecondsPerSecond = 1e9;
  return std::llround(seconds * kNanosecondsPerSecond);
}

/// Whether a violation of this kind can be the rounding of a number.
bool is_measured(ViolationKind kind) {
  return kind == ViolationKind::kAgentCollision || kind == ViolationKind::kObstacleCollision ||
         kind == ViolationKind::kSpeed || kind == ViolationKind::kStandingTime ||
         kind == ViolationKind::kSpacing;
}

}  // namespace

void add_solution(const Solution& solution, db::ResultRow& row) {
  row.makespan_s = makespan_s(solution);
  row.flowtime_s = flowtime_s(solution);
  row.plan_hash = leading_bits(plan_hash(solution));
}

void add_verdict(const Instance& instance, const Solution& solution, const ValidationOptions& options,
                 db::ResultRow& row, double rounding) {
  ValidationReport report = validate(instance, solution, options);
  std::erase_if(report.violations, [rounding](const Violation& violation) {
    return is_measured(violation.kind) && violation.depth_cells <= rounding;
  });
  row.valid = report.valid();
  row.violations = static_cast<std::int64_t>(report.violations.size());
  if (!std::isnan(report.min_clearance_cells)) row.min_clearance_cells = report.min_clearance_cells;
  if (report.valid()) return;
  row.status = db::ResultStatus::kInvalid;
  row.message = report.violations.front().message;
}

void judge_retimed(const Instance& instance, const Solution& given, const MotionRules& rules,
                   db::ResultRow& row, double rounding) {
  db::ResultRow as_given;
  as_given.status = db::ResultStatus::kSolved;
  add_verdict(instance, given, {0, {}, rules}, as_given, rounding);
  db::RetimingRow retiming;
  retiming.given_valid = as_given.valid.value_or(false);
  retiming.given_violations = as_given.violations;
  retiming.given_makespan_s = makespan_s(given);
  retiming.given_flowtime_s = flowtime_s(given);
  const Clock::time_point begin = Clock::now();
  const auto result = retime(instance, given, rules);
  retiming.retime_ns = nanoseconds(seconds_since(begin));
  if (const auto steps = discrete_steps(instance, given)) {
    retiming.unit_step_cost = 0;
    for (const std::vector<Cell>& cells : *steps) {
      *retiming.unit_step_cost += static_cast<std::int64_t>(cells.size()) - 1;
    }
  }
  if (!result || !result->is_executable()) {
    retiming.executable = false;
    row.status = db::ResultStatus::kInvalid;
    row.valid = false;
    row.violations = as_given.violations;
    row.message = result ? "not_executable: " + ring_text(instance, result->ring) : result.error();
    row.retiming = retiming;
    return;
  }
  row.retiming = retiming;
  add_solution(result->solution, row);
  add_verdict(instance, result->solution, {0, {}, rules}, row);
}

db::ResultRow described(const PlannerOptions& options, const PlanResult& result) {
  db::ResultRow row;
  row.status = row_status(result.status);
  row.planning_time_ns = nanoseconds(result.planning_seconds);
  row.tries = result.tries();
  row.expansions = result.statistics.expansions;
  row.generations = result.statistics.generations;
  row.limit = limit_struck(result, options);
  row.made_by = std::string(name(result.made_by));
  if (result.status != PlanStatus::kSolved) return row;
  add_solution(result.solution, row);
  row.ssi_kept_s = result.ssi_kept_s;
  return row;
}

db::ResultRow described(const PlannerOptions& options, const SolveResult& solved) {
  db::ResultRow row = described(options, solved.plan);
  row.planning_time_ns = nanoseconds(solved.seconds());
  row.expansions = solved.statistics().expansions;
  row.generations = solved.statistics().generations;
  if (!solved.is_solved()) return row;
  add_solution(solved.solution(), row);
  row.ssi_kept_s = solved.ssi_kept_s();
  if (solved.improvement && solved.improvement->log.was_cut_short) row.limit = "time";
  return row;
}

db::ResultRow judged(const Instance& instance, const PlannerOptions& options, const PlanResult& result) {
  db::ResultRow row = described(options, result);
  if (result.status == PlanStatus::kSolved) {
    add_verdict(instance, result.solution, {result.ssi_kept_s, result.order(), options.rules}, row);
  }
  return row;
}

namespace {

/// Of all threads of this process.
std::optional<std::int64_t> cpu_time_ns() {
  constexpr std::int64_t kNanosecondsPerSecond = 1'000'000'000;
  timespec time{};
  if (clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &time) != 0) return std::nullopt;
  return time.tv_sec * kNanosecondsPerSecond + time.tv_nsec;
}

std::vector<db::ProgressRow> progress_rows(const SolveResult& solved) {
  std::vector<db::ProgressRow> rows;
  const ImprovementLog& log = solved.improvement->log;
  const auto add = [&](std::uint64_t iteration, double elapsed_s, const PlanCost& cost) {
    rows.push_back({static_cast<std::int64_t>(iteration), nanoseconds(elapsed_s), cost.flowtime_s,
                    cost.makespan_s, log.bound.flowtime_s, log.bound.makespan_s});
  };
  // Plans that were in hand before the one that was improved.
  for (const BestStep& step : solved.steps) {
    if (step.cost && is_better(log.objective, log.curve.front().cost, *step.cost)) {
      add(0, step.ended_s, *step.cost);
    }
  }
  for (const ProgressPoint& point : log.curve) {
    add(point.iteration, solved.plan.planning_seconds + point.seconds, point.cost);
  }
  return rows;
}

}  // namespace

db::ResultRow run_instance(const Instance& instance, const PlannerOptions& options, bool retimed) {
  const InstructionCount instructions;
  const std::optional<std::int64_t> cpu_before_ns = cpu_time_ns();
  const SolveResult solved = solve(instance, options);
  const std::optional<std::int64_t> cpu_after_ns = cpu_time_ns();
  const std::optional<std::int64_t> counted = instructions.count();
  db::ResultRow row = described(options, solved);
  row.instructions = counted;
  if (cpu_before_ns && cpu_after_ns) row.cpu_time_ns = *cpu_after_ns - *cpu_before_ns;
  if (!solved.is_solved()) return row;
  if (retimed) {
    row.ssi_kept_s = 0;
    judge_retimed(instance, solved.solution(), options.rules, row);
  } else {
    add_verdict(instance, solved.solution(), solved.guarantees(options.rules), row);
  }
  if (!solved.improvement) return row;
  row.progress = progress_rows(solved);
  row.flowtime_bound_s = solved.improvement->log.bound.flowtime_s;
  row.makespan_bound_s = solved.improvement->log.bound.makespan_s;
  return row;
}

}  // namespace sipplab::bench
