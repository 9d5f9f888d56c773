#include "planner/solve/improve_stages.hpp"

#include <cstdlib>
#include <optional>
#include <utility>

#include "planner/core/clock.hpp"
#include "planner/unit_moves/improve_unit_moves.hpp"

namespace sipplab {
namespace {

/// What one stage did comes before what the next one did.
void prepend(const ImprovementLog& before, ImprovementLog& log) {
  std::vector<ProgressPoint> curve = before.curve;
  for (ProgressPoint point : log.curve) {
    point.seconds += before.curve.back().seconds;
    point.iteration += before.iterations;
    curve.push_back(point);
  }
  log.curve = std::move(curve);
  log.iterations += before.iterations;
  log.improvements += before.improvements;
}

}  // namespace

ImproveResult improve_in_stages(const Instance& instance, const PlanResult& given,
                                const PlannerOptions& options) {
  const Clock::time_point begin = Clock::now();
  PlannerOptions improving = options;
  improving.ssi_s = given.ssi_kept_s;
  std::optional<UnitImprovement> unit = improve_unit_moves(instance, given.solution, improving);
  if (!unit) return improve(instance, given.solution, given.order(), improving);
  if (std::getenv("UNIT_ONLY") != nullptr) {
    ImproveResult r;
    r.solution = unit->solution;
    r.order = unit->order.order;
    r.log = unit->log;
    r.ssi_kept_s = unit->order.kept_s;
    r.statistics = unit->statistics;
    return r;
  }
  ImproveBudget left = options.improve.value_or(ImproveBudget{});
  left.iterations -= unit->log.iterations;
  left.seconds -= seconds_since(begin);
  improving.improve = left;
  improving.ssi_s = unit->order.kept_s;
  ImproveResult result = improve(instance, unit->solution, unit->order.order, improving);
  prepend(unit->log, result.log);
  result.statistics += unit->statistics;
  return result;
}

}  // namespace sipplab
