#include "planner/reservation/safe_times.hpp"

#include <algorithm>
#include <bit>
#include <cmath>

#include "planner/core/tolerances.hpp"
#include "planner/geometry/collision_interval.hpp"
#include "sipplab/error.hpp"

namespace sipplab {

SafeTimes::SafeTimes(const GridMap& map, double max_radius_cells, double time_margin_s, Arena& arena)
    : map_(map),
      max_radius_(max_radius_cells),
      time_margin_s_(time_margin_s),
      arena_(arena),
      heads_(arena),
      near_(arena) {
  clear();
}

void SafeTimes::clear() {
  heads_.abandon();
  near_.abandon();
  heads_.assign(map_.cell_count(), 0);
  near_.push_back({0, 0});
  free_near_ = 0;
  used_ = 0;
}

template <class Visit>
void SafeTimes::for_each_cell_near(const MovingDisk& disk, Visit&& visit) const {
  const double reach = disk.radius + max_radius_ - kTouchDepthCells / 2;  // not those that it only touches
  const Vec2 a = disk.from;
  const Vec2 b = disk.path.to;
  // Without std::ceil and std::floor, which are function calls on old processors.
  const auto first_from = [](double low) {
    const auto whole = static_cast<std::int32_t>(std::max(low, 0.0));
    return whole + (low > whole ? 1 : 0);
  };
  const auto last_to = [](double high, std::int32_t most) {
    return high < 0 ? -1 : static_cast<std::int32_t>(std::min(high, static_cast<double>(most)));
  };
  const auto [left, right] = std::minmax(a.x, b.x);
  const auto [top, bottom] = std::minmax(a.y, b.y);
  // On a slanted move only a stretch of a row is within reach.
  const Vec2 direction = disk.path.direction;
  const bool slanted = direction.y != 0;
  const double x_per_row = slanted ? direction.x / direction.y : 0;
  const double half = slanted ? std::abs(reach / direction.y) : 0;
  const std::int32_t last_row = last_to(bottom + reach, map_.height() - 1);
  for (std::int32_t y = first_from(top - reach); y <= last_row; ++y) {
    double low = left - reach;
    double high = right + reach;
    if (slanted) {
      const double middle = a.x + x_per_row * (y - a.y);
      low = std::max(low, middle - half);
      high = std::min(high, middle + half);
    }
    const std::int32_t last = last_to(high, map_.width() - 1);
    for (std::int32_t x = first_from(low); x <= last; ++x) {
      const Cell cell{x, y};
      if (!map_.is_blocked(cell)) visit(map_.index(cell));  // else no robot's centre comes here
    }
  }
}

OpenInterval SafeTimes::unsafe_at(std::size_t cell, const MovingDisk& disk, double radius) const {
  const OpenInterval unsafe = collision_interval(centre(map_.cell(cell)), disk, radius + disk.radius);
  if (unsafe.empty()) return unsafe;
  return {unsafe.begin_s - time_margin_s_, unsafe.end_s + time_margin_s_};
}

void SafeTimes::add(const MovingDisk& disk, DiskId id) {
  for_each_cell_near(disk, [&](std::size_t cell) {
    std::uint32_t place = free_near_;
    if (place != 0) {
      free_near_ = near_[place].next;
    } else {
      place = static_cast<std::uint32_t>(near_.size());
      near_.push_back({});
    }
    near_[place] = {id, heads_[cell]};
    heads_[cell] = place;
  });
}

void SafeTimes::remove(const MovingDisk& disk, DiskId id) {
  for_each_cell_near(disk, [&](std::size_t cell) {
    for (std::uint32_t* link = &heads_[cell]; *link != 0; link = &near_[*link].next) {
      const std::uint32_t place = *link;
      if (near_[place].disk != id) continue;
      *link = near_[place].next;
      near_[place].next = free_near_;
      free_near_ = place;
      for (std::size_t i = 0; i < used_; ++i) by_radius_[i].sets[cell].seen = kRemoved;
      return;
    }
  });
}

SafeTimes::OfRadius& SafeTimes::of_radius(double radius) {
  for (std::size_t i = 0; i < used_; ++i) {
    if (by_radius_[i].radius == radius) return by_radius_[i];
  }
  const bool is_full = used_ == kMostRadii;
  OfRadius& chosen = by_radius_[is_full ? replaced_++ % kMostRadii : used_++];
  if (!is_full) {
    chosen.sets = arena_.take<Set>(map_.cell_count());
    std::fill_n(chosen.sets, map_.cell_count(), Set{nullptr, 0, 0, 0});
  }
  chosen.radius = radius;
  if (is_full) {
    for (std::size_t cell = 0; cell < map_.cell_count(); ++cell) chosen.sets[cell].seen = kRemoved;
  }
  return chosen;
}

std::span<const SafeInterval> SafeTimes::found_out(std::size_t cell, double radius,
                                                   const ArenaVector<MovingDisk>& disks) {
  Set& set = of_radius(radius).sets[cell];
  std::uint32_t seen = set.seen;
  if (seen == kRemoved) {
    seen = 0;
    if (set.capacity > 0) {
      set.size = 1;
      set.intervals[0] = kAllTime;
    }
  }
  for (std::uint32_t place = heads_[cell]; place != seen; place = near_[place].next) {
    const OpenInterval unsafe = unsafe_at(cell, disks[near_[place].disk], radius);
    if (!unsafe.empty()) cut(set, unsafe);
  }
  set.seen = heads_[cell];
  return intervals_of(set);
}

void SafeTimes::reserve(Set& set, std::uint32_t capacity) {
  if (set.capacity >= capacity) return;
  capacity = std::bit_ceil(std::max(capacity, kFirstRoom));
  Interval* const intervals = arena_.take<Interval>(capacity);
  intervals[0] = kAllTime;
  if (set.capacity == 0) {
    set.size = 1;
  } else {
    std::copy_n(set.intervals, set.size, intervals);
    arena_.give_back(set.intervals, set.capacity);
  }
  set.intervals = intervals;
  set.capacity = capacity;
}

void SafeTimes::cut(Set& set, OpenInterval unsafe) {
  reserve(set, set.size + 1);
  Interval* const intervals = set.intervals;
  // From the end: robots are planned forward in time, so the last interval is often cut.
  Interval* last = intervals + set.size;  // one past those that begin before the end of the cut
  while (last > intervals && (last - 1)->begin_s >= unsafe.end_s) --last;
  Interval* first = last;
  while (first > intervals && (first - 1)->end_s > unsafe.begin_s) --first;
  if (first == last) return;
  std::array<Interval, 2> left;
  std::ptrdiff_t pieces = 0;
  if (first->begin_s <= unsafe.begin_s)
    left[static_cast<std::size_t>(pieces++)] = {first->begin_s, unsafe.begin_s};
  if ((last - 1)->end_s >= unsafe.end_s && unsafe.end_s < kForever) {
    left[static_cast<std::size_t>(pieces++)] = {unsafe.end_s, (last - 1)->end_s};
  }
  Interval* const end = intervals + set.size;
  if (pieces > last - first) {
    std::copy_backward(last, end, end + 1);
  } else {
    std::copy(last, end, first + pieces);
  }
  std::copy_n(left.begin(), pieces, first);
  set.size = static_cast<std::uint32_t>(end - intervals + pieces - (last - first));
}

}  // namespace sipplab
