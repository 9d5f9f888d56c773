// Reservations of [YA17], section 4, with exact collision intervals. Differs from
// [YA17]: a query looks at the cells under the mover's centre line only, each disk being
// entered in every cell from which it can be touched.
#include "planner/reservation/reservation_table.hpp"

#include <algorithm>
#include <cmath>

#include "planner/core/assert.hpp"
#include "planner/geometry/collision_interval.hpp"
#include "planner/geometry/interval_set.hpp"

namespace sipplab {
namespace {

/// Half the side of a cell.
constexpr double kHalfCell = 0.5;

/// Distances along a way, in cells.
struct Span {
  double begin;
  double end;
};

/// Where along a way, position + step * s, the coordinate lies within `half` of
/// `middle`; all of [0, length] where the coordinate does not change.
Span slab(double position, double step, double middle, double half, double length) {
  if (step == 0) return std::abs(position - middle) < half ? Span{0, length} : Span{length, 0};
  const double near = (middle - position - half) / step;
  const double far = (middle - position + half) / step;
  return {std::max(0.0, std::min(near, far)), std::min(length, std::max(near, far))};
}

}  // namespace

ReservationTable::ReservationTable(const GridMap& map, double max_radius_cells)
    : map_(map), max_radius_(max_radius_cells), timelines_(map.cell_count()) {}

void ReservationTable::clear() {
  for (const std::size_t cell : used_cells_) {
    Timeline& timeline = timelines_[cell];
    timeline.passing.clear();
    timeline.resting.clear();
    timeline.longest_s = 0;
  }
  used_cells_.clear();
  // Intervals of cells that no disk came near lie in the arena as well.
  for (Timeline& timeline : timelines_) timeline.intervals_radius = -1;
  intervals_.clear();
  disks_.clear();
}

template <class Visitor>
void ReservationTable::for_each_cell_near(const MovingDisk& disk, Visitor&& visit) const {
  const double half = kHalfCell + disk.radius + max_radius_;
  const Vec2 from = disk.way.from;
  const Vec2 step = disk.way.direction;
  const double length = disk.way.length;
  const auto first_within = [](double low) { return static_cast<std::int32_t>(std::floor(low)) + 1; };
  const auto last_within = [](double high) { return static_cast<std::int32_t>(std::ceil(high)) - 1; };

  const auto [top, bottom] = std::minmax({from.y, disk.way.to.y});
  const std::int32_t first_row = std::max(first_within(top - half), 0);
  const std::int32_t last_row = std::min(last_within(bottom + half), map_.height() - 1);
  for (std::int32_t y = first_row; y <= last_row; ++y) {
    const Span row = slab(from.y, step.y, y, half, length);
    if (row.begin > row.end) continue;
    const auto [left, right] = std::minmax({from.x + step.x * row.begin, from.x + step.x * row.end});
    const std::int32_t first_column = std::max(first_within(left - half), 0);
    const std::int32_t last_column = std::min(last_within(right + half), map_.width() - 1);
    for (std::int32_t x = first_column; x <= last_column; ++x) {
      const Cell cell{x, y};
      if (map_.is_blocked(cell)) continue;  // no robot's centre comes here
      const Span column = slab(from.x, step.x, x, half, length);
      const Span near{std::max(row.begin, column.begin), std::min(row.end, column.end)};
      if (near.begin <= near.end) visit(map_.index(cell), near);
    }
  }
}

ReservationTable::DiskId ReservationTable::add(const MovingDisk& disk) {
  const auto id = static_cast<DiskId>(disks_.size());
  disks_.push_back(disk);
  for_each_cell_near(disk, [&](std::size_t cell, Span near) {
    Timeline& timeline = timelines_[cell];
    if (timeline.passing.empty() && timeline.resting.empty()) used_cells_.push_back(cell);
    timeline.intervals_radius = -1;
    if (disk.end_s == kForever) {
      timeline.resting.push_back({disk.begin_s, kForever, id});
      return;
    }
    Presence presence{disk.begin_s, disk.end_s, id};
    if (!disk.at_rest()) {
      presence.enter_s = disk.begin_s + near.begin / disk.speed;
      if (near.end < disk.way.length) presence.exit_s = disk.begin_s + near.end / disk.speed;
    }
    timeline.longest_s = std::max(timeline.longest_s, presence.exit_s - presence.enter_s);
    const auto place =
        std::upper_bound(timeline.passing.begin(), timeline.passing.end(), presence.enter_s,
                         [](double enter_s, const Presence& other) { return enter_s < other.enter_s; });
    timeline.passing.insert(place, presence);
  });
  return id;
}

void ReservationTable::remove(DiskId id) {
  const MovingDisk& disk = disks_[id];
  PLANNER_ASSERT(disk.at_rest());
  for_each_cell_near(disk, [&](std::size_t cell, Span) {
    Timeline& timeline = timelines_[cell];
    timeline.intervals_radius = -1;
    std::vector<Presence>& presences = disk.end_s == kForever ? timeline.resting : timeline.passing;
    const auto place = std::find_if(presences.begin(), presences.end(),
                                    [id](const Presence& presence) { return presence.disk == id; });
    PLANNER_ASSERT(place != presences.end());
    presences.erase(place);
  });
  disks_[id].end_s = disks_[id].begin_s;  // a disk that is nowhere at any time
}

void ReservationTable::add(const Trajectory& trajectory, double radius_cells) {
  for (const TimedMotion& motion : trajectory.motions) {
    const Displacement way(centre(motion.from), centre(motion.to));
    add(MovingDisk::moving(way, motion.begin_s, motion.end_s, radius_cells));
  }
  add(MovingDisk::resting(centre(trajectory.end()), trajectory.arrival_s(), kForever, radius_cells));
}

std::span<const SafeInterval> ReservationTable::safe_intervals(Cell cell, double radius_cells) {
  Timeline& timeline = timelines_[map_.index(cell)];
  if (timeline.intervals_radius != radius_cells) {
    collisions_.clear();
    for (const std::vector<Presence>* presences : {&timeline.passing, &timeline.resting}) {
      for (const Presence& presence : *presences) {
        const MovingDisk& disk = disks_[presence.disk];
        const OpenInterval collision = collision_interval(centre(cell), disk, radius_cells + disk.radius);
        if (!collision.empty()) collisions_.push_back(collision);
      }
    }
    timeline.intervals_begin = static_cast<std::uint32_t>(intervals_.size());
    append_complement(collisions_, intervals_);
    timeline.intervals_end = static_cast<std::uint32_t>(intervals_.size());
    timeline.intervals_radius = radius_cells;
  }
  return std::span<const SafeInterval>(intervals_)
      .subspan(timeline.intervals_begin, timeline.intervals_end - timeline.intervals_begin);
}

void ReservationTable::list_visits(const Move& move) {
  visits_.clear();
  const Vec2 step = move.way.direction;
  Cell cell{static_cast<std::int32_t>(move.way.from.x), static_cast<std::int32_t>(move.way.from.y)};
  const Cell last{static_cast<std::int32_t>(move.way.to.x), static_cast<std::int32_t>(move.way.to.y)};
  const std::int32_t step_x = step.x > 0 ? 1 : -1;
  const std::int32_t step_y = step.y > 0 ? 1 : -1;
  // Seconds from one column (row) of cells to the next, and to the next crossing.
  const double column_s = step.x != 0 ? 1 / (std::abs(step.x) * move.speed) : kForever;
  const double row_s = step.y != 0 ? 1 / (std::abs(step.y) * move.speed) : kForever;
  double next_column_s = column_s * kHalfCell;
  double next_row_s = row_s * kHalfCell;
  double enter_s = 0;
  const std::int32_t columns = std::abs(last.x - cell.x);
  const std::int32_t rows = std::abs(last.y - cell.y);
  std::int32_t columns_done = 0;
  std::int32_t rows_done = 0;
  while (columns_done < columns || rows_done < rows) {
    const double leave_s = std::min(next_column_s, next_row_s);
    visits_.push_back({map_.index(cell), enter_s, leave_s});
    // Where the way crosses a corner, within rounding, the cells beside it would be
    // visited for no time at all; one of them is then listed with a span of length ~0.
    if (rows_done == rows || (columns_done < columns && next_column_s <= next_row_s)) {
      cell.x += step_x;
      ++columns_done;
      next_column_s = column_s * (kHalfCell + columns_done);
    } else {
      cell.y += step_y;
      ++rows_done;
      next_row_s = row_s * (kHalfCell + rows_done);
    }
    enter_s = leave_s;
  }
  visits_.push_back({map_.index(cell), enter_s, move.duration});
}

double ReservationTable::end_of_overlap(const Move& move, const MovingDisk& disk, double radius_cells,
                                        double departure_s) const {
  const double reach = radius_cells + disk.radius;
  if (!departure_overlaps(move, departure_s, disk, reach)) return departure_s;
  const OpenInterval unsafe = unsafe_departures(move, disk, reach);
  return unsafe.contains(departure_s) ? unsafe.end_s : departure_s;
}

double ReservationTable::next_departure(const Move& move, const Visit& visit, double radius_cells,
                                        double departure_s) {
  const Timeline& timeline = timelines_[visit.cell];
  const double enter_s = departure_s + visit.enter_s;
  const double leave_s = departure_s + visit.leave_s;
  auto presence =
      std::lower_bound(timeline.passing.begin(), timeline.passing.end(), enter_s - timeline.longest_s,
                       [](const Presence& other, double time_s) { return other.enter_s < time_s; });
  for (; presence != timeline.passing.end() && presence->enter_s < leave_s; ++presence) {
    if (presence->exit_s <= enter_s) continue;
    ++disks_examined_;
    const double later_s = end_of_overlap(move, disks_[presence->disk], radius_cells, departure_s);
    if (later_s > departure_s) return later_s;
  }
  for (const Presence& rest : timeline.resting) {
    if (rest.enter_s >= leave_s) continue;
    ++disks_examined_;
    const double later_s = end_of_overlap(move, disks_[rest.disk], radius_cells, departure_s);
    if (later_s > departure_s) return later_s;
  }
  return departure_s;
}

double ReservationTable::earliest_departure(const Move& move, double radius_cells, double from_s,
                                            double until_s) {
  list_visits(move);
  double departure_s = from_s;
  // Every visit must be seen clear at the same departure: go round until that many in
  // a row were. Each jump ends where an unsafe interval ends, so none is jumped over.
  std::size_t clear_in_a_row = 0;
  for (std::size_t at = 0; clear_in_a_row < visits_.size();) {
    const double later_s = next_departure(move, visits_[at], radius_cells, departure_s);
    if (later_s > departure_s) {
      departure_s = later_s;
      if (departure_s > until_s) return departure_s;
      clear_in_a_row = 0;
      continue;
    }
    ++clear_in_a_row;
    at = at + 1 == visits_.size() ? 0 : at + 1;
  }
  return departure_s;
}

double ReservationTable::earliest_departure_plain(const Move& move, double radius_cells, double from_s,
                                                  double until_s) const {
  double departure_s = from_s;
  bool moved = true;
  while (moved && departure_s <= until_s) {
    moved = false;
    for (const MovingDisk& disk : disks_) {
      const double later_s = end_of_overlap(move, disk, radius_cells, departure_s);
      moved = moved || later_s > departure_s;
      departure_s = later_s;
    }
  }
  return departure_s;
}

}  // namespace sipplab
