// Seeded instances: maps from a short description, robots placed at random. The
// same seed gives the same instance on every compiler, and instance K of a seed
// does not depend on how many others are made.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "sipplab/error.hpp"
#include "sipplab/instance.hpp"

namespace sipplab {

/// What map to make: "empty:32x32", "random:32x32:0.2" (exactly that share of
/// the cells blocked, rounded), "warehouse", or a path to a map file.
struct MapSpec {
  enum class Kind { kEmpty, kRandom, kWarehouse, kFile };
  Kind kind = Kind::kEmpty;
  std::int32_t width = 0;
  std::int32_t height = 0;
  double density = 0;  ///< share of blocked cells, 0 <= density < 1
  std::string path;
};

/// Errors are one line.
Expected<MapSpec, std::string> parse_map_spec(std::string_view text);

/// Only kRandom depends on seed and index; kFile reads the file.
Expected<GridMap, std::string> make_map(const MapSpec& spec, std::uint64_t seed, std::uint64_t index = 0);

/// The warehouse of [AY18], section 5: 35 x 21 cells, 100 of them blocked.
GridMap warehouse_map();

struct GeneratorOptions {
  std::size_t agents = 0;
  std::uint64_t seed = 1;
  std::uint64_t index = 0;  ///< which instance of this seed
  // Each robot's value is drawn from these, all equally likely; if there is only one,
  // nothing is drawn.
  std::vector<double> radii_cells = {kDefaultRadiusCells};
  std::vector<double> speeds_cells_per_s = {kDefaultSpeedCellsPerS};
  std::vector<double> rotation_speeds = {kDefaultRotationSpeed};
  /// Draw start headings in whole degrees, and goal headings for every other robot.
  bool headings = false;
  /// Moving obstacles of radii and speeds drawn from the same values: each comes from beyond
  /// the border after a while, crosses the map by way of a few cells, and leaves for good.
  std::size_t obstacles = 0;
};

/// Robots with distinct starts and distinct goals, bodies not overlapping, each on the
/// map's largest 4-connected component for its radius, so that every goal can be
/// reached. A robot's goal differs from its start if it can exchange goals with another
/// robot of its size, or is alone on the map. Speeds, headings and obstacles do not change
/// where robots are.
/// Errors: one line if that many robots do not fit.
Expected<Instance, std::string> generate_instance(const GridMap& map, const GeneratorOptions& options);

/// make_map and generate_instance in one.
Expected<Instance, std::string> generate_instance(const MapSpec& spec, const GeneratorOptions& options);

}  // namespace sipplab
