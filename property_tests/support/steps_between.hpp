// Distance on the four-connected grid, by the plainest of searches.
#pragma once

#include <optional>

#include "sipplab/grid_map.hpp"

namespace sipplab {

/// Moves between 4-neighbours from one cell to another, by breadth-first search; none
/// if no path leads there. REQUIRES: both cells are free.
std::optional<int> steps_between(const GridMap& map, Cell from, Cell to);

}  // namespace sipplab
