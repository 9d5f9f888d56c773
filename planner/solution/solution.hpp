// One trajectory for each agent of an instance, in input order.
#pragma once

#include <string>
#include <vector>

#include "planner/solution/trajectory.hpp"

namespace sipplab {

struct Solution {
  std::vector<Trajectory> trajectories;

  friend bool operator==(const Solution&, const Solution&) = default;
};

/// Whether any motion is a turn.
bool has_turns(const Solution& solution);

/// Latest arrival, in seconds; 0 without agents.
double makespan_s(const Solution& solution);

/// Sum of arrivals, in seconds ("sum of costs" elsewhere).
double flowtime_s(const Solution& solution);

/// 32 hexadecimal digits over the exact bits of all motions in canonical form: equal for equal motions,
/// however they are written down, on every machine (XXH3, 128 bits).
std::string plan_hash(const Solution& solution);

}  // namespace sipplab
