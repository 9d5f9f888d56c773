// Anytime large neighbourhood search: the paths of a few robots are destroyed and repaired
// around the others, and a better plan is kept. Li et al., IJCAI 2021, over the exact
// planner; beyond [AY18].
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "sipplab/instance.hpp"
#include "sipplab/prioritized_planner.hpp"

namespace sipplab {

/// What a plan costs.
struct PlanCost {
  double flowtime_s = 0;
  double makespan_s = 0;
};

/// Lower bounds on the cost of any plan of the instance, in seconds.
struct LowerBound {
  double flowtime_s = 0;  ///< sum of the robots' static times
  double makespan_s = 0;  ///< greatest of them
};

/// By how much a cost exceeds its lower bound, as a share of the cost: 0 is optimal; 0 if
/// there is no cost.
double gap(double cost_s, double bound_s);

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
  bool was_cut_short = false;  ///< by the clock or by a request to stop
  /// Whether the guarantee of start-safe intervals holds.
  bool keeps_guarantee = true;
};

struct ImproveResult {
  Solution solution;
  /// A final order that keeps the guarantee of start-safe intervals; none if the given plan
  /// kept it in no order: then only freedom from collisions is guaranteed.
  std::optional<PriorityOrder> order;
  ImprovementLog log;
  SearchStatistics statistics;
};

/// Improves a plan until a limit is reached:
///  (1) the result is never worse than the given plan (is_better());
///  (2) it is free of conflicts if the given plan is;
///  (3) it keeps the guarantee of start-safe intervals if the given plan keeps it in some order;
///  (4) the same input, options and number of iterations give the same result, on any number
///      of threads: a limit in seconds affects only the number of iterations.
/// `order` is that of the given plan; the order of the result is close to it. Of the options, ssi_s is what
/// the plan guarantees; improve, objective, seed, threads and stop say how it is improved (without `improve`
/// there is no limit). The options also name the planner for one robot that finds new trajectories. REQUIRES:
/// !find_error(instance); the solution is valid, and one of that planner's kind; !options.rules.inflates().
ImproveResult improve(const Instance& instance, const Solution& given, const PriorityOrder& order,
                      const PlannerOptions& options);

}  // namespace sipplab
