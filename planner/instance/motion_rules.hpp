// What a plan has to allow for beyond the bodies themselves: turns, delays, and more room than the radii
// need. Features of the published AA-SIPP(m); all off by default.
#pragma once

namespace sipplab {

/// Largest delay and inflation, in seconds or cells, as the published format has it.
inline constexpr double kMaxMotionMargin = 100;

struct MotionRules {
  /// Robots have headings: they move where they face and turn in place in between, at Agent::rotation_speed,
  /// from Agent::start_heading_deg to Agent::goal_heading_deg.
  bool turns = false;
  /// Seconds, 0 to kMaxMotionMargin. A robot stands at least this long before each straight move, in addition
  /// to the time that it turns ("waitbeforemove").
  double wait_before_move_s = 0;
  /// Cells, 0 to kMaxMotionMargin. While a robot moves, it keeps this much farther than the radii need from
  /// robots of higher priority and from dynamic obstacles. A standing robot does not: otherwise robots whose
  /// starts or goals touch could never be planned. What the published planner does if it is told
  /// "inflatecollisionintervals".
  double inflate_distance_cells = 0;
  /// Seconds, 0 to kMaxMotionMargin. Where a body is, no other body is within this time before or after,
  /// moving or not: what the published format says of "inflatecollisionintervals".
  double inflate_time_s = 0;

  /// Whether robots keep away farther or longer than their bodies need. How far depends on which robot has
  /// the higher priority, so methods that leave the order open refuse it: ejection and improvement.
  bool inflates() const { return inflate_distance_cells > 0 || inflate_time_s > 0; }
  /// Whether planning for bodies alone is enough.
  bool is_plain() const { return *this == MotionRules{}; }
  friend bool operator==(const MotionRules&, const MotionRules&) = default;
};

}  // namespace sipplab
