// Whether two trajectories are in conflict, as the planner sees it: by the collision intervals that its
// searches respect, so that what a search found is in conflict with none of those that it was planned around.
#pragma once

#include "sipplab/instance.hpp"
#include "sipplab/solution.hpp"

namespace sipplab {

/// `mine` is the trajectory of `agent`; `other` may be an obstacle's, too.
/// O(motions of both).
bool are_in_conflict(const Agent& agent, const Trajectory& mine, double other_radius_cells,
                     const Trajectory& other);

}  // namespace sipplab
