// How far free cells are from each robot's goal, in moves between four neighbours: a
// breadth-first search from each goal that goes only as far as it is asked.
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "planner/grid/free_grid.hpp"

namespace sipplab {

/// Between neighbours on a grid of four neighbours distances differ by exactly one, so two
/// bits a cell will do: "not seen yet", or the distance modulo 3. 10,000 robots on 40,000
/// free cells take 100 MB instead of 800 MB in 16 bits.
class GoalDistances {
 public:
  /// `grid` must outlive this. O(robots x cells / 4) bytes.
  GoalDistances(const FreeGrid& grid, std::vector<CellId> goals);

  CellId goal(RobotId robot) const { return goals_[robot]; }

  /// Moves from `cell` to the robot's goal; none if there is no path. Searches on until it
  /// is known, so that only the first call for a cell far away is slow: O(cells) over all
  /// calls for a robot. REQUIRES: first call for this robot, or a cell farther away than
  /// all that were asked for before.
  std::optional<std::uint32_t> first_distance(RobotId robot, CellId cell);

  /// Which neighbours of a cell are nearer to the robot's goal. Valid until the robot's next question.
  class Nearer {
   public:
    bool operator()(CellId to) const { return code_of(codes_, to) == code_; }

   private:
    friend GoalDistances;
    Nearer(const std::uint8_t* codes, unsigned code) : codes_(codes), code_(code) {}
    const std::uint8_t* codes_;
    unsigned code_;
  };
  /// REQUIRES: there is a path to the goal.
  Nearer nearer_than(RobotId robot, CellId from) {
    Search& search = searches_[robot];
    unsigned here = search.code(from);
    while (here == kUnseen && grow(search)) here = search.code(from);
    // Layers are seen whole: what is not seen yet is not nearer than what is.
    return {search.codes.data(), here == 1 ? 3 : here - 1};
  }

  /// Whether `to` is one move nearer to the robot's goal than `from`; otherwise it is one
  /// move farther. REQUIRES: the two are neighbours, and there is a path to the goal.
  bool is_nearer(RobotId robot, CellId from, CellId to) { return nearer_than(robot, from)(to); }

 private:
  static constexpr unsigned kUnseen = 0;
  static constexpr std::size_t kCellsPerByte = 4;

  static unsigned code_of(const std::uint8_t* codes, CellId cell) {
    return (codes[cell / kCellsPerByte] >> (2 * (cell % kCellsPerByte))) & 3u;
  }

  struct Search {
    std::vector<std::uint8_t> codes;  ///< two bits a cell: kUnseen, or 1 + distance % 3
    std::vector<CellId> layer;        ///< the cells seen last, all at `depth`
    std::vector<CellId>
        next_layer;  ///< memory for the next one: robots may be asked for by different threads
    std::uint32_t depth = 0;

    unsigned code(CellId cell) const { return code_of(codes.data(), cell); }
    void set_code(CellId cell, unsigned code) {
      codes[cell / kCellsPerByte] =
          static_cast<std::uint8_t>(codes[cell / kCellsPerByte] | code << (2 * (cell % kCellsPerByte)));
    }
  };

  /// Sees the next layer. False if there is none.
  bool grow(Search& search);

  const FreeGrid& grid_;
  std::vector<CellId> goals_;
  std::vector<Search> searches_;
};

}  // namespace sipplab
