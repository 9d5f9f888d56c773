// Which robot is at which cell when: a plan of unit moves, by robot and by cell.
#pragma once

#include <array>
#include <cstddef>
#include <numeric>
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
  std::span<const Stay> stays(CellId cell) const {
    const std::vector<Stay>& borders = at_[cell].borders;
    return std::span(borders).subspan(1, borders.size() - 2);
  }
  /// The stays between one that ended at time 0 and one that never begins: gap i at the cell is what lies
  /// between borders i and i + 1.
  const Stay* borders(CellId cell) const { return at_[cell].borders.data(); }
  /// Position of the first stay at the cell that begins at this time or later. REQUIRES: time <= kNever.
  std::size_t first_from(CellId cell, Tick time) const {
    const std::vector<Tick>& arrivals = at_[cell].arrivals;
    const Tick* begin = arrivals.data();
    std::size_t blocks = arrivals.size() / kLanes;
    while (blocks > kMostBlocks) {
      const std::size_t half = blocks / 2;
      if (begin[half * kLanes - 1] < time) begin += half * kLanes;
      blocks -= half;
    }
    // Counted rather than searched: no branch that would be mispredicted.
    std::array<Tick, kLanes> earlier{};
    for (const Tick* block = begin; block != begin + blocks * kLanes; block += kLanes) {
      for (std::size_t lane = 0; lane < kLanes; ++lane) earlier[lane] += block[lane] < time ? 1 : 0;
    }
    return static_cast<std::size_t>(begin - arrivals.data() +
                                    std::accumulate(earlier.begin(), earlier.end(), 0));
  }

 private:
  static constexpr std::size_t kLanes = 4;        ///< compared at once
  static constexpr std::size_t kMostBlocks = 16;  ///< of kLanes that are counted; more are halved first

  struct AtCell {
    std::vector<Stay> borders;
    std::vector<Tick> arrivals;  ///< of the stays, and kNever up to a multiple of kLanes
  };

  Stay stay(const Route& route, std::size_t stop) const;
  static void fill_up(AtCell& at);

  const UnitMoves& moves_;
  std::vector<Route> routes_;  ///< by robot
  std::vector<AtCell> at_;     ///< by cell
};

}  // namespace sipplab
