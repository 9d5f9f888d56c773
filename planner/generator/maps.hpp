// The maps that descriptions stand for: see generator.hpp.
#pragma once

#include "planner/core/random.hpp"
#include "sipplab/generator.hpp"

namespace sipplab {

/// That share of the cells blocked, any of them.
GridMap random_map(const MapSpec& spec, Random random);

/// That share of the cells blocked, in lumps: what is noisiest once noise was smoothed. Beyond the border it
/// is as noisy as can be.
GridMap caves_map(const MapSpec& spec, Random random);

/// Walls of one cell, `gap_cells` apart. In a maze just so many of them are open, all of their width, that
/// there is one way from each square to each other one. Between rooms there are doors of one cell instead,
/// and one more in every other wall that is left.
GridMap walled_map(const MapSpec& spec, Random random);

/// Shelves with aisles of `gap_cells` around them, free space on either side for a quarter of them, and a
/// wall around it all, as in MovingAI's maps warehouse-COLUMNS-ROWS-LENGTH-WIDTH-GAP.
GridMap shelves_map(const MapSpec& spec);

}  // namespace sipplab
