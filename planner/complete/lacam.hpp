// All robots in discrete time, at any density: lazy constraints addition search.
// [LC22]: Okumura, AAAI 2023; [LC23]: Okumura, IJCAI 2023.
#pragma once

#include <chrono>
#include <cstdint>
#include <optional>
#include <vector>

#include "planner/complete/pibt.hpp"

namespace sipplab {

struct LacamLimits {
  std::uint64_t max_steps = UINT64_MAX;  ///< steps that PIBT is asked for
  std::size_t max_memory_bytes = SIZE_MAX;
  std::optional<std::chrono::steady_clock::time_point> deadline;
};

enum class LacamStatus {
  kSolved,
  kUnsolvable,  ///< all configurations that can be reached were seen
  kLimit,
};

struct LacamResult {
  LacamStatus status = LacamStatus::kLimit;
  /// From starts to goals, one configuration a time step; empty unless solved.
  std::vector<Configuration> steps;
  std::uint64_t steps_tried = 0;     ///< steps that PIBT was asked for
  std::uint64_t configurations = 0;  ///< different ones seen
};

/// Paths of all robots from starts to goals such that each step keeps (1) and (2) of
/// Pibt::make_step. Without limits:
///  (1) solved exactly when there are such paths;
///  (2) the same input and seed give the same result.
///
/// Depth first; each configuration lets robots move by PIBT, the first time freely, then with more and
/// more of them constrained, until all of its steps were tried. In the worst case exponential in
/// the number of robots, in practice a few steps more than the longest path.
/// REQUIRES: starts differ, goals differ, as many as each other.
LacamResult search_lacam(const FreeGrid& grid, const Configuration& starts, const Configuration& goals,
                         std::uint64_t seed, const LacamLimits& limits);

}  // namespace sipplab
