// A plan for every instance that has one on the grid of four neighbours, at any density: the
// method for instances that are too crowded for prioritized planning. Discrete steps of all
// robots at once (lacam.hpp), then motions in continuous time (schedule.hpp).
#pragma once

#include <cstdint>
#include <optional>

#include "planner/complete/lacam.hpp"
#include "sipplab/instance.hpp"
#include "sipplab/options.hpp"
#include "sipplab/solution.hpp"

namespace sipplab {

struct CompleteResult {
  LacamStatus status = LacamStatus::kLimit;
  Solution solution;              ///< empty unless solved
  std::vector<AgentIndex> order;  ///< as is `order`
  double ssi_kept_s = 0;
  std::uint64_t steps_tried = 0;
  std::uint64_t configurations = 0;
};

/// What lies beyond the model of plan_complete: a robot with a radius over 0.5, robots of
/// different speeds, a dynamic obstacle. One line; none if it can be planned.
/// REQUIRES: !find_error(instance).
std::optional<InstanceError> find_beyond_complete(const Instance& instance, const MotionRules& rules = {});

/// Plans all robots at once by unit moves between four neighbours, with waits.
///  (1) Solved exactly when there is such a plan, unless a limit strikes: time, steps,
///      kMaxSearchBytes of memory, or a request to stop. kUnsolvable is a proof.
///  (2) The solution is valid; the guarantee of start-safe intervals holds for `order` in
///      [0, ssi_kept_s], and for no order longer (or as long as it was wanted).
///  (3) The same instance and options give the same result unless time is up.
///  (4) Of plans from a few seeds it is the one that costs least by options.objective.
/// Of the options count the seed (of ties between cells), the objective, ssi_s (the order that is looked for
/// keeps the guarantee at most as long), max_expansions (steps), the time limit and stop. No robot waits
/// longer than the order of visits to each cell demands. REQUIRES: !find_error(instance) and
/// !find_beyond_complete(instance).
CompleteResult plan_complete(const Instance& instance, const PlannerOptions& options);

}  // namespace sipplab
