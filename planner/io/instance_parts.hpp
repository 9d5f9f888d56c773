// What one input file holds: some of map, agents, obstacles and options, each with
// the lines that later complaints need.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "planner/options/option_table.hpp"
#include "sipplab/error.hpp"
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

/// A format of instances, or of a part of one.
struct InstanceFormat {
  /// Whether a text may be of this format, from its first characters.
  bool (*begins_so)(std::string_view head);
  Input<InstanceParts> (*parse)(std::string_view text, const std::string& file_name);
  /// What a text is that holds no robots, in words; empty for one that holds some or is broken. Null: each
  /// text of this format holds robots.
  std::string (*without_robots)(std::string_view text, const std::string& file_name) = nullptr;
};

}  // namespace sipplab
