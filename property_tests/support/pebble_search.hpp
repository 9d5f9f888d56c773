// Whether robots on a grid of four neighbours can get to their goals by moving one at a time
// into free cells: all arrangements that can be reached, one after the other. Shares nothing
// with planner/complete. Robots that follow each other at once can do so one at a time, the
// first one first, so that nothing more can be reached by that, unless a closed ring turns.
#pragma once

#include <cstddef>

#include "planner/io/plan_case.hpp"

namespace sipplab {

/// The case, with what lies beyond LaCAM taken back to what it can plan: no
/// obstacles, radii up to 0.5, the speed of the first robot.
PlanCase within_complete_model(PlanCase plan_case);

/// Arrangements that pebble_search_is_small accepts: some milliseconds.
inline constexpr double kMostArrangements = 6'000;

/// Whether the number of arrangements of the robots on free cells is small enough.
bool pebble_search_is_small(const Instance& instance);

struct PebbleSearch {
  bool is_solvable = false;
  std::size_t arrangements = 0;  ///< seen: all that can be reached unless it is solvable
};

/// Moves robots one by one to free cells, until all are at their goals or nothing new can be reached.
PebbleSearch search_by_pebbles(const Instance& instance);

/// REQUIRES: pebble_search_is_small(instance).
bool is_solvable_by_pebbles(const Instance& instance);

}  // namespace sipplab
