// Disks in motion and at rest, found by place and time: what queries of a ReservationTable search.
#pragma once

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdint>
#include <vector>

#include "planner/core/arena.hpp"
#include "planner/geometry/moving_disk.hpp"
#include "planner/reservation/near_filter.hpp"
#include "sipplab/grid_map.hpp"

namespace sipplab {

/// Where a disk is during some time.
struct Sweep {
  Vec2 from;
  Vec2 to;
  double radius;
};

/// Blocks of cells, each small enough that few disks matter to a robot in it. A disk matters to a block if it
/// comes nearer to the block's square than its radius plus `room`.
class Blocks {
 public:
  /// The smallest blocks of which there are at most `most`.
  Blocks(const GridMap& map, double room, std::size_t most);

  std::size_t count() const { return static_cast<std::size_t>(columns_) * static_cast<std::size_t>(rows_); }
  /// The block of a place on the map.
  std::size_t at(Vec2 place) const {
    return static_cast<std::size_t>((static_cast<std::int32_t>(place.y + kHalfCell) >> shift_) * columns_ +
                                    (static_cast<std::int32_t>(place.x + kHalfCell) >> shift_));
  }
  /// Calls visit(block) for each block to which the disk matters, and for a few more.
  template <class Visit>
  void for_each_near(const Sweep& sweep, Visit&& visit) const;

 private:
  static constexpr double kHalfCell = 0.5;

  double room_;
  int shift_ = 1;
  std::int32_t columns_ = 0;
  std::int32_t rows_ = 0;
};

/// The disks of one slice of time, by block. A slot of 16 bytes holds the indices of seven entries, zero for
/// none, and of a slot with more.
class Slice {
 public:
  Slice(const Blocks& blocks, Arena& arena);
  /// With the same disks.
  Slice(const Slice& before, const Blocks& blocks, Arena& arena);

  bool is_empty(std::size_t block) const { return slots_[block].low == 0; }

  /// Calls test(disk) for disks that may come nearer to a robot in the block than the sum of the radii, until
  /// one call returns true. Returns whether one did.
  template <class Test>
  bool any_near(std::size_t block, const NearFilter& filter, Test&& test) const {
    const Slot* slot = &slots_[block];
    if (slot->low == 0) return false;
    while (true) {
      if (any_of_four(slot->low, filter, test)) return true;
      const std::uint64_t high = slot->high & kIdsOfHigh;
      if (high != 0 && any_of_four(high, filter, test)) return true;
      const std::uint64_t more = slot->high >> kMoreShift;
      if (more == 0) return false;
      slot = &more_[more];
    }
  }

  /// Whether there is room for one more, wherever it is.
  bool fits_any(const Blocks& blocks) const {
    return entry_count_ < kMostEntries && more_count_ + blocks.count() <= kMostEntries;
  }
  /// Whether there is room for this one.
  bool fits(const Sweep& sweep, const Blocks& blocks) const;
  /// REQUIRES: it fits.
  void put(const SliceEntry& entry, const Sweep& sweep, const Blocks& blocks, Arena& arena);
  /// REQUIRES: the same was put and not removed since.
  void remove(std::uint32_t disk, const Sweep& sweep, const Blocks& blocks);

 private:
  using EntryId = std::uint16_t;
  static constexpr std::size_t kMostEntries = UINT16_MAX;
  static constexpr int kIdBits = 16;
  static constexpr int kMoreShift = 48;
  static constexpr std::uint64_t kIdsOfHigh = (std::uint64_t{1} << kMoreShift) - 1;
  /// Four ids, and three with the index of the next slot above them; the newest is the lowest.
  struct alignas(16) Slot {
    std::uint64_t low;
    std::uint64_t high;

    bool is_full() const { return (high >> (kMoreShift - kIdBits) & UINT16_MAX) != 0; }
    void push(EntryId id) {
      high = (high & ~kIdsOfHigh) | ((high << kIdBits | low >> kMoreShift) & kIdsOfHigh);
      low = low << kIdBits | id;
    }
    void pop() {
      low = low >> kIdBits | high << kMoreShift;
      high = (high & ~kIdsOfHigh) | (high & kIdsOfHigh) >> kIdBits;
    }
  };

  template <class Test>
  bool any_of_four(std::uint64_t ids, const NearFilter& filter, Test& test) const {
    const auto entry = [&](int i) -> const SliceEntry& {
      return entries_[ids >> (kIdBits * i) & UINT16_MAX];
    };
    for (unsigned near = filter.near(entry(0), entry(1), entry(2), entry(3)); near != 0; near &= near - 1) {
      if (test(entry(std::countr_zero(near)).disk)) return true;
    }
    return false;
  }
  void push(Slot& slot, EntryId entry, Arena& arena) {
    if (slot.is_full()) overflow(slot, arena);
    slot.push(entry);
  }
  void overflow(Slot& slot, Arena& arena);
  /// The entry of a disk. REQUIRES: it is in the slot, or in one with more.
  EntryId entry_of(const Slot& slot, std::uint32_t disk) const;
  /// REQUIRES: as entry_of().
  void take_out(Slot& slot, EntryId entry);

