// Anytime large neighbourhood search: a few robots are taken out of a plan and planned
// again around the others, and what is better stays. Li et al., IJCAI 2021, over the exact
// planner; beyond [AY18].
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "planner/improve/objective.hpp"
#include "planner/improve/static_times.hpp"
#include "planner/instance/instance.hpp"
#include "planner/prioritized/plan_result.hpp"

namespace sipplab {

/// A point of the curve: the plan's cost from then on.
struct ProgressPoint {
  double seconds = 0;  ///< wall clock since improvement began
  std::uint64_t iteration = 0;
  PlanCost cost;
};

/// How an improvement went.
struct ImprovementLog {
  Objective objective;
  /// The given plan first, then each better one, and the end.
  std::vector<ProgressPoint> curve;
  LowerBound bound;
  std::uint64_t iterations = 0;
  std::uint64_t improvements = 0;
  bool was_cut_short = false;  ///< by the clock or by somebody who asked to end
  /// Whether the promise of start-safe intervals is kept.
  bool keeps_promise = true;
};

struct ImproveResult {
  Solution solution;
  /// A final order that keeps the promise of start-safe intervals; none where the given plan
  /// kept it in no order: then the result promises freedom from collisions alone.
  std::optional<PriorityOrder> order;
  ImprovementLog log;
  SearchStatistics statistics;
};

/// Improves a plan until a limit strikes:
///  (1) the result is never worse than the given plan (is_better());
///  (2) it is free of conflicts where the given plan is;
///  (3) it keeps the promise of start-safe intervals where the given plan keeps it in some order;
///  (4) the same input, options and number of iterations give the same result, on any number
///      of threads: a limit in seconds decides nothing but the number of iterations.
/// `order` is the given plan's: the result's is near it. Of the options, ssi_s is what the plan promises,
/// improve, objective, seed, threads and stop say how it is improved (without `improve` there is no limit),
/// and the planner for one robot, which finds new trajectories, is the one that they name. REQUIRES:
/// !find_error(instance); the solution is valid, and one of that planner's kind; !options.rules.inflates().
ImproveResult improve(const Instance& instance, const Solution& given, const PriorityOrder& order,
                      const PlannerOptions& options);

}  // namespace sipplab
