// Which goals a robot can reach on a map without other robots.
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "sipplab/grid_map.hpp"
#include "sipplab/instance.hpp"

namespace sipplab {

/// Components of the cells where a disk of this radius may stand, joined by moves
/// between 4-neighbours; by GridMap::index. 0 if it may not stand, else 1, 2, ...
/// in row-major order of each component's first cell. A move between two such
/// neighbours is always free: it sweeps no unit square that the disk does not
/// already reach from one of its ends.
std::vector<std::uint32_t> standing_components(const GridMap& map, double radius_cells);

/// The first agent whose goal cannot be reached from its start, in input order.
///
/// Exact for radii up to 0.5: a straight move that such a disk can make touches only free cells, and these
/// form a chain of 4-neighbours. A larger disk can make diagonal or longer moves between cells that no chain
/// of 4-neighbours joins (radius 0.6: from (0, 0) to (1, 1) past blocked (2, 0) and (-1, 1)). For such radii
/// an agent is named only if no curve at all joins start and goal, at a resolution of a quarter of a cell
/// that errs towards reachable.
/// REQUIRES: !find_error(instance).
std::optional<InstanceError> find_unreachable_goal(const Instance& instance);

}  // namespace sipplab
