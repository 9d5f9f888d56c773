// Improvement of a plan in stages, from coarse to fine.
#pragma once

#include "sipplab/improve.hpp"
#include "sipplab/solve.hpp"

namespace sipplab {

/// A plan of unit moves is improved by unit moves first (improve_unit_moves()), then, as any other one, by
/// the paths of the planner for one robot (improve()). Iterations and seconds of options.improve are for both
/// together; the log tells of both. Without options.improve there is no limit. REQUIRES: as improve().
ImproveResult improve_in_stages(const Instance& instance, const PlanResult& given,
                                const PlannerOptions& options);

}  // namespace sipplab
