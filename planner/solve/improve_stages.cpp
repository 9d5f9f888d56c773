#include "planner/solve/improve_stages.hpp"

#include <algorithm>
#include <utility>
#include <vector>

#include "planner/core/clock.hpp"
#include "planner/improve/objective.hpp"
#include "planner/improve/tighten.hpp"

namespace sipplab {
namespace {

/// Share of the budget for unit moves, while they gain enough. (Paper's warehouse with 192 robots, 10 s of
/// processor time: 5,071 with a third of the iterations, 4,922 with 0.7, 4,861 with 0.94.)
constexpr double kShareOfUnitMoves = 0.85;

/// What planning at any angle gains, if cutting corners gains 1. (In --best for 10 s: 4 to 16.)
constexpr double kCornersInAll = 10;

/// What one stage did comes before what the next one did.
template <class Result>
void prepend(const UnitImprovement& before, Result& result) {
  ImprovementLog& log = result.log;
  std::vector<ProgressPoint> curve = before.log.curve;
  for (ProgressPoint point : log.curve) {
    point.seconds += before.log.curve.back().seconds;
    point.iteration += before.log.iterations;
    curve.push_back(point);
  }
  log.curve = std::move(curve);
  log.iterations += before.log.iterations;
  log.improvements += before.log.improvements;
  result.statistics += before.statistics;
}

ImproveBudget left_of(const ImproveBudget& budget, const UnitImprovement& done) {
  ImproveBudget left = budget;
  left.seconds = std::max(budget.seconds - done.log.curve.back().seconds, 0.0);
  left.iterations -= std::min(left.iterations, done.log.iterations);
  return left;
}

/// Goes on with a share of what is left, after as many seconds as it takes to cut corners.
void go_on(const Instance& instance, const PlannerOptions& left, double corners_s, UnitImprovement& done) {
  PlannerOptions options = left;
  options.improve = budget_of_unit_moves(*left.improve);
  options.improve->seconds = std::max(options.improve->seconds - corners_s, 0.0);
  const Clock::time_point before = Clock::now();
  if (Begun more = improve_unit_moves(instance, done.solution, options)) {
    prepend(done, *more);
    done = std::move(*more);
  } else {
    done.log.curve.back().seconds += seconds_since(before);
  }
}

}  // namespace

ImproveBudget budget_of_unit_moves(const ImproveBudget& budget) {
  ImproveBudget part = budget;
  part.seconds *= kShareOfUnitMoves;
  if (budget.iterations != UINT64_MAX) {
    part.iterations = static_cast<std::uint64_t>(kShareOfUnitMoves * static_cast<double>(budget.iterations));
  }
  return part;
}

bool unit_moves_go_on(const Objective& objective, const ImprovementLog& done,
                      const PlanCost& with_corners_cut) {
  const auto value = [&](const PlanCost& cost) { return objective.of(cost.flowtime_s, cost.makespan_s); };
  const auto end = static_cast<double>(done.curve.back().iteration);
  const double left = end * (1 / kShareOfUnitMoves - 1);
  const auto before = std::find_if(done.curve.rbegin(), done.curve.rend(), [&](const ProgressPoint& point) {
    return static_cast<double>(point.iteration) <= end - left;
  });
  const double now = value(done.curve.back().cost);
  const double gain = (value(before->cost) - now) * left / (end - static_cast<double>(before->iteration));
  return gain > kCornersInAll * (now - value(with_corners_cut));
}

PlanCost tightened_cost(const Instance& instance, const UnitImprovement& plan,
                        const PlannerOptions& options) {
  PlannerOptions tightening = options;
  tightening.ssi_s = plan.order.kept_s;
  return tightened_cost(instance, plan.solution, plan.order.order, tightening);
}

ImproveResult improve_in_stages(const Instance& instance, const PlanResult& given,
                                const PlannerOptions& options, const Begun& begun) {
  const ImproveBudget budget = options.improve.value_or(ImproveBudget{});
  const bool is_lacams = given.made_by == Method::kComplete;
  PlannerOptions stage = options;
  Begun unit;
  double in_vain_s = 0;  // unit moves that made nothing better
  if (is_lacams || given.ssi_kept_s == 0) {
    stage.ssi_s = is_lacams ? given.ssi_s : 0;
    stage.improve = budget_of_unit_moves(budget);
    const Clock::time_point before = Clock::now();
    unit = improve_unit_moves(instance, begun ? begun->solution : given.solution, stage);
    if (!unit) in_vain_s = seconds_since(before);
  }
  stage.improve = unit ? left_of(budget, *unit) : budget;
  stage.improve->seconds = std::max(stage.improve->seconds - in_vain_s, 0.0);
  bool is_in_vain = false;
  const bool is_over = stage.improve->seconds <= 0 || (options.stop != nullptr && *options.stop);
  // If there were fewer iterations than robots, there is no time to cut corners more than once.
  const bool may_go_on = !begun && !is_over && unit && unit->log.iterations > instance.agents.size();
  if (unit && (begun || may_go_on) && stage.improve->iterations > 0) {
    const Clock::time_point before = Clock::now();
    const PlanCost with_corners_cut = tightened_cost(instance, *unit, stage);
    const double corners_s = seconds_since(before);
    // A shorter plan of unit moves may have less to gain by cutting corners.
    is_in_vain =
        begun && is_better(options.objective, tightened_cost(instance, *begun, stage), with_corners_cut);
    if (is_in_vain) {
      unit->log.improvements = 0;
      unit->log.curve = {
          {unit->log.curve.back().seconds, unit->log.iterations, begun->log.curve.back().cost}};
    }
    unit->log.curve.back().seconds += seconds_since(before);
    stage.improve = left_of(budget, *unit);
    if (may_go_on && unit_moves_go_on(options.objective, unit->log, with_corners_cut)) {
      go_on(instance, stage, corners_s, *unit);
      stage.improve = left_of(budget, *unit);
    }
  }
  const Begun& last = unit && !is_in_vain ? unit : begun;
  stage.ssi_s = last ? last->order.kept_s : given.ssi_kept_s;
  ImproveResult result = last ? improve(instance, last->solution, last->order.order, stage)
                              : improve(instance, given.solution, given.order(), stage);
  for (ProgressPoint& point : result.log.curve) point.seconds += in_vain_s;
  if (unit) prepend(*unit, result);
  if (begun) prepend(*begun, result);
  return result;
}

}  // namespace sipplab
