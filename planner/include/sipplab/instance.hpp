// A problem: a map, the agents on it, and obstacles that move on their own. Read this file first: everything
// else refers to an Instance.
#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "sipplab/error.hpp"
#include "sipplab/grid_map.hpp"
#include "sipplab/solution.hpp"

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

/// A robot of an instance: an open disk with a start, a goal, a size and a speed.
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

/// Position of an agent in Instance::agents.
using AgentIndex = std::size_t;

/// A disk with a given trajectory that gives way to no robot. After its last motion it
/// rests for ever. It may stand on blocked cells.
struct DynamicObstacle {
  std::string id;
  double radius_cells = kDefaultRadiusCells;
  Trajectory trajectory;

  friend bool operator==(const DynamicObstacle&, const DynamicObstacle&) = default;
};

struct Instance {
  GridMap map;
  std::vector<Agent> agents;
  std::vector<DynamicObstacle> obstacles;

  friend bool operator==(const Instance&, const Instance&) = default;
};

/// Of all agents; 0 if there are none.
double largest_radius_cells(const Instance& instance);

/// Why an instance is not valid.
struct InstanceError {
  std::optional<AgentIndex> agent;  ///< the later one if two are at odds
  std::optional<std::size_t> obstacle;
  std::string what;      ///< "agent 3: start (4, 7) is blocked"
  std::string expected;  ///< "a free cell"
};

/// The first rule that the instance breaks, agents in input order: every number
/// finite and in range; the body on free cells inside the grid at start and goal;
/// no two starts in collision, no two goals in collision; obstacles' trajectories
/// contiguous, and none on a start at time 0. O(agents + cells near them).
std::optional<InstanceError> find_error(const Instance& instance);

/// 32 hexadecimal digits over map, agents and obstacles (not over ids): equal
/// for equal problems, whatever file they came from (XXH3, 128 bits).
std::string content_hash(const Instance& instance);

/// Largest delay and inflation, in seconds or cells, as the published format has it.
inline constexpr double kMaxMotionMargin = 100;

/// What a plan has to allow for beyond the bodies themselves: turns, delays, and more room than the radii
/// need. Features of the published AA-SIPP(m); all off by default.
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