  Slot* slots_;           ///< by block
  SliceEntry* entries_;   ///< the first is never near
  Slot* more_ = nullptr;  ///< the first is unused
  std::uint32_t entry_count_ = 1, entry_capacity_, free_entry_ = 0;
  std::uint32_t more_count_ = 1, more_capacity_ = 0, free_more_ = 0;
};

/// Disks lie in each slice of time that they meet. The last slice holds only disks that rest for ever, mostly
/// at goals, and stands for all later times. A disk that would be in too many slices, or beyond them, is
/// taken to fill a circle about its middle at all times.
class TimeSlices {
 public:
  /// Memory comes from the arena. A slice takes `slice_s`.
  TimeSlices(const Blocks& blocks, double slice_s, double time_margin_s, Arena& arena)
      : blocks_(blocks),
        slice_s_(slice_s),
        per_second_(1 / slice_s),
        time_margin_s_(time_margin_s),
        arena_(arena),
        slices_(arena),
        others_(arena) {
    clear();
  }

  /// Forgets all disks, after a reset of the arena.
  void clear();

  void put(const MovingDisk& disk, std::uint32_t id);
  /// REQUIRES: the same was put and not removed since.
  void remove(const MovingDisk& disk, std::uint32_t id);

  double per_second() const { return per_second_; }
  double slice_s() const { return slice_s_; }
  /// Disks are taken to stay at least this much longer.
  double margin_s() const { return kMargin / 2 * slice_s_; }

  /// As in Slice, for slice number `slice` and the disks in no slice. During [begin_s, end_s] of the slice
  /// the robot is at `origin` + velocity * time, absolute, and about halfway in the block.
  template <class Test>
  bool any_near(std::size_t slice, std::size_t block, NearFilter& filter, Vec2 origin, Vec2 velocity,
                double begin_s, double end_s, Test&& test) const {
    const Slice& in = slices_[std::min(slice, slices_.size() - 1)];
    if (in.is_empty(block) && others_.empty()) return false;
    const double slice_s = static_cast<double>(slice) * slice_s_;
    filter.set(origin + velocity * slice_s, (begin_s - slice_s) * per_second_,
               (end_s - slice_s) * per_second_);
    return in.any_near(block, filter, test) ||
           std::any_of(others_.begin(), others_.end(),
                       [&](const Slice& others) { return others.any_near(block, filter, test); });
  }

 private:
  /// Slices. Disks that rest for longer, move more slowly or come later are listed apart.
  static constexpr double kLongestRest = 64;
  static constexpr double kMostForCell = 8;
  static constexpr double kMostSlices = 4096;
  /// Slices. Covers rounding to floats within a slice, and of the time at which it begins.
  static constexpr double kMargin = 1e-5;
  /// Cells for each cell per slice. The error of floats in the places of very fast disks.
  static constexpr double kLostOfSpeed = 1e-6;

  struct Span {
    std::size_t first;
    std::size_t last;
  };

  /// Empty for a disk that goes in no slice; up to the last slice for one that rests for ever.
  Span span_of(const MovingDisk& disk) const;
  SliceEntry part_of(const MovingDisk& disk, std::size_t slice, std::uint32_t id) const;
  Sweep sweep_of(const MovingDisk& disk, std::size_t slice) const;

  const Blocks& blocks_;
  double slice_s_;
  double per_second_;
  double time_margin_s_;
  Arena& arena_;
  ArenaVector<Slice> slices_;
  ArenaVector<Slice> others_;         ///< disks in no slice; as many as it takes
  std::vector<std::uint16_t> other_;  ///< by disk: 1 + its index in others_; 0: it is in slices
};

template <class Visit>
void Blocks::for_each_near(const Sweep& sweep, Visit&& visit) const {
  const double reach = sweep.radius + room_;
  const auto [left, right] = std::minmax(sweep.from.x, sweep.to.x);
  const auto [top, bottom] = std::minmax(sweep.from.y, sweep.to.y);
  const double side = 1 << shift_;
  const double per_side = 1 / side;
  const auto block_of = [&](double low, std::int32_t most) {
    const double block = (low + kHalfCell) * per_side;
    return block <= 0 ? 0 : block >= most ? most : static_cast<std::int32_t>(block);
  };
  const std::int32_t first_row = block_of(top - reach, rows_ - 1);
  const std::int32_t last_row = block_of(bottom + reach, rows_ - 1);
  for (std::int32_t row = first_row; row <= last_row; ++row) {
    const double row_top = row * side - kHalfCell;
    const double aside = std::max({0.0, top - row_top - side, row_top - bottom});
    const double half_squared = reach * reach - aside * aside;
    if (half_squared <= 0) continue;
    const double half = std::sqrt(half_squared);
    const std::int32_t first = block_of(left - half, columns_ - 1);
    const std::int32_t last = block_of(right + half, columns_ - 1);
    for (std::int32_t column = first; column <= last; ++column) {
      visit(static_cast<std::size_t>(row * columns_ + column));
    }
  }
}

}  // namespace sipplab
