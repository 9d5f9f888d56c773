// A robot of an instance: an open disk with a start, a goal, a size and a speed.
#pragma once

#include <optional>
#include <string>

#include "planner/grid/cell.hpp"

namespace sipplab {

/// AA-SIPP(m)'s defaults.
inline constexpr double kDefaultRadiusCells = 0.5;
inline constexpr double kDefaultSpeedCellsPerS = 1.0;
inline constexpr double kDefaultRotationSpeed = 1.0;

/// Limits of what an instance may ask for. They keep times and coordinates in
/// the range for which the tolerances were chosen.
inline constexpr double kMinRadiusCells = 1e-3;
inline constexpr double kMaxRadiusCells = 64;
inline constexpr double kMinSpeedCellsPerS = 1e-3;
inline constexpr double kMaxSpeedCellsPerS = 1e3;
inline constexpr double kMinRotationSpeed = 1e-3;
inline constexpr double kMaxRotationSpeed = 1e3;

struct Agent {
  std::string id;  ///< as in the input; the input position if the input has none
  Cell start;
  Cell goal;
  double radius_cells = kDefaultRadiusCells;
  double speed_cells_per_s = kDefaultSpeedCellsPerS;

  /// Degrees, counted counter-clockwise from the direction of growing x as a
  /// viewer sees it; 0 <= heading < 360. AA-SIPP(m)'s convention.
  double start_heading_deg = 0;
  /// None: any heading will do ("whatever").
  std::optional<double> goal_heading_deg;
  /// Turns of 180 degrees per second. Used, like the headings, if MotionRules say so.
  double rotation_speed = kDefaultRotationSpeed;

  friend bool operator==(const Agent&, const Agent&) = default;
};

}  // namespace sipplab
