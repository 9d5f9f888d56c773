// How much obstacles of the map lengthen the path of one robot to its goal.
#pragma once

#include <array>
#include <cstdint>
#include <unordered_map>
#include <vector>

#include "planner/core/arena.hpp"
#include "planner/grid/step_table.hpp"

namespace sipplab {

/// Lengths of the shortest paths over the steps of a neighbourhood, without other robots. From each goal
/// Dijkstra's search spreads out backwards, only as far as queries need, over buckets of OPEN one cell wide
/// (Dial 1969). Lengths are whole numbers of a tiny unit, so that paths of equal length are recognised: of
/// those over eight neighbours the search follows only the one that goes diagonally as soon as it can
/// (Harabor and Grastien, AAAI 2011).
class StaticDistances {
 public:
  /// What is known of each goal is kept for the next try of prioritized planning, up to this much in all;
  /// for 10,000 robots on 512 x 512 cells it would be 20 GB.
  static constexpr std::size_t kMostKeptBytes = std::size_t{64} << 20;

  /// `steps` are those of neighbourhood(k). All three must outlive this.
  StaticDistances(const GridMap& map, const LineOfSight& line_of_sight, StepTable& steps, int k);

  /// The goal of the queries that follow. Those about cells on the way from `towards` cost least.
  /// REQUIRES: the goal is legal.
  void set_goal(Cell goal, Cell towards);

  /// Cells by which the shortest path from `cell` to the goal is longer than on an empty map: 0 or more;
  /// kForever if there is none. O(1) if everything between the two is free; else O(cells * steps) over
  /// all calls for a goal. REQUIRES: a goal is set, and the cell is legal.
  double excess_cells(Cell cell) {
    return is_open_ || line_of_sight_.is_open_between(cell, goal_) ? 0 : searched_excess_cells(cell);
  }

  /// The last cell in sight of those at which a shortest path from `cell` to the goal turns; `cell` if there
  /// is none. O(length of the path). REQUIRES: a goal is set, and the cell is legal.
  Cell turning_point(Cell cell);

 private:
  /// Of a path, in 2^-22 cells; a step is rounded down. With 48 bits no path on a map is too long.
  using Length = std::uint64_t;
  static constexpr int kCellBits = 22;
  static constexpr double kCellsPerUnit = 0x1p-22;
  static constexpr int kLengthBits = 48;
  static constexpr Length kFar = (Length{1} << kLengthBits) - 1;

  struct Step {
    Cell cell;
    std::ptrdiff_t index_offset;
    Length length;
  };
  /// What is known of a cell: its distance to the goal, and the steps that lead on from it.
  struct Known {
    std::uint64_t length : kLengthBits = kFar;  ///< final if the estimate is below the level
    std::uint64_t pending : 8 = 0;              ///< steps to follow
    std::uint64_t followed : 8 = 0;
  };
  /// The longest step, of sqrt(13) cells, raises the estimate by at most twice its length.
  static constexpr std::size_t kBuckets = 9;
  /// What is known of the paths to one goal.
  struct Spread {
    ArenaVector<Known> known;                         ///< by cell
    std::array<ArenaVector<Cell>, kBuckets> buckets;  ///< by level, in a ring
    Cell towards;                                     ///< the cell that is looked for first
    std::size_t level = 0;                            ///< whole cells of the estimate
    std::size_t open = 0;                             ///< entries in all buckets

    explicit Spread(Arena& arena)
        : known(arena), buckets{ArenaVector<Cell>(arena), ArenaVector<Cell>(arena),
                                ArenaVector<Cell>(arena), ArenaVector<Cell>(arena),
                                ArenaVector<Cell>(arena), ArenaVector<Cell>(arena),
                                ArenaVector<Cell>(arena), ArenaVector<Cell>(arena),
                                ArenaVector<Cell>(arena)} {}
  };

  using Spreads = std::unordered_map<std::size_t, Spread>;  ///< by index of the goal

  double searched_excess_cells(Cell cell);
  /// A step of a shortest path to the goal. REQUIRES: the cell's distance is final, and not 0.
  const Step& step_to_goal(Cell cell) const;
  /// What is known of goal_; a new spread if there is none.
  Spread& spread_of_goal();
  /// A lower bound, in whole cells, on the paths from the goal by a cell at this distance to
  /// spread.towards.
  std::size_t estimate(const Spread& spread, Cell cell, Length length) const;
  /// Empties the bucket of the level and goes on to the next.
  void grow(Spread& spread) const;
  /// The steps to follow from a cell that was reached by `step` from a cell with these clear steps.
  std::uint32_t followers(std::size_t step, std::uint32_t clear_before) const;

  const GridMap& map_;
  bool is_open_;  ///< no cell of the map is blocked
  const LineOfSight& line_of_sight_;
  StepTable& table_;
  int k_;
  bool is_canonical_;        ///< of paths of equal length one is followed
  std::vector<Step> steps_;  ///< of the neighbourhood
  Arena arena_;
  Spreads spreads_;
  Cell goal_;
  Cell towards_;
  Spread* spread_ = nullptr;  ///< of goal_; null until it is asked for
};

}  // namespace sipplab
