// From the order in which robots visit cells to motions in continuous time: the longest path
// in a temporal plan graph. [MP16]: Hoenig, Kumar, Cohen, Ma, Xu, Ayanian and Koenig, ICAPS
// 2016 (MAPF-POST); here with the lags of disks in contact, and exact.
#pragma once

#include <vector>

#include "planner/complete/exact_time.hpp"
#include "planner/complete/visits.hpp"
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
/// else is to be kept. Smaller disks may follow closer; the same lags are safe for them.
ExactTime follow_lag(Cell left, Cell entered);

/// When each robot arrives at the cell of each visit, in times of a unit move: as early as
/// the order of visits and follow_lag allow, by Visits' numbers. Visits that were taken out
/// have time 0. O(visits).
std::vector<ExactTime> earliest_arrivals(const FreeGrid& grid, const Visits& visits);

/// Motions at these times; moves that go straight on without a wait become one motion.
Solution timed_motions(const FreeGrid& grid, const Visits& visits, const std::vector<ExactTime>& arrivals,
                       double unit_move_s);

}  // namespace sipplab
