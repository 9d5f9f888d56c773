// Well-formed instances: no robot blocks another one's start or goal. M. Cap, P. Novak, A. Kleiner and
// M. Selecky (2015), "Prioritized Planning Algorithms for Trajectory Coordination of
// Multiple Mobile Robots", doi:10.1109/TASE.2015.2445780.
#pragma once

#include "sipplab/instance.hpp"

namespace sipplab {

/// Whether each robot has a path from its start to its goal, by moves between 4-neighbours,
/// on which its body overlaps no other robot's start or goal. False with dynamic obstacles,
/// of which the definition knows nothing.
bool is_well_formed(const Instance& instance);

}  // namespace sipplab
