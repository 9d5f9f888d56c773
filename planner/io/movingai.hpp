// MovingAI's formats: octile maps (.map) and scenarios (.scen). Described by
// Sturtevant, "Benchmarks for Grid-Based Pathfinding" (2012).
#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "sipplab/error.hpp"
#include "sipplab/grid_map.hpp"
#include "sipplab/instance.hpp"

namespace sipplab {

/// `.`, `G` and `S` are free; every other printable character is blocked (that
/// includes `@ O T W`). Rows must be exactly as wide and as many as the header says.
Input<GridMap> parse_movingai_map(std::string_view text, const std::string& file_name);

struct MovingaiScenario {
  std::string map_name;  ///< as written; empty without rows
  std::int64_t map_width = 0;
  std::int64_t map_height = 0;
  std::vector<Agent> agents;     ///< ids are positions; default radius and speed
  std::vector<int> agent_lines;  ///< line of each agent
};

/// One agent a row: bucket, map, map width, map height, start x, start y, goal x,
/// goal y, optimal length, separated by tabs or blanks. All rows must name the same map.
Input<MovingaiScenario> parse_movingai_scen(std::string_view text, const std::string& file_name);

}  // namespace sipplab
