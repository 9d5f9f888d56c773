// Slow twins of the planner's fast paths: a reservation table that looks at every disk, and SIPP by steps
// that computes every arrival at once and knows no heuristic.
#pragma once

#include <optional>
#include <vector>

#include "planner/geometry/moving_disk.hpp"
#include "sipplab/instance.hpp"

namespace sipplab {

struct PlainTable {
  std::vector<MovingDisk> disks;
  double time_margin_s = 0;  ///< as in Askers

  /// All time less what each disk takes, one after the other.
  std::vector<SafeInterval> safe_intervals(Cell cell, double radius_cells) const;
  /// As ReservationTable::earliest_departure, and equal to the last bit: both are the least time in none of
  /// the open intervals of unsafe departures, whatever the order of the disks.
  double earliest_departure(const Move& move, double radius_cells, double from_s, double until_s) const;
};

/// When SIPP by steps of the 2^k neighbourhood arrives, without rules of motion; nothing if it does not.
std::optional<double> plain_arrival_s(const GridMap& map, const PlainTable& table, const Agent& agent, int k);

}  // namespace sipplab
