// Planner options as an input file states them; what it leaves open stays empty.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "planner/prioritized/options.hpp"

namespace sipplab {

/// The settings that AA-SIPP(m)'s <algorithm> and <options> know. Times in seconds.
struct FileOptions {
  std::optional<bool> any_angle;
  std::optional<int> connectedness;  ///< 2..5
  std::optional<Rescheduling> rescheduling;
  std::optional<InitialOrder> order;
  std::optional<double> ssi_s;         ///< >= 0, or infinity
  std::optional<double> time_limit_s;  ///< > 0, or infinity

  // Features of the published planner that change the motions; see unplanned_features().
  std::optional<bool> plan_for_turns;
  std::optional<double> wait_before_move_s;             ///< 0..100
  std::optional<double> inflate_collision_intervals_s;  ///< 0..100

  std::optional<double> log_level;  ///< 0..2; of no consequence here

  friend bool operator==(const FileOptions&, const FileOptions&) = default;
};

/// Overwrites the options that the file states.
void apply(const FileOptions& file_options, PlannerOptions& options);

/// One entry for each feature that the file asks for and that is not planned yet:
/// "planforturns", "waitbeforemove 0.5", "inflatecollisionintervals 1".
std::vector<std::string> unplanned_features(const FileOptions& file_options);

}  // namespace sipplab
