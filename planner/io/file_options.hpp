// Planner options as an input file states them; what it leaves open stays empty.
#pragma once

#include <optional>

#include "planner/prioritized/options.hpp"

namespace sipplab {

/// The settings that AA-SIPP(m)'s <algorithm> and <options> know. Times in seconds.
struct FileOptions {
  std::optional<bool> any_angle;
  std::optional<int> connectedness;  ///< 2..5
  std::optional<double> weight;      ///< 1..100
  std::optional<Rescheduling> rescheduling;
  std::optional<InitialOrder> order;
  std::optional<double> ssi_s;         ///< >= 0, or infinity
  std::optional<double> time_limit_s;  ///< > 0, or infinity

  // As MotionRules have them.
  std::optional<bool> turns;                     ///< <planforturns>
  std::optional<double> wait_before_move_s;      ///< 0..100
  std::optional<double> inflate_distance_cells;  ///< <inflatecollisionintervals>, 0..100
  std::optional<double> inflate_time_s;          ///< <inflatecollisiontime>, 0..100

  std::optional<double> log_level;  ///< 0..2; of no consequence here

  friend bool operator==(const FileOptions&, const FileOptions&) = default;
};

/// Overwrites the options that the file states.
void apply(const FileOptions& file_options, PlannerOptions& options);

}  // namespace sipplab
