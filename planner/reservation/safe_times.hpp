// By cell: which disks come near its centre, and when a robot may stay.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "planner/core/arena.hpp"
#include "planner/geometry/moving_disk.hpp"
#include "sipplab/geometry.hpp"
#include "sipplab/grid_map.hpp"

namespace sipplab {

/// By cell a list of the disks near it, the newest first; and for robots of a few radii safe intervals, from
/// which disks are cut when they are asked for: many never are. After a removal they are cut out of all time
/// anew.
class SafeTimes {
 public:
  using DiskId = std::uint32_t;

  SafeTimes(const GridMap& map, double max_radius_cells, double time_margin_s, Arena& arena);

  /// Forgets all disks, after a reset of the arena.
  void clear();

  void add(const MovingDisk& disk, DiskId id);
  /// REQUIRES: the same was added and not removed since.
  void remove(const MovingDisk& disk, DiskId id);

  /// In order. `disks` are all that were added, by id.
  std::span<const SafeInterval> at(std::size_t cell, double radius, const ArenaVector<MovingDisk>& disks) {
    for (std::size_t i = 0; i < used_; ++i) {
      if (by_radius_[i].radius != radius) continue;
      const Set& set = by_radius_[i].sets[cell];
      if (set.seen == heads_[cell]) return intervals_of(set);
    }
    return found_out(cell, radius, disks);
  }

 private:
  static constexpr SafeInterval kAllTime{};
  static constexpr std::uint32_t kRemoved = UINT32_MAX;
  static constexpr std::uint32_t kFirstRoom = 4;  ///< intervals; as many as fit the arena's smallest piece
  static constexpr std::size_t kMostRadii = 4;    ///< that are kept

  /// All of time if the capacity is 0.
  struct Set {
    Interval* intervals;
    std::uint32_t size;
    std::uint32_t capacity;
    std::uint32_t seen;  ///< the cell's list when its disks were cut, or kRemoved
  };
  struct OfRadius {
    double radius;
    Set* sets;  ///< by cell
  };
  struct Near {
    DiskId disk;
    std::uint32_t next;
  };

  static std::span<const SafeInterval> intervals_of(const Set& set) {
    if (set.capacity == 0) return {&kAllTime, 1};
    return {set.intervals, set.size};
  }
  std::span<const SafeInterval> found_out(std::size_t cell, double radius,
                                          const ArenaVector<MovingDisk>& disks);
  OfRadius& of_radius(double radius);
  void cut(Set& set, OpenInterval unsafe);
  void reserve(Set& set, std::uint32_t capacity);
  OpenInterval unsafe_at(std::size_t cell, const MovingDisk& disk, double radius) const;
  template <class Visit>
  void for_each_cell_near(const MovingDisk& disk, Visit&& visit) const;

  const GridMap& map_;
  double max_radius_;
  double time_margin_s_;
  Arena& arena_;
  std::array<OfRadius, kMostRadii> by_radius_{};
  std::size_t used_ = 0;              ///< of by_radius_
  std::size_t replaced_ = 0;          ///< how often one of them got another radius
  ArenaVector<std::uint32_t> heads_;  ///< by cell: its list; 0 for none
  ArenaVector<Near> near_;
  std::uint32_t free_near_ = 0;
};

}  // namespace sipplab
