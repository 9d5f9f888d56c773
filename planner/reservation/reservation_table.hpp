// The space-time that planned robots, dynamic obstacles and protected starts occupy: planned disks in, safe
// intervals and earliest departures out.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "planner/core/arena.hpp"
#include "planner/geometry/moving_disk.hpp"
#include "planner/reservation/safe_times.hpp"
#include "planner/reservation/time_slices.hpp"
#include "sipplab/grid_map.hpp"
#include "sipplab/single_agent_planner.hpp"
#include "sipplab/solution.hpp"

namespace sipplab {

/// What the table must know about the asking robots and their rules.
struct Askers {
  double max_radius_cells = 0.5;
  /// Slices of time suit this speed. Robots of any other may ask, too: queries of faster ones take longer.
  double speed_cells_per_s = 1;
  /// Every disk also occupies its place this much earlier and later.
  double time_margin_s = 0;
};

/// ... which are those of an instance.
Askers askers_of(const Instance& instance, const MotionRules& rules = {});

/// Disks in motion, found by place and time.
///
/// They lie in slices of time, each as long as a robot of usual speed needs for two cells (TimeSlices): a
/// query looks once into each slice that it meets, or for a faster robot once for two cells. Slices only name
/// candidates; the closed form of collision_interval.hpp decides.
class ReservationTable final : public Reservations {
 public:
  using DiskId = std::uint32_t;
  static constexpr DiskId kNoDisk = UINT32_MAX;

  ReservationTable(const GridMap& map, const Askers& askers);
  ReservationTable(const GridMap& map, double max_radius_cells)
      : ReservationTable(map, Askers{max_radius_cells}) {}
  ReservationTable(const ReservationTable&) = delete;
  ReservationTable& operator=(const ReservationTable&) = delete;

  /// Forgets all disks; keeps memory for the next try.
  void clear();

  /// Adds one disk. O(cells near its path).
  DiskId add(const MovingDisk& disk);
  /// Removes a disk; its id may be reused from now on.
  /// REQUIRES: added, not removed yet. O(cells near its path * disks there).
  void remove(DiskId id);
  /// REQUIRES: added, not removed yet.
  const MovingDisk& disk(DiskId id) const { return disks_[id]; }
  /// Adds a trajectory and the rest at its end for ever. Returns their ids, for remove().
  std::vector<DiskId> add(const Trajectory& trajectory, double radius_cells);

  /// Keeps robots away from a disk for ever, except while they are in the disk of the same reach around
  /// `pardoned`. Only for the robot that is planned next: forgotten by clear_keepouts(). O(1); each makes
  /// every query a little slower.
  void add_keepout(Vec2 place, double radius_cells, Vec2 pardoned);
  void clear_keepouts() { keepouts_.clear(); }

  /// Valid until a disk is added or removed, or another radius is asked for. O(1) for a few different radii,
  /// unless a disk near the cell was removed since.
  std::span<const SafeInterval> safe_intervals(Cell cell, double radius_cells) override {
    if (!keepouts_.empty() && is_kept_out(Displacement(centre(cell), centre(cell)), radius_cells)) return {};
    return safe_times_.at(map_.index(cell), radius_cells, disks_);
  }

  double earliest_departure(Cell from, Cell to, double speed_cells_per_s, double radius_cells, double from_s,
                            double until_s) const override;
  /// The same for a move that is known already. The last blocking disk is stored in `likely_blocker` and is
  /// checked first by the next query: callers with similar moves pass the same variable, kNoDisk at first.
  /// The answer depends neither on it nor on the order in which disks were added: it is the least time
  /// outside all open intervals of unsafe departures, to the last bit. REQUIRES: the move joins two different
  /// cell centres of the map.
  double earliest_departure(const Move& move, double radius_cells, double from_s, double until_s,
                            DiskId* likely_blocker = nullptr) const;

  /// A disk that the move overlaps if it departs then: `likely` if it is one, else the first that is met;
  /// kNoDisk if there is none. Depends on the disks and on `likely` alone, not on ids or the order in which
  /// disks were added. Time margins do not count.
  DiskId blocker(const Move& move, double radius_cells, double departure_s, DiskId likely) const;

 private:
  struct Keepout {
    Vec2 place;
    double radius;
    Vec2 pardoned;
  };
  struct Question;
  bool is_kept_out(const Displacement& path, double radius_cells) const;
  /// The end of the disk's unsafe departures around departure_s, or departure_s if it is safe.
  double end_of_overlap(const Move& move, const MovingDisk& disk, double radius_cells,
                        double departure_s) const;
  bool stands_in_the_way(Question& question, DiskId id) const;
  bool is_stopped(Question& question, double from_s, double to_s) const;
  int splits_of(const Move& move) const;
  /// Calls test(disk) for disks that the move, departing then, may come near in [from_s, to_s] of absolute
  /// time, and after(begin_s, end_s) after each window of time that it looks into, until one returns true.
  /// Returns whether one did.
  template <class Test, class After>
  bool walk(const Move& move, double departure_s, int splits, NearFilter& filter, double from_s, double to_s,
            Test&& test, After&& after) const;

  const GridMap& map_;
  Askers askers_;
  Arena arena_;
  Blocks blocks_;
  double filter_margin_;  ///< cells
  TimeSlices slices_;
  SafeTimes safe_times_;
  ArenaVector<MovingDisk> disks_;
  std::vector<DiskId> free_ids_;  ///< of disks that were removed
  std::vector<Keepout> keepouts_;
};

}  // namespace sipplab
