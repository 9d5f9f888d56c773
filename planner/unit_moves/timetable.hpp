// Which robot is at which cell when: a plan of unit moves, by robot and by cell.
#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "planner/unit_moves/unit_moves.hpp"

namespace sipplab {

/// A cell on a robot's way, and when it arrives there; it sets off a move before it arrives at the next.
struct Stop {
  CellId cell = 0;
  Tick arrival = 0;

  friend bool operator==(const Stop&, const Stop&) = default;
};

/// From the start at time 0 to the goal, where the robot stays for ever.
using Route = std::vector<Stop>;

/// A robot's time at a cell.
struct Stay {
  Tick arrival = 0;
  Tick departure = kNever;
  RobotId robot = 0;
  Direction entered = kNowhere;  ///< how it came
  Direction left = kNowhere;     ///< how it goes on
};

class Timetable {
 public:
  /// Nobody is anywhere yet. `moves` must outlive this.
  Timetable(const UnitMoves& moves, std::size_t robots);

  const UnitMoves& moves() const { return moves_; }
  std::size_t robots() const { return routes_.size(); }

  /// REQUIRES: the robot has no route; fits(route).
  void insert(RobotId robot, Route route);
  /// REQUIRES: the robot has a route.
  Route remove(RobotId robot);
  /// Whether the bodies on this route keep off all others: who is at a cell next arrives no earlier than the
  /// lag after the one before has left. O(stops log stays).
  bool fits(const Route& route) const;

  /// Empty if it has none.
  const Route& route(RobotId robot) const { return routes_[robot]; }
  Tick arrival(RobotId robot) const { return routes_[robot].back().arrival; }
  /// By time.
  std::span<const Stay> stays(CellId cell) const { return stays_[cell]; }
  /// Position of the first stay at the cell that begins at this time or later.
  std::size_t first_from(CellId cell, Tick time) const;

 private:
  Stay stay(const Route& route, std::size_t stop) const;

  const UnitMoves& moves_;
  std::vector<Route> routes_;             ///< by robot
  std::vector<std::vector<Stay>> stays_;  ///< by cell
};

}  // namespace sipplab
