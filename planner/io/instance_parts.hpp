// What one input file holds: some of map, agents, obstacles and options, each with
// the lines that later complaints need.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "planner/options/option_table.hpp"
#include "sipplab/instance.hpp"

namespace sipplab {

/// A list of things read, with the line of each.
template <class T>
struct LinedList {
  std::vector<T> items;
  std::vector<int> lines;  ///< as long as items
  int line = 0;            ///< of the list itself
};

struct MapPart {
  GridMap map;
  int line = 0;
};

struct OptionsPart {
  StatedOptions options;
  int line = 0;
};

/// Where a scenario says that its map is, and how large.
struct MapReference {
  std::string name;
  std::int64_t width = 0;
  std::int64_t height = 0;
  int line = 0;
};

struct InstanceParts {
  std::string file_name;
  std::optional<MapPart> map;
  std::optional<MapReference> map_reference;
  std::optional<LinedList<Agent>> agents;
  bool states_bodies = true;  ///< radii and speeds; MovingAI's scenarios do not
  std::optional<LinedList<DynamicObstacle>> obstacles;
  std::optional<OptionsPart> options;
  std::vector<std::string> warnings;
};

}  // namespace sipplab
