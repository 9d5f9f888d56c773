// A plan of unit moves in discrete time.
#pragma once

#include <optional>
#include <vector>

#include "sipplab/instance.hpp"
#include "sipplab/solution.hpp"

namespace sipplab {

/// The cells of each robot, step after step from its start on, with the paths and the order at each cell that
/// the plan has, in the fewest steps for every robot: all move at once, and a robot may enter a cell in the
/// step in which another one leaves it. None for plans with other moves than straight ones along rows and
/// columns of free cells, or with two robots at one cell.
std::optional<std::vector<std::vector<Cell>>> discrete_steps(const Instance& instance,
                                                             const Solution& solution);

}  // namespace sipplab
