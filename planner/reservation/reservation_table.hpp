// The space-time that planned robots, dynamic obstacles and protected starts take:
// planned disks in, safe intervals and earliest departures out.
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory_resource>
#include <span>
#include <utility>
#include <vector>

#include "planner/geometry/interval_set.hpp"
#include "planner/geometry/moving_disk.hpp"
#include "planner/grid/grid_map.hpp"
#include "planner/reservation/cell_walk.hpp"
#include "planner/solution/trajectory.hpp"

namespace sipplab {

/// Disks in motion, found by place and time.
///
/// Each cell keeps a timeline: the disks that come near enough to its square to
/// matter to a robot whose centre is in that square, with the span of time in which
/// they are near, sorted by its beginning. A query bisects the timelines of the
/// cells on its way for just the seconds that it spends there.
class ReservationTable {
 public:
  using DiskId = std::uint32_t;
  static constexpr DiskId kNoDisk = UINT32_MAX;

  /// For robots of radius up to `max_radius_cells` that ask. Every disk is taken to be
  /// where it is `time_margin_s` sooner and later as well.
  ReservationTable(const GridMap& map, double max_radius_cells, double time_margin_s = 0);
  ReservationTable(const ReservationTable&) = delete;
  ReservationTable& operator=(const ReservationTable&) = delete;

  /// Forgets all disks; keeps memory for the next try.
  void clear();

  /// Adds one disk. O(cells near its way * log disks there).
  DiskId add(const MovingDisk& disk);
  /// Removes a disk; its id may be given to another one from now on.
  /// REQUIRES: added, not removed yet. O(cells near its way * disks there).
  void remove(DiskId id);
  /// Adds a whole trajectory and the rest at its end for ever; their ids, for remove().
  std::vector<DiskId> add(const Trajectory& trajectory, double radius_cells);

  /// Keeps robots away from a disk for ever, except while they are in the disk of the same
  /// reach around `pardoned`. For the robot that is planned next only: forgotten by
  /// clear_keepouts(). O(1); each makes every query a little slower.
  void add_keepout(Vec2 place, double radius_cells, Vec2 pardoned);
  void clear_keepouts() { keepouts_.clear(); }

  /// Maximal closed spans in which a disk of this radius may stay at the cell, in
  /// order. Valid until a disk is added or removed. O(1) unless the radius is another than
  /// at the last call for this cell or a disk near it was removed since.
  std::span<const SafeInterval> safe_intervals(Cell cell, double radius_cells);

  /// The least departure t >= from_s for which the move overlaps no disk. Gives up as
  /// soon as every departure up to until_s is known to be unsafe and then returns
  /// some lower bound on the least safe departure that is greater than until_s; kForever
  /// where no departure from from_s on is safe.
  /// Of the disks that stood in the way, the last is stored in `likely_blocker` and is
  /// looked at first by the next query: who asks for similar moves passes the same variable,
  /// kNoDisk at first. The answer does not depend on it.
  /// REQUIRES: the move joins two different cell centres of the map.
  double earliest_departure(const Move& move, double radius_cells, double from_s, double until_s,
                            DiskId* likely_blocker = nullptr);

  /// The same by looking at every disk: the plain twin, for tests and benchmarks.
  /// The answers are equal to the last bit: both are the least time in none of the open
  /// intervals of unsafe departures, whatever the order in which disks were added.
  double earliest_departure_plain(const Move& move, double radius_cells, double from_s, double until_s) const;

 private:
  /// A disk's stay near one cell, or a little more: plans of many robots are mostly made of these, and in
  /// floats they take half the memory. Questions that they let through are answered from the disk itself.
  struct Presence {
    float enter_s;
    float exit_s;
    float latest_exit_s;  ///< of this and all before it in the timeline
    DiskId disk;
  };
  struct Timeline {
    explicit Timeline(std::pmr::memory_resource* memory) : passing(memory), resting(memory), safe(memory) {}
    Timeline(Timeline&&) = default;
    Timeline(const Timeline&) = delete;  // a copy would take its memory elsewhere

    std::pmr::vector<Presence> passing;  ///< sorted by enter_s; finite
    std::pmr::vector<Presence> resting;  ///< for ever from enter_s on
    /// Safe intervals of the cell for robots of `safe_radius`, kept up to date as disks are
    /// added; negative: to be computed when asked for.
    IntervalSet safe;
    double safe_radius = -1;
    bool used = false;  ///< whether used_cells_ names it

    bool is_empty() const { return passing.empty() && resting.empty(); }
    /// A finite presence. O(log size + those behind it).
    void insert(const Presence& presence);
    /// Brings latest_exit_s up to date from `place` on. O(those that change).
    void repair_from(std::pmr::vector<Presence>::iterator place);
    /// The first passing presence that may end after `time_s`. O(log size).
    const Presence* first_after(float time_s) const;
  };
  struct Keepout {
    Vec2 place;
    double radius;
    Vec2 pardoned;
  };
  bool is_kept_out(const Displacement& way, double radius_cells) const;

  template <class Visitor>
  void for_each_cell_near(const MovingDisk& disk, Visitor&& visit) const;
  /// Where departing at `departure_s` is unsafe for a disk met during the visit: the end of
  /// the unsafe departures around it, and the disk in `blocker`. Else departure_s.
  double next_departure(const Move& move, const CellVisit& visit, double radius_cells, double departure_s,
                        DiskId& blocker);
  /// Whether the disk was not looked at yet for this move and departure: it may be near
  /// several cells of the way.
  bool is_news(DiskId id) { return std::exchange(answered_[id], question_) != question_; }
  double end_of_overlap(const Move& move, const MovingDisk& disk, double radius_cells,
                        double departure_s) const;
  /// Unsafe times, sooner and later by the margin.
  OpenInterval widened(OpenInterval unsafe) const {
    if (unsafe.empty()) return unsafe;
    return {unsafe.begin_s - time_margin_s_, unsafe.end_s + time_margin_s_};
  }

  const GridMap& map_;
  double max_radius_;
  double time_margin_s_;
  /// Where the timelines lie: many small arrays that grow and are dropped together.
  std::pmr::monotonic_buffer_resource memory_;
  std::vector<MovingDisk> disks_;
  std::vector<DiskId> free_ids_;         ///< of disks that were removed
  std::uint64_t question_ = 0;           ///< number of a move and departure that is asked about
  std::vector<std::uint64_t> answered_;  ///< by disk: the last question for which it was looked at
  std::vector<Timeline> timelines_;
  std::vector<Keepout> keepouts_;
  std::vector<std::size_t> used_cells_;  ///< timelines that have held a disk since clear()
  std::vector<CellVisit> visits_;        ///< scratch, with room for the longest way
};

}  // namespace sipplab
