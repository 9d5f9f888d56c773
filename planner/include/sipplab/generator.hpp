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

/// Rows and columns of shelves of so many cells.
struct Shelves {
  std::int32_t columns = 0;
  std::int32_t rows = 0;
  std::int32_t length = 0;
  std::int32_t width = 0;

  /// Cells of free space on the left and on the right: a quarter of the shelves.
  std::int32_t space_beside() const { return columns * length / 4; }
};

/// What map to make:
///   "empty:32x32"
///   "random:32x32:0.2"          exactly that share of the cells blocked, rounded
///   "caves:65x81:0.5"           the same in lumps, so that halls and passages are left
///   "rooms:32x32:3"             rooms of 3 x 3 cells with doors of one cell
///   "maze:32x32:4"              ways four cells wide, of which none closes a ring
///   "warehouse"                 that of the paper
///   "shelves:10x20:10x2:1"    ten times twenty shelves of 10 x 2 cells, aisles of one cell
///   the path of a map file
struct MapSpec {
  enum class Kind { kEmpty, kRandom, kCaves, kRooms, kMaze, kWarehouse, kShelves, kFile };
  Kind kind = Kind::kEmpty;
  std::int32_t width = 0;
  std::int32_t height = 0;
  double density = 0;          ///< share of blocked cells, 0 <= density < 1
  std::int32_t gap_cells = 0;  ///< between walls, or between shelves
  Shelves shelves;
  std::string path;
};

/// Errors are one line.
Expected<MapSpec, std::string> parse_map_spec(std::string_view text);

/// Only kRandom, kCaves, kRooms and kMaze depend on seed and index; kFile reads the file.
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
