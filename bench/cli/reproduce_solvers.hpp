// Planners side by side, for reproduce.cpp.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "bench/cli/bench_arguments.hpp"

namespace sipplab::cli {

struct SolversArguments {
  BenchArguments sweep;
  std::vector<std::string> planners;  ///< as --planner; empty: those on PATH
  std::vector<std::string> folders;   ///< of instances, besides the suite
  bool no_suite = false;
  std::optional<std::string> folder;  ///< for the page
};

/// Sweeps each planner, this one first, and shows them side by side. Returns the exit code.
int run_reproduce_solvers(const SolversArguments& arguments);

}  // namespace sipplab::cli
