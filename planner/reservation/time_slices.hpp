// Short motions, found by place and time: the part of a ReservationTable that most queries are about.
#pragma once

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdint>

#include "planner/core/arena.hpp"
#include "planner/geometry/moving_disk.hpp"
#include "planner/grid/grid_map.hpp"
#include "planner/reservation/near_filter.hpp"

namespace sipplab {

/// Blocks of cells, each small enough that the disks which matter to a robot in it are few. A disk matters to
/// a block where it comes nearer to the block's square than its radius and `room` together.
class Blocks {
 public:
  /// The smallest blocks of which there are `most` at most.
  Blocks(const GridMap& map, double room, std::size_t most);

  std::size_t count() const { return static_cast<std::size_t>(columns_) * static_cast<std::size_t>(rows_); }
  /// The block of a place on the map.
  std::size_t at(double x, double y) const {
    return static_cast<std::size_t>((static_cast<std::int32_t>(y + kHalfCell) >> shift_) * columns_ +
                                    (static_cast<std::int32_t>(x + kHalfCell) >> shift_));
  }
  /// Calls visit(block) for each block to which a disk matters that moves straight between the two points,
  /// and for a few more.
  template <class Visit>
  void for_each_near(Vec2 from, Vec2 to, double radius, Visit&& visit) const;

 private:
  static constexpr double kHalfCell = 0.5;

  double room_;
  int shift_ = 1;
  std::int32_t columns_ = 0;
  std::int32_t rows_ = 0;
};

/// For each slice of time and each block, the disks that matter there. A slot of 16 bytes holds the places of
/// seven entries of its slice, zero for none, and that of a slot with more.
class TimeSlices {
 public:
  /// Memory comes from the arena. A slice takes `slice_s`.
  TimeSlices(const Blocks& blocks, double slice_s, double time_margin_s, Arena& arena)
      : blocks_(blocks),
        slice_s_(slice_s),
        per_second_(1 / slice_s),
        time_margin_s_(time_margin_s),
        arena_(arena),
        slices_(arena) {}

  /// Forgets all, after a reset of the arena.
  void abandon() { slices_.abandon(); }

  /// False where the disk does not fit: it stays for too long, or there are too many; nothing changes then.
  bool put(const MovingDisk& disk, std::uint32_t id);
  /// REQUIRES: the same was put and not removed since.
  void remove(const MovingDisk& disk, std::uint32_t id);

  double per_second() const { return per_second_; }
  double slice_s() const { return slice_s_; }
  /// By so much disks are taken to stay longer, at least.
  double margin_s() const { return kMargin / 2 * slice_s_; }
  std::size_t size() const { return slices_.size(); }

  /// Shows test(disk) those that may come nearer to a robot than the sum of the radii, until it says yes:
  /// whether it did. During [begin_s, end_s], in slice `slice`, the robot is at `place` + `velocity` * time,
  /// and near the middle of it in the block.
  template <class Test>
  bool any_near(std::size_t slice, std::size_t block, const NearFilter& filter, Test&& test) const {
    if (slice >= slices_.size()) return false;
    const Slice& in = slices_[slice];
    const Slot* slot = &in.slots[block];
    if (slot->low == 0) return false;
    const SliceEntry* const entries = in.entries;
    while (true) {
      if (any_of_four(entries, slot->low, filter, test)) return true;
      const std::uint64_t high = slot->high & kIdsOfHigh;
      if (high != 0 && any_of_four(entries, high, filter, test)) return true;
      const std::uint64_t more = slot->high >> kMoreShift;
      if (more == 0) return false;
      slot = &in.more[more];
    }
  }

 private:
  using EntryId = std::uint16_t;
  static constexpr std::size_t kMostEntries = UINT16_MAX;
  /// Slices. Disks that stand for longer are none of ours, nor those that move so slowly, nor those of later
  /// times.
  static constexpr double kLongestStand = 3;
  static constexpr double kMostForCell = 8;
  static constexpr double kMostSlices = 4096;
  /// Slices. Covers roundings to floats within a slice, and of the time at which it begins.
  static constexpr double kMargin = 1e-5;
  /// Cells for each cell per slice. What floats lose of the places of very fast disks.
  static constexpr double kLostOfSpeed = 1e-6;

  static constexpr int kIdBits = 16;
  static constexpr int kMoreShift = 48;
  static constexpr std::uint64_t kIdsOfHigh = (std::uint64_t{1} << kMoreShift) - 1;
  /// Four ids, and three with the place of the next slot above them; the newest is the lowest.
  struct alignas(16) Slot {
    std::uint64_t low;
    std::uint64_t high;

    bool is_full() const { return (high >> (kMoreShift - kIdBits) & UINT16_MAX) != 0; }
    void push(EntryId id) {
      high = (high & ~kIdsOfHigh) | ((high << kIdBits | low >> kMoreShift) & kIdsOfHigh);
      low = low << kIdBits | id;
    }
    EntryId pop() {
      const auto id = static_cast<EntryId>(low & UINT16_MAX);
      low = low >> kIdBits | high << kMoreShift;
      high = (high & ~kIdsOfHigh) | (high & kIdsOfHigh) >> kIdBits;
      return id;
    }
  };
  struct Slice {
    Slot* slots;          ///< by block
    SliceEntry* entries;  ///< the first is nowhere
    Slot* more;           ///< the first is unused
    std::uint32_t entry_count, entry_capacity, free_entry;
    std::uint32_t more_count, more_capacity, free_more;
  };
  struct Span {
    std::size_t first;
    std::size_t last;
  };

  template <class Test>
  static bool any_of_four(const SliceEntry* entries, std::uint64_t ids, const NearFilter& filter,
                          Test& test) {
    const auto entry = [&](int i) -> const SliceEntry& { return entries[ids >> (kIdBits * i) & UINT16_MAX]; };
    for (unsigned near = filter.near(entry(0), entry(1), entry(2), entry(3)); near != 0; near &= near - 1) {
      if (test(entry(std::countr_zero(near)).disk)) return true;
    }
    return false;
  }

  bool find_span(const MovingDisk& disk, Span& span) const;
  void add_slice();
  SliceEntry part_of(const MovingDisk& disk, std::size_t slice, std::uint32_t id) const;
  template <class Visit>
  void for_each_block(const MovingDisk& disk, std::size_t slice, Visit&& visit) const;
  void push(Slice& in, Slot& slot, EntryId entry);
  EntryId take_out(Slice& in, Slot& slot, std::uint32_t id);

  const Blocks& blocks_;
  double slice_s_;
  double per_second_;
  double time_margin_s_;
  Arena& arena_;
  ArenaVector<Slice> slices_;
};

template <class Visit>
void Blocks::for_each_near(Vec2 from, Vec2 to, double radius, Visit&& visit) const {
  const double reach = radius + room_;
  const auto [left, right] = std::minmax(from.x, to.x);
  const auto [top, bottom] = std::minmax(from.y, to.y);
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
