#include "planner/reservation/time_slices.hpp"

#include <cstring>

#include "sipplab/error.hpp"

namespace sipplab {
namespace {

/// Entries for which a slice has room at first, and slots for overflow.
constexpr std::uint32_t kFirstRoom = 16;

/// Copies the first plain values of a row, with room for more.
template <class T>
T* copy(const T* row, std::size_t count, std::size_t capacity, Arena& arena) {
  if (capacity == 0) return nullptr;
  T* const copied = arena.take<T>(capacity);
  if (row != nullptr) std::memcpy(static_cast<void*>(copied), row, count * sizeof(T));
  return copied;
}

/// Doubles a row of `count` plain values once it is full.
template <class T>
void make_room(T*& row, std::uint32_t count, std::uint32_t& capacity, Arena& arena) {
  if (count < capacity) return;
  const std::uint32_t larger = std::max(2 * capacity, kFirstRoom);
  T* const moved = copy(row, capacity, larger, arena);
  if (capacity > 0) arena.give_back(row, capacity);
  row = moved;
  capacity = larger;
}

/// Where in a word of four ids this one is: 0, 16, 32 or 48, the lowest; 64 if nowhere.
int shift_of(std::uint16_t id, std::uint64_t ids) {
  constexpr std::uint64_t kOnes = 0x0001'0001'0001'0001;
  const std::uint64_t differences = ids ^ kOnes * id;
  // Its lowest bit is in the lowest lane that is zero (Mycroft 1987); those above it may be wrong.
  const std::uint64_t zeros = (differences - kOnes) & ~differences & kOnes << 15;
  return std::countr_zero(zeros) & ~15;
}

}  // namespace

Blocks::Blocks(const GridMap& map, double room, std::size_t most) : room_(room) {
  for (;; ++shift_) {
    columns_ = ((map.width() - 1) >> shift_) + 1;
    rows_ = ((map.height() - 1) >> shift_) + 1;
    if (count() <= most) return;
  }
}

Slice::Slice(const Blocks& blocks, Arena& arena)
    : slots_(arena.take<Slot>(blocks.count())),
      entries_(arena.take<SliceEntry>(kFirstRoom)),
      entry_capacity_(kFirstRoom) {
  std::memset(static_cast<void*>(slots_), 0, blocks.count() * sizeof(Slot));
  entries_[0] = {0, 0, 0, 0, 0, 0, 1, -1};
}

Slice::Slice(const Slice& before, const Blocks& blocks, Arena& arena) : Slice(before) {
  slots_ = copy(slots_, blocks.count(), blocks.count(), arena);
  entries_ = copy(entries_, entry_count_, entry_capacity_, arena);
  more_ = copy(more_, more_count_, more_capacity_, arena);
}

bool Slice::fits(const Sweep& sweep, const Blocks& blocks) const {
  std::size_t more = more_count_;
  blocks.for_each_near(sweep, [&](std::size_t) { ++more; });
  return entry_count_ < kMostEntries && more <= kMostEntries;
}

void Slice::put(const SliceEntry& entry, const Sweep& sweep, const Blocks& blocks, Arena& arena) {
  std::uint32_t id = free_entry_;
  if (id != 0) {
    free_entry_ = entries_[id].disk;
  } else {
    id = entry_count_++;
    make_room(entries_, id, entry_capacity_, arena);
  }
  entries_[id] = entry;
  blocks.for_each_near(sweep,
                       [&](std::size_t block) { push(slots_[block], static_cast<EntryId>(id), arena); });
}

void Slice::overflow(Slot& slot, Arena& arena) {
  std::uint32_t more = free_more_;
  if (more != 0) {
    free_more_ = static_cast<std::uint32_t>(more_[more].low);
  } else {
    more = more_count_++;
    make_room(more_, more, more_capacity_, arena);
  }
  more_[more] = slot;
  slot = {0, std::uint64_t{more} << kMoreShift};
}

void Slice::remove(std::uint32_t disk, const Sweep& sweep, const Blocks& blocks) {
  EntryId entry = 0;
  blocks.for_each_near(sweep, [&](std::size_t block) {
    if (entry == 0) entry = entry_of(slots_[block], disk);
    take_out(slots_[block], entry);
  });
  entries_[entry].disk = free_entry_;
  free_entry_ = entry;
}

Slice::EntryId Slice::entry_of(const Slot& head, std::uint32_t disk) const {
  for (const Slot* slot = &head;; slot = &more_[slot->high >> kMoreShift]) {
    for (std::uint64_t ids : {slot->low, slot->high & kIdsOfHigh}) {
      for (; ids != 0; ids >>= kIdBits) {
        const auto entry = static_cast<EntryId>(ids & UINT16_MAX);
        if (entries_[entry].disk == disk) return entry;
      }
    }
    PLANNER_ASSERT(slot->high >> kMoreShift != 0);
  }
}

void Slice::take_out(Slot& head, EntryId entry) {
  // The newest of the first slot replaces the one that is removed.
  const std::uint64_t change = entry ^ (head.low & UINT16_MAX);
  for (Slot* slot = &head;; slot = &more_[slot->high >> kMoreShift]) {
    if (const int shift = shift_of(entry, slot->low); shift <= kMoreShift) {
      slot->low ^= change << shift;
      break;
    }
    if (const int shift = shift_of(entry, slot->high); shift < kMoreShift) {
      slot->high ^= change << shift;
      break;
    }
    PLANNER_ASSERT(slot->high >> kMoreShift != 0);
  }
  head.pop();
  const std::uint64_t more = head.high >> kMoreShift;
  if (head.low == 0 && more != 0) {
    head = more_[more];
    more_[more].low = free_more_;
    free_more_ = static_cast<std::uint32_t>(more);
  }
}

void TimeSlices::clear() {
  slices_.abandon();
  others_.abandon();
  other_.clear();
  slices_.push_back(Slice(blocks_, arena_));
}

TimeSlices::Span TimeSlices::span_of(const MovingDisk& disk) const {
  const double first = (disk.begin_s - time_margin_s_) * per_second_ - kMargin;
  const double last = (disk.end_s + time_margin_s_) * per_second_ + kMargin;
  const bool for_ever = disk.end_s == kForever;
  if (!((for_ever ? first : last) < kMostSlices) ||
      (!for_ever && last - first > kLongestRest + kMostForCell * disk.path.length)) {
    return {1, 0};
  }
  const auto begin = static_cast<std::size_t>(std::max(first, 0.0));
  if (for_ever) return {begin, std::max(begin + 1, slices_.size() - 1)};
  return {begin, static_cast<std::size_t>(std::max(last, 0.0))};
}

SliceEntry TimeSlices::part_of(const MovingDisk& disk, std::size_t slice, std::uint32_t id) const {
  const double begin_s = static_cast<double>(slice) * slice_s_;
  const Vec2 place = disk.from + disk.velocity * (begin_s - disk.begin_s);
  const Vec2 velocity = disk.velocity * slice_s_;
  const auto clipped = [](double slices) { return static_cast<float>(std::clamp(slices, -1.0, 2.0)); };
  return {static_cast<float>(place.x),
          static_cast<float>(place.y),
          static_cast<float>(disk.radius + disk.speed * (time_margin_s_ + kLostOfSpeed * slice_s_)),
          id,
          static_cast<float>(velocity.x),
          static_cast<float>(velocity.y),
          clipped((disk.begin_s - time_margin_s_ - begin_s) * per_second_ - kMargin),
          clipped((disk.end_s + time_margin_s_ - begin_s) * per_second_ + kMargin)};
}

Sweep TimeSlices::sweep_of(const MovingDisk& disk, std::size_t slice) const {
  const double begin_s = (static_cast<double>(slice) - kMargin) * slice_s_ - time_margin_s_;
  const double end_s = (static_cast<double>(slice + 1) + kMargin) * slice_s_ + time_margin_s_;
  const auto place_at = [&](double time_s) {
    return disk.from + disk.velocity * (std::clamp(time_s, disk.begin_s, disk.end_s) - disk.begin_s);
  };
  return {place_at(begin_s), place_at(end_s), disk.radius};
}

void TimeSlices::put(const MovingDisk& disk, std::uint32_t id) {
  if (id >= other_.size()) other_.resize(id + 1);
  const Span span = span_of(disk);
  bool fits = span.first <= span.last;
  for (std::size_t slice = span.first; slice <= span.last && fits; ++slice) {
    while (slice + (disk.end_s == kForever ? 0 : 1) >= slices_.size()) {
      slices_.push_back(Slice(slices_.back(), blocks_, arena_));
    }
    fits = slices_[slice].fits_any(blocks_) || slices_[slice].fits(sweep_of(disk, slice), blocks_);
  }
  other_[id] = 0;
  if (fits) {
    for (std::size_t slice = span.first; slice <= span.last; ++slice) {
      slices_[slice].put(part_of(disk, slice, id), sweep_of(disk, slice), blocks_, arena_);
    }
    return;
  }
  const Sweep all{disk.from, disk.path.to, disk.radius};
  const Vec2 middle = (disk.from + disk.path.to) * 0.5;
  const double radius = disk.radius + disk.path.length / 2 + disk.speed * time_margin_s_;
  if (others_.empty() || !others_.back().fits(all, blocks_)) others_.push_back(Slice(blocks_, arena_));
  others_.back().put({static_cast<float>(middle.x), static_cast<float>(middle.y), static_cast<float>(radius),
                      id, 0, 0, -1, 2},
                     all, blocks_, arena_);
  other_[id] = static_cast<std::uint16_t>(others_.size());
}

void TimeSlices::remove(const MovingDisk& disk, std::uint32_t id) {
  if (other_[id] != 0) {
    others_[other_[id] - std::size_t{1}].remove(id, {disk.from, disk.path.to, disk.radius}, blocks_);
    return;
  }
  const Span span = span_of(disk);
  for (std::size_t slice = span.first; slice <= span.last; ++slice) {
    slices_[slice].remove(id, sweep_of(disk, slice), blocks_);
  }
}

}  // namespace sipplab
