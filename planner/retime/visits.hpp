// Which robot visits which cell, and in which order: what is left of a plan in discrete time when
// its clock is taken away.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

#include "planner/grid/free_grid.hpp"

namespace sipplab {

/// Position of a visit in Visits.
using VisitId = std::uint32_t;
inline constexpr VisitId kNoVisit = UINT32_MAX;

/// A robot's stay at a cell, from its arrival until it leaves for another one.
struct Visit {
  CellId cell = 0;
  RobotId robot = 0;
  VisitId before = kNoVisit;       ///< of the same robot
  VisitId after = kNoVisit;        ///< of the same robot
  VisitId before_here = kNoVisit;  ///< at the same cell
  VisitId after_here = kNoVisit;   ///< at the same cell
};

class Visits {
 public:
  Visits() = default;
  /// The visits of a plan whose steps keep the rules of Pibt::make_step.
  /// O(robots x steps + cells).
  Visits(const std::vector<std::vector<CellId>>& steps, std::size_t cells);

  std::size_t robots() const { return first_.size(); }
  std::size_t size() const { return visits_.size(); }
  const Visit& operator[](VisitId id) const { return visits_[id]; }
  /// At the robot's start.
  VisitId first_of(RobotId robot) const { return first_[robot]; }

  /// Takes out every round trip of a robot, back to a cell that no other robot visits in the
  /// meantime: it may as well wait there. Afterwards
  ///  (1) each robot goes from its start to its goal by moves that it made before;
  ///  (2) the visits that are left to a cell have the order that they had;
  ///  (3) no two visits of one robot follow each other at a cell.
  /// A plan in discrete time is still behind it: the old one, with robots that wait. O(size).
  void remove_round_trips();

 private:
  friend class VisitCollector;

  void join(VisitId earlier, VisitId later, std::vector<VisitId>& to_look_at);

  std::vector<Visit> visits_;
  std::vector<VisitId> first_;
};

/// Visits of a plan in any times, robot by robot.
class VisitCollector {
 public:
  explicit VisitCollector(std::size_t cells) : cells_(cells) {}

  /// A further robot is at this cell at time 0.
  void add_robot(CellId cell);
  /// It goes on to this cell.
  void add_move(CellId cell, double begin_s, double end_s);

  /// None if two robots are at the same cell at the same time, or one comes where another one stays for ever.
  /// O(visits log(visits to a cell)).
  std::optional<Visits> take() &&;

 private:
  struct Stay {
    double begin_s = 0;
    double end_s = 0;
  };

  std::size_t cells_;
  Visits visits_;
  std::vector<Stay> stays_;  ///< of visits
};

}  // namespace sipplab
