// Compares the planner's unsafe times with distances at sampled times and with bisection.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "property_tests/support/distance_oracle.hpp"
#include "sipplab/geometry.hpp"

namespace sipplab {

/// One interval of unsafe times and all that is needed to check it.
struct UnsafeTimes {
  OpenInterval unsafe;  ///< as the planner computes it
  BisectedSpan bisected;
  double first_s;  ///< nothing can overlap before ...
  double last_s;   ///< ... nor after, possibly kForever
  double reach;
  double slack_s;
  double rounding_cells;
  double rounding_s;
  std::function<double(double time_s)> distance;  ///< of the two, slow and obvious, in cells
};

/// Departures for which the move overlaps the disk: unsafe_departures().
UnsafeTimes departures_of(const Move& move, const MovingDisk& disk, double reach);
/// Times at which a disk at rest overlaps the disk: collision_interval().
UnsafeTimes collisions_of(Vec2 place, const MovingDisk& disk, double reach);

/// Times all over the span in which the two can meet, and dense around every end.
std::vector<double> times_to_check(const UnsafeTimes& times);

/// What is wrong with the interval: it must hold the times of overlap and no others, and end at contacts.
/// Empty if nothing is.
std::string find_flaw(const UnsafeTimes& times);

}  // namespace sipplab
