// Where to go in a crowd: distances to goals over moves that are dearer the more robots come the other way.
// [CH24]: Chen, Harabor, Li and Stuckey, "Traffic Flow Optimisation for Lifelong Multi-Agent Path Finding",
// AAAI 2024: paths are chosen one after the other, each around the traffic of the others. Differs from it:
// robots are not held to their own path; the traffic of all paths prices the moves for everybody.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "planner/complete/goal_distances.hpp"
#include "sipplab/single_agent_planner.hpp"

namespace sipplab {

/// One for each robot, by position.
using CellIds = std::vector<CellId>;

/// By cell and position in FreeGrid::neighbours().
using MoveCosts = std::vector<std::array<std::uint8_t, 4>>;

/// Cost of a move that nobody meets, and the most that a move may cost: in quarters of a step, so that robots
/// choose among cells of about the same cost by who stands there. (Tenths: 5 % more flowtime; whole steps: 10
/// %.)
inline constexpr std::uint32_t kFreeMoveCost = 4;
inline constexpr std::uint32_t kDearestMoveCost = 40;

/// What moves cost after each robot has chosen a path around the traffic of all others: a path against a move
/// adds a tenth of a step. O(robots x cells x log cells) at worst; paths in little traffic see few cells.
/// Robots that have not chosen when the limits are over do not count.
/// REQUIRES: goals can be reached.
MoveCosts traffic_costs(const FreeGrid& grid, const CellIds& starts, const CellIds& goals,
                        const TimeLimits& limits);

/// Costs of the cheapest paths to each robot's goal, found as far as they are asked for: Dijkstra from the
/// goal, with buckets (Dial 1969), which all robots share. Neighbours differ by kDearestMoveCost at most, so
/// that costs are kept in a byte a cell.
class GuidedDistances {
 public:
  /// Both must outlive this. O(robots x cells) bytes.
  GuidedDistances(const FreeGrid& grid, const CellIds& goals, const MoveCosts& costs);

  /// By how much `to` is nearer to the robot's goal than `from`; negative if it is farther away.
  /// REQUIRES: the two are neighbours, and there is a path to the goal.
  int gain(RobotId robot, CellId from, CellId to) {
    const int difference = code(robot, from) - code(robot, to);
    if (2 * difference > kModulus) return difference - kModulus;
    return 2 * difference < -kModulus ? difference + kModulus : difference;
  }

 private:
  static constexpr int kUnknown = 0;
  /// Costs are kept modulo this, as 1 to 255.
  static constexpr int kModulus = 255;
  static_assert(2 * kDearestMoveCost < kModulus);

  struct Search {
    std::uint32_t cost = 0;  ///< costs below are known
    CellIds rim;             ///< cells whose costs are known, next to others
  };

  int code(RobotId robot, CellId cell) {
    const int known = codes_[robot * grid_.size() + cell];
    return known != kUnknown ? known : search(robot, cell);
  }
  int search(RobotId robot, CellId wanted);
  /// Queues what is not known yet next to a cell of this cost.
  void look_beyond(CellId cell, std::uint32_t cost, const std::uint8_t* codes);

  const FreeGrid& grid_;
  MoveCosts costs_to_;               ///< by cell and neighbour: from the neighbour to the cell
  std::vector<std::uint8_t> codes_;  ///< by robot and cell: kUnknown, or 1 + cost % kModulus
  std::vector<Search> searches_;

  /// Of the current search: cells to look at, by their cost modulo the size: none costs more than a move
  /// beyond those that are looked at.
  std::array<CellIds, kDearestMoveCost + 1> queued_;
};

}  // namespace sipplab
