// All robots in discrete time, at any density: lazy constraints addition search.
// [LC22]: Okumura, AAAI 2023; [LC23]: Okumura, IJCAI 2023.
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "planner/complete/goal_distances.hpp"
#include "planner/complete/guidance.hpp"
#include "planner/complete/pibt.hpp"
#include "sipplab/single_agent_planner.hpp"

namespace sipplab {

struct LacamLimits : TimeLimits {
  std::uint64_t max_steps = UINT64_MAX;  ///< steps that PIBT is asked for
  std::size_t max_memory_bytes = SIZE_MAX;
  /// Steps that a first search may take before another one with other ties begins: as multiples of the
  /// longest path, and at least so many. Times of search have a long tail: on the empty map of 32 x 32 cells
  /// with 950 robots searches take four to ten times the longest path, some a hundred times. Each next
  /// search has twice as many, which keeps the search complete.
  std::uint64_t patience_lengths = 12;
  std::uint64_t least_patience_steps = 256;
  /// Whether rows of pushes are the cheapest ones as long as that gets robots home: shorter plans where it is
  /// crowded.
  bool push_cheaply = true;
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
  std::uint64_t cells_seen = 0;      ///< by robots that chose where to go
};

/// Which robot chooses first: the latest, by whole multiples of this many steps, then in this order.
struct ChoosingOrder {
  std::vector<RobotId> robots;
  std::uint32_t late_after_steps = 1;
};

class Lacam {
 public:
  /// The grid must outlive this. O(robots x cells log cells) at worst; once the limits are over no plan will
  /// be found. REQUIRES: starts differ, goals differ, as many as each other.
  Lacam(const FreeGrid& grid, Configuration starts, Configuration goals, const TimeLimits& limits = {});

  /// Paths of all robots from starts to goals such that each step keeps (1) and (2) of
  /// Pibt::make_step. Without limits, those of the set-up included:
  ///  (1) solved exactly when there are such paths;
  ///  (2) the same calls in the same sequence give the same results.
  ///
  /// Robots go around the traffic (GuidedDistances) until twice the longest path is over, then straight home.
  /// Depth first; each configuration lets robots move by PIBT, the first time freely, then with more and
  /// more of them constrained, until all of its steps were tried. In the worst case exponential in
  /// the number of robots, in practice a few steps more than the longest path.
  LacamResult search(std::uint64_t seed, const LacamLimits& limits);

  /// Steps of all shortest paths together, and of the longest of them: no plan has fewer.
  std::uint64_t least_moves() const { return all_lengths_; }
  std::uint32_t least_steps() const { return longest_; }

 private:
  bool is_crowded() const;

  const FreeGrid& grid_;
  Configuration starts_;
  Configuration goals_;
  GoalDistances distances_;
  std::optional<GuidedDistances> guide_;
  ChoosingOrder order_;
  std::uint32_t longest_ = 0;  ///< steps of the longest path
  std::uint64_t all_lengths_ = 0;
  /// That of every search, if some goal cannot be reached, or there was no time to find out.
  std::optional<LacamStatus> known_;
};

}  // namespace sipplab
