// What a robot does: straight motions, turns and waits from time 0 on, then rest at
// the last position for ever. A solution is one such trajectory for each agent.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "sipplab/grid_map.hpp"

namespace sipplab {

/// A straight motion at constant speed from one cell centre to another, or a
/// wait if the two are equal. Times in seconds of plan time.
struct TimedMotion {
  double begin_s = 0;
  double end_s = 0;
  Cell from;
  Cell to;
  /// For a wait that is a turn in place: the heading at its end, in degrees as
  /// Agent::start_heading_deg counts them. None for any other motion.
  std::optional<double> turn_to_deg = std::nullopt;

  /// Whether the body stays where it is, turning or not.
  bool is_wait() const { return from == to; }
  bool is_turn() const { return turn_to_deg.has_value(); }
  friend bool operator==(const TimedMotion&, const TimedMotion&) = default;
};

/// Motions follow each other without a gap in time or place; the first begins at
/// time 0 in `start`. A robot that never leaves its start has no motions.
struct Trajectory {
  Cell start;
  std::vector<TimedMotion> motions;

  Cell end() const { return motions.empty() ? start : motions.back().to; }
  /// When the last motion ends, even a wait, in seconds; 0 without motions. Until then the robot follows its
  /// motions, and from then on it is at rest.
  double end_s() const { return motions.empty() ? 0.0 : motions.back().end_s; }
  /// When the last stay begins, in seconds: the end of the last move or turn, 0 for a robot that never does
  /// either. Waits after it change nothing.
  double arrival_s() const;
  friend bool operator==(const Trajectory&, const Trajectory&) = default;
};

/// The same motion in the fewest pieces: consecutive waits are one wait, consecutive moves in one direction
/// at the same speed are one move, and there is no wait at the end. Equal for every notation of a motion.
Trajectory canonical(const Trajectory& trajectory);

/// One trajectory for each agent of an instance, in input order.
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
