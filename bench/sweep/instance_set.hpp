// The instances of a case: generated from a seed, or the files of a folder.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "bench/sweep/suites.hpp"
#include "db/records.hpp"
#include "planner/core/expected.hpp"
#include "planner/instance/instance.hpp"

namespace sipplab::bench {

struct PreparedInstance {
  Instance instance;
  db::InstanceInfo row;  ///< as the history knows it
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

/// The .xml and .scen files of a folder in natural order (2.xml before 10.xml), or
/// those of its sub-folders where it has none itself; one set for each number of
/// robots. `robots` takes that many from each file instead of all; `count` takes the
/// first so many files of each folder. Errors: one line, for the first bad file.
Expected<std::vector<InstanceSet>, std::string> load_sets(const std::string& folder,
                                                          const std::vector<std::size_t>& robots,
                                                          std::optional<std::uint64_t> count);

/// A set of one instance that is in no file; `environment` is its map_spec and name, too.
InstanceSet single_instance_set(std::string environment, Instance instance);

}  // namespace sipplab::bench
