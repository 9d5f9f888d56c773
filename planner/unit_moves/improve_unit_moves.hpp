// Improves a plan of unit moves before it is taken to continuous paths: large neighbourhood search ([LC21]:
// Li et al., IJCAI 2021) over routes of unit moves, whose times are those of disks.
#pragma once

#include <cstdint>
#include <optional>

#include "planner/complete/start_order.hpp"
#include "sipplab/improve.hpp"
#include "sipplab/instance.hpp"
#include "sipplab/options.hpp"
#include "sipplab/solution.hpp"

namespace sipplab {

struct UnitImprovement {
  Solution solution;
  StartOrder order;    ///< for how long starts are safe, as in CompleteResult
  ImprovementLog log;  ///< without bounds
  SearchStatistics statistics;
};

/// Improves a plan of unit moves until a limit is reached. It ends earlier if it gains next to nothing, and
/// most of the budget is used or it was in vain to go elsewhere:
///  (1) the result is never worse than the given plan (is_better());
///  (2) it is free of conflicts, and of unit moves and waits alone;
///  (3) the same input and options, with a limit of iterations, give the same result on any number of
///  threads.
/// `most_expansions` is one more limit, to within a round of attempts.
/// None if the plan is none of unit moves, if the instance is beyond plan_complete(), or if the plan's robots
/// turn in a ring without any room to spare. Of the options count ssi_s, improve, objective, seed, threads
/// and stop. REQUIRES: !find_error(instance); the solution is valid.
std::optional<UnitImprovement> improve_unit_moves(const Instance& instance, const Solution& given,
                                                  const PlannerOptions& options,
                                                  std::uint64_t most_expansions = UINT64_MAX);

}  // namespace sipplab
