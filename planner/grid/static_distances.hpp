// What the map's obstacles add to the way of one robot to its goal.
#pragma once

#include <array>
#include <cstdint>
#include <unordered_map>
#include <vector>

#include "planner/grid/step_table.hpp"

namespace sipplab {

/// Lengths of the shortest ways over the steps of a neighbourhood, nobody else being on the map. From
/// each goal A* spreads out backwards, as far as somebody asks and no farther (reverse resumable A*;
/// Silver, AIIDE 2005), over buckets of OPEN one cell wide (Dial 1969).
class StaticDistances {
 public:
  /// What is known of a goal is kept for the next try of prioritized planning, up to this much in all;
  /// for 10,000 robots on 512 x 512 cells it would be 20 GB.
  static constexpr std::size_t kMostKeptBytes = std::size_t{64} << 20;

  /// `steps` are those of neighbourhood(k). All three must outlive this.
  StaticDistances(const GridMap& map, const LineOfSight& line_of_sight, StepTable& steps, int k);

  /// The goal of the questions that follow. Those about cells between it and `towards` are the quickest.
  /// REQUIRES: both are legal.
  void set_goal(Cell goal, Cell towards);

  /// Cells by which the shortest way from `cell` to the goal is longer than on an empty map: 0 or more;
  /// kForever where there is none. O(1) where all between the two is free; else O(cells * steps) over
  /// all calls for a goal. REQUIRES: a goal is set, and the cell is legal.
  double detour_cells(Cell cell) {
    return is_open_ || line_of_sight_.is_open_between(cell, goal_) ? 0 : searched_detour_cells(cell);
  }

 private:
  struct Step {
    Cell cell;
    std::ptrdiff_t index_offset;
    double cells;
  };
  /// A cell in OPEN, so far from the goal.
  struct Open {
    double cells;
    Cell cell;
  };
  /// Along the longest step, of sqrt(13) cells, f grows by twice its length at most: no two entries are
  /// more buckets apart.
  static constexpr std::size_t kBuckets = 8 + 1;
  /// What is known of the ways to one goal.
  struct Spread {
    Cell towards;
    double least_f = 0;                               ///< that of the goal
    std::vector<double> cells;                        ///< by cell; final where f is below the level
    std::size_t level = 0;                            ///< whole cells by which f exceeds the least
    std::array<std::vector<Open>, kBuckets> buckets;  ///< by level, in a ring
    std::size_t open = 0;                             ///< entries in all buckets
  };

  using Spreads = std::unordered_map<std::size_t, Spread>;  ///< by index of the goal

  double searched_detour_cells(Cell cell);
  /// What is known of goal_; begun where nothing is.
  Spread& spread_of_goal();
  /// Empties the bucket of the level, and goes on to the next.
  void grow(Spread& spread) const;

  const GridMap& map_;
  bool is_open_;  ///< nothing stands on the map
  const LineOfSight& line_of_sight_;
  StepTable& table_;
  int k_;
  std::vector<Step> steps_;  ///< of the neighbourhood
  Spreads spreads_;
  Cell goal_;
  Cell towards_;
  Spread* spread_ = nullptr;  ///< of goal_; none before it is asked for
};

}  // namespace sipplab
