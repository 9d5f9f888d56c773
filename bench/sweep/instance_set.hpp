// The instances of a case: generated from a seed, or the files of a folder.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "bench/sweep/suites.hpp"
#include "db/records.hpp"
#include "sipplab/error.hpp"
#include "sipplab/instance.hpp"

namespace sipplab::bench {

struct PreparedInstance {
  Instance instance;        ///< empty if it is broken
  std::string broken = {};  ///< what is wrong with its file, in one line
  db::InstanceInfo row;     ///< as the history knows it
};

/// Instances with the same number of robots.
struct InstanceSet {
  std::string environment;  ///< "empty", "warehouse", or the folder's name
  std::string map_spec;     ///< "empty:32x32", "warehouse", or "files"
  std::string name;         ///< "generated/seed:1", or the folder's name
  std::size_t robots = 0;
  double radius_cells = kDefaultRadiusCells;          ///< 0 where robots differ
  double speed_cells_per_s = kDefaultSpeedCellsPerS;  ///< 0 where robots differ
  std::vector<PreparedInstance> instances;
};

/// `count` instances of one map and seed. Bodies other than the usual ones are part of the
/// set's name ("empty-mixed" is the environment then), and of each instance's, in the words of `sipplab
/// generate`: "radius:0.3,1.4 speed:1,2 headings". Errors: one line.
Expected<InstanceSet, std::string> generate_set(const std::string& map_spec, std::size_t robots,
                                                std::uint64_t count, std::uint64_t seed,
                                                const Bodies& bodies = {});

/// Which files of a folder are swept, and how they are read.
struct FolderRequest {
  std::vector<std::size_t> robots = {};     ///< so many of each file, one set for each number; empty: all
  std::optional<std::uint64_t> count = {};  ///< the first so many instances of each folder
  std::optional<double> radius_cells = {};  ///< as InstanceFiles::radius_cells
  std::optional<double> speed_cells_per_s = {};
  bool strict = false;  ///< what is left out or said otherwise is an error
};

struct LoadedSets {
  std::vector<InstanceSet> sets;
  std::vector<std::string> notes;  ///< one line each: files left out, broken ones, equal instances
};

/// The .xml and .scen files of a folder in natural order (2.xml before 10.xml), or those of its sub-folders
/// where it has none itself; one set for each number of robots. Files without robots (solutions, maps,
/// options) are left out. A broken instance stays, as one that cannot be planned, in the folder's largest
/// set. Errors: one line; if no file is an instance, the first broken one's.
Expected<LoadedSets, std::string> load_sets(const std::string& folder, const FolderRequest& request);

/// A set of one instance that is in no file; `environment` is its map_spec and name, too.
InstanceSet single_instance_set(std::string environment, Instance instance);

}  // namespace sipplab::bench
