// Improvement of a plan in stages, from coarse to fine.
#pragma once

#include <optional>

#include "planner/unit_moves/improve_unit_moves.hpp"
#include "sipplab/improve.hpp"
#include "sipplab/solve.hpp"

namespace sipplab {

/// What was done for a plan of unit moves already.
using Begun = std::optional<UnitImprovement>;

/// What of a budget is for unit moves, while they gain enough. Something is left of any other than nothing.
ImproveBudget budget_of_unit_moves(const ImproveBudget& budget);

/// Whether what is left once unit moves have had their share gains more by them than at any angle: unit moves
/// are taken to gain as much for their work as they did last, any angle a multiple of what cutting corners
/// does. REQUIRES: the log has iterations, and a curve from the first of them.
bool unit_moves_go_on(const Objective& objective, const ImprovementLog& done,
                      const PlanCost& with_corners_cut);

/// What the plan costs with its corners cut, as the stage after unit moves begins.
PlanCost tightened_cost(const Instance& instance, const UnitImprovement& plan, const PlannerOptions& options);

/// A plan of unit moves is improved by unit moves first (improve_unit_moves()), for as long as they gain
/// more, then, as any other one, by the paths of the planner for one robot (improve()). Iterations and
/// seconds of options.improve are for both together, in addition to what was begun; the log tells of all.
/// Without options.improve there is no limit. A plan that keeps a guarantee of start-safe intervals which was
/// asked for keeps it; one of LaCAM keeps starts safe for as long as it happens to. The result is no worse
/// than what was begun, with its corners cut. REQUIRES: as improve().
ImproveResult improve_in_stages(const Instance& instance, const PlanResult& given,
                                const PlannerOptions& options, const Begun& begun = std::nullopt);

}  // namespace sipplab
