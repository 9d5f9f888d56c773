// The density sweeps that have names. A suite is a list of blocks; a block is the
// product of its dimensions, and each element of the product is one case.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "planner/options/option_table.hpp"
#include "sipplab/instance.hpp"

namespace sipplab::bench {

/// What the robots of generated instances are like; see GeneratorOptions.
struct Bodies {
  std::vector<double> radii_cells = {kDefaultRadiusCells};
  std::vector<double> speeds_cells_per_s = {kDefaultSpeedCellsPerS};
  bool headings = false;
  std::size_t obstacles = 0;

  friend bool operator==(const Bodies&, const Bodies&) = default;
};

struct SuiteBlock {
  std::string map;  ///< as `sipplab generate --map` takes it
  std::vector<std::size_t> robots;
  /// Values of options, each with each; those of the last dimension change fastest.
  std::vector<OptionValues> dimensions;
  /// What is the same within a case besides; limits are the suite's.
  std::vector<PlannerOptions> planners = {PlannerOptions{}};
  /// Seeds tried on each instance if the re-scheduling or the order is random.
  std::uint64_t random_seeds = 1;
  Bodies bodies = {};
};

struct Suite {
  std::string name = {};
  std::string purpose = {};                  ///< one line
  std::uint64_t instances = 1;               ///< per case
  double time_limit_s = kDefaultTimeLimitS;  ///< wall clock, per instance
  /// Tries after the first, per instance. Unlike the time limit it strikes at the same
  /// point on every machine, so if it strikes first, results are repeatable.
  std::uint64_t max_restarts = UINT64_MAX;
  std::vector<SuiteBlock> blocks = {};
  /// The cases of bench/sweep/adversarial.hpp, each with its own map, robots and options. Of what
  /// a user replaces, everything but map, robots and count applies.
  bool adversarial_cases = false;
};

/// In the order in which --help lists them.
const std::vector<Suite>& suites();

/// None when there is no suite of that name.
const Suite* find_suite(std::string_view name);

}  // namespace sipplab::bench
