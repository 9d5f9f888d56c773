#include "planner/reservation/time_slices.hpp"

#include <cstring>

#include "planner/core/assert.hpp"

namespace sipplab {

Blocks::Blocks(const GridMap& map, double room, std::size_t most) : room_(room) {
  for (;; ++shift_) {
    columns_ = ((map.width() - 1) >> shift_) + 1;
    rows_ = ((map.height() - 1) >> shift_) + 1;
    if (count() <= most) return;
  }
}

bool TimeSlices::find_span(const MovingDisk& disk, Span& span) const {
  const double first = (disk.begin_s - time_margin_s_) * per_second_ - kMargin;
  const double last = (disk.end_s + time_margin_s_) * per_second_ + kMargin;
  if (!(last < kMostSlices) || last - first > kLongestStand + kMostForCell * disk.way.length) return false;
  span = {static_cast<std::size_t>(std::max(first, 0.0)), static_cast<std::size_t>(std::max(last, 0.0))};
  return true;
}

void TimeSlices::add_slice() {
  const std::size_t blocks = blocks_.count();
  // About as many entries as the slice before.
  const std::uint32_t room = slices_.empty() ? 16 : std::max(slices_.back().entry_count, 16U);
  Slice slice{arena_.take<Slot>(blocks), arena_.take<SliceEntry>(room), nullptr, 1, room, 0, 1, 0, 0};
  std::memset(static_cast<void*>(slice.slots), 0, blocks * sizeof(Slot));
  slice.entries[0] = {0, 0, 0, 0, 1, -1, 0, 0};
  slices_.push_back(slice);
}

SliceEntry TimeSlices::part_of(const MovingDisk& disk, std::size_t slice, std::uint32_t id) const {
  const double begin_s = static_cast<double>(slice) / per_second_;
  const Vec2 place = disk.from + disk.velocity * (begin_s - disk.begin_s);
  const Vec2 velocity = disk.velocity * (1 / per_second_);
  const auto clipped = [](double slices) { return static_cast<float>(std::clamp(slices, -1.0, 2.0)); };
  return {static_cast<float>(place.x),
          static_cast<float>(place.y),
          static_cast<float>(velocity.x),
          static_cast<float>(velocity.y),
          clipped((disk.begin_s - time_margin_s_ - begin_s) * per_second_ - kMargin),
          clipped((disk.end_s + time_margin_s_ - begin_s) * per_second_ + kMargin),
          static_cast<float>(disk.radius + disk.speed * (time_margin_s_ + kLostOfSpeed / per_second_)),
          id};
}

template <class Visit>
void TimeSlices::for_each_block(const MovingDisk& disk, std::size_t slice, Visit&& visit) const {
  const double begin_s = (static_cast<double>(slice) - kMargin) / per_second_ - time_margin_s_;
  const double end_s = (static_cast<double>(slice + 1) + kMargin) / per_second_ + time_margin_s_;
  const auto place_at = [&](double time_s) {
    return disk.from + disk.velocity * (std::clamp(time_s, disk.begin_s, disk.end_s) - disk.begin_s);
  };
  blocks_.for_each_near(place_at(begin_s), place_at(end_s), disk.radius, visit);
}

void TimeSlices::push(Slice& in, Slot& slot, EntryId entry) {
  if (slot.is_full()) {
    std::uint32_t more = in.free_more;
    if (more != 0) {
      in.free_more = static_cast<std::uint32_t>(in.more[more].low);
    } else {
      more = in.more_count++;
      if (more >= in.more_capacity) {
        const std::uint32_t capacity = std::max(2 * in.more_capacity, 16U);
        Slot* const larger = arena_.take<Slot>(capacity);
        if (in.more_capacity > 0) {
          std::memcpy(static_cast<void*>(larger), in.more, in.more_capacity * sizeof(Slot));
          arena_.give_back(in.more, in.more_capacity);
        }
        in.more = larger;
        in.more_capacity = capacity;
      }
    }
    in.more[more] = slot;
    slot = {0, std::uint64_t{more} << kMoreShift};
  }
  slot.push(entry);
}

bool TimeSlices::put(const MovingDisk& disk, std::uint32_t id) {
  Span span{};
  if (!find_span(disk, span)) return false;
  while (slices_.size() <= span.last) add_slice();
  for (std::size_t slice = span.first; slice <= span.last; ++slice) {
    const Slice& in = slices_[slice];
    std::size_t blocks = 0;
    if (in.more_count + blocks_.count() > kMostEntries)
      for_each_block(disk, slice, [&](std::size_t) { ++blocks; });
    if (in.entry_count >= kMostEntries || in.more_count + blocks > kMostEntries) return false;
  }
  for (std::size_t slice = span.first; slice <= span.last; ++slice) {
    Slice& in = slices_[slice];
    std::uint32_t entry = in.free_entry;
    if (entry != 0) {
      in.free_entry = in.entries[entry].disk;
    } else {
      entry = in.entry_count++;
      if (entry == in.entry_capacity) {
        SliceEntry* const larger = arena_.take<SliceEntry>(2 * std::size_t{in.entry_capacity});
        std::memcpy(static_cast<void*>(larger), in.entries, in.entry_capacity * sizeof(SliceEntry));
        arena_.give_back(in.entries, in.entry_capacity);
        in.entries = larger;
        in.entry_capacity *= 2;
      }
    }
    in.entries[entry] = part_of(disk, slice, id);
    for_each_block(disk, slice,
                   [&](std::size_t block) { push(in, in.slots[block], static_cast<EntryId>(entry)); });
  }
  return true;
}

TimeSlices::EntryId TimeSlices::take_out(Slice& in, Slot& head, std::uint32_t id) {
  // The newest of the first slot takes the place of the one that goes.
  const auto newest = static_cast<EntryId>(head.low & UINT16_MAX);
  for (Slot* slot = &head;; slot = &in.more[slot->high >> kMoreShift]) {
    for (std::uint64_t* word : {&slot->low, &slot->high}) {
      const int most = word == &slot->low ? kMoreShift : kMoreShift - kIdBits;
      for (int shift = 0; shift <= most; shift += kIdBits) {
        const auto entry = static_cast<EntryId>(*word >> shift & UINT16_MAX);
        if (entry == 0 || in.entries[entry].disk != id) continue;
        *word ^= std::uint64_t{static_cast<EntryId>(entry ^ newest)} << shift;
        head.pop();
        const std::uint64_t more = head.high >> kMoreShift;
        if (head.low == 0 && more != 0) {
          head = in.more[more];
          in.more[more].low = in.free_more;
          in.free_more = static_cast<std::uint32_t>(more);
        }
        return entry;
      }
    }
    PLANNER_ASSERT(slot->high >> kMoreShift != 0);
  }
}

void TimeSlices::remove(const MovingDisk& disk, std::uint32_t id) {
  Span span{};
  find_span(disk, span);
  for (std::size_t slice = span.first; slice <= span.last; ++slice) {
    Slice& in = slices_[slice];
    EntryId entry = 0;
    for_each_block(disk, slice, [&](std::size_t block) { entry = take_out(in, in.slots[block], id); });
    in.entries[entry].disk = in.free_entry;
    in.free_entry = entry;
  }
}

}  // namespace sipplab
