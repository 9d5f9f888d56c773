// From the order in which robots visit cells to motions in continuous time: the longest path
// in a temporal plan graph. [MP16]: Hoenig, Kumar, Cohen, Ma, Xu, Ayanian and Koenig, ICAPS
// 2016 (MAPF-POST); here with the lags of disks in contact, and exact.
#pragma once

#include <cstdint>
#include <vector>

#include "planner/retime/exact_time.hpp"
#include "planner/retime/visits.hpp"
#include "sipplab/solution.hpp"

namespace sipplab {

/// How long after a robot sets off from a cell, in the direction `left`, the next one may
/// arrive there, in the direction `entered`; unit displacements, both at speed 1.
///
/// With open disks of radius 0.5, whose centres have to stay 1 apart, and a lag D (the
/// follower sets off D - 1 after the leader, so that it is out of reach before, if D >= 1):
///  * same direction: the distance is D all the time that both move, so D >= 1;
///  * at right angles: tau after it set off the leader is tau away from the cell, the
///    follower D - tau; the square of their distance, tau^2 + (D - tau)^2, is least at
///    tau = D / 2, where it is D^2 / 2, so D >= sqrt(2);
///  * opposite: the follower comes from where the leader goes; it may set off once the leader
///    has got there (and further), so D >= 2. Never binding, because the leader has to leave
///    that cell as well before the follower can be there.
/// Two unit moves that share no cell are 1 apart at least, all the time, so that nothing
/// else is to be kept. Smaller disks follow closer in proportion, but for those that never bind.
ExactTime follow_lag(Cell left, Cell entered);

/// Parts of a unit move in which times are counted where whole numbers are to be fast: a right angle's lag is
/// longer than exact by 1e-4 moves.
inline constexpr std::int32_t kTicksPerMove = 4096;
/// follow_lag() for disks of this reach, in ticks, rounded up.
std::int32_t follow_ticks(Cell left, Cell entered, double reach_cells);

/// Unit moves at the least times.
struct UnitSchedule {
  /// At the cell of each visit, by Visits' numbers; those of visits that were taken out mean nothing.
  std::vector<double> arrivals_s;
  /// Moves that go straight on without a wait are one motion.
  Solution solution;
  /// Visits that wait for each other, as LeastTimes::circle has them: robots follow each other in a ring that
  /// they cannot turn. Nothing else is there then.
  std::vector<VisitId> circle;
};

/// As early as the order of visits to each cell and the lags of disks of this reach allow: with those of
/// follow_lag, exactly, for a reach of 1, and with proportionally smaller ones, in doubles, below. That
/// a visit waits for the one before at its cell is enough, since two lags are longer than any one. O(visits).
/// REQUIRES: 0 < reach_cells <= 1; no robot visits a cell after one that stays there for ever.
UnitSchedule unit_schedule(const FreeGrid& grid, const Visits& visits, double reach_cells,
                           double unit_move_s);

/// The step at which each visit begins, by Visits' numbers, if all robots step at once and one may enter a
/// cell in the step in which another one leaves it. REQUIRES: as unit_schedule().
std::vector<std::int64_t> unit_steps(const FreeGrid& grid, const Visits& visits);

/// The tick at which each visit begins, by Visits' numbers, with lags of follow_ticks(); empty if some visits
/// wait for each other. REQUIRES: as unit_schedule().
std::vector<std::int64_t> unit_ticks(const FreeGrid& grid, const Visits& visits, double reach_cells);

}  // namespace sipplab
