// How early each robot could arrive if it were alone: lower bounds on any plan.
#pragma once

#include <vector>

#include "planner/grid/line_of_sight.hpp"
#include "sipplab/improve.hpp"
#include "sipplab/single_agent_planner.hpp"

namespace sipplab {

/// Pairs of cells looked at for one robot; about a hundredth of a second. On the paper's
/// warehouse every robot needs less.
inline constexpr std::size_t kMostStaticWork = 1'000'000;
/// ... and for all robots together; about two seconds. Up to 200 robots have the former.
inline constexpr std::size_t kMostStaticWorkOfAll = 200'000'000;

/// ... where a bound is only recorded, beside plannings that are shorter than that: about 0.2 s.
inline constexpr std::size_t kMostRecordedWork = 20'000'000;

/// Length, in cells, of the shortest path of straight moves between cell centres that a disk
/// can make on the map; kForever if there is none.
///
/// A* over all cells in line of sight, limited to those of an ellipse: `longest` is the
/// length of some path that exists. Exact unless the work for it would exceed `most_work`;
/// then the least f in OPEN, which is a lower bound, too.
double shortest_any_angle_cells(const GridMap& map, const LineOfSight& line_of_sight, Cell from, Cell to,
                                double longest, std::size_t most_work = kMostStaticWork);

/// The same over the steps of the 2^k neighbourhood; always exact.
double shortest_grid_cells(const GridMap& map, const LineOfSight& line_of_sight, Cell from, Cell to, int k);

/// Lower bounds on the arrival of each robot alone on the map, in seconds. `solo_cells` are the
/// lengths of paths that exist, by robot. Robots that are looked at after `limits` are over have the time of
/// a straight line.
std::vector<double> static_times_s(const Instance& instance, bool any_angle, int connectedness,
                                   const std::vector<double>& solo_cells, const SearchLimits& limits = {},
                                   std::size_t most_work_of_all = kMostStaticWorkOfAll);

LowerBound lower_bound(const std::vector<double>& static_times_s);

/// That of an instance of which there is no plan, by the moves that are allowed, within `most_work`; where
/// the robots and the map are too large for it, obstacles do not count.
LowerBound lower_bound(const Instance& instance, bool any_angle, int connectedness,
                       std::size_t most_work = kMostRecordedWork);

}  // namespace sipplab
