// Reservations of [YA17], section 4, with exact collision intervals. Differs from
// [YA17]: a query looks at the cells under the mover's centre line only, each disk being
// entered in every cell from which it can be touched.
#include "planner/reservation/reservation_table.hpp"

#include <algorithm>
#include <cmath>

#include "planner/core/assert.hpp"
#include "planner/geometry/collision_interval.hpp"

namespace sipplab {
namespace {

/// End of a disk that was removed: before every beginning.
constexpr double kRemoved = -kForever;

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
    timeline.safe_radius = -1;
  }
  used_cells_.clear();
  disks_.clear();
  keepouts_.clear();
}

template <class Visitor>
void ReservationTable::for_each_cell_near(const MovingDisk& disk, Visitor&& visit) const {
  const double half = kHalfCell + disk.radius + max_radius_;
  const Vec2 from = disk.from;
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
    if (timeline.safe_radius >= 0) {
      timeline.safe.remove_open(
          collision_interval(centre(map_.cell(cell)), disk, timeline.safe_radius + disk.radius));
    }
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
    timeline.safe_radius = -1;
    std::vector<Presence>& presences = disk.end_s == kForever ? timeline.resting : timeline.passing;
    const auto place = std::find_if(presences.begin(), presences.end(),
                                    [id](const Presence& presence) { return presence.disk == id; });
    PLANNER_ASSERT(place != presences.end());
    presences.erase(place);
  });
  disks_[id].end_s = kRemoved;
}

void ReservationTable::add(const Trajectory& trajectory, double radius_cells) {
  for (const TimedMotion& motion : trajectory.motions) {
    const Displacement way(centre(motion.from), centre(motion.to));
    add(MovingDisk::moving(way, motion.begin_s, motion.end_s, radius_cells));
  }
  add(MovingDisk::resting(centre(trajectory.end()), trajectory.arrival_s(), kForever, radius_cells));
}

void ReservationTable::add_keepout(Vec2 place, double radius_cells, Vec2 pardoned) {
  keepouts_.push_back({place, radius_cells, pardoned});
}

bool ReservationTable::is_kept_out(const Displacement& way, double radius_cells) const {
  return std::any_of(keepouts_.begin(), keepouts_.end(), [&](const Keepout& keepout) {
    return intrudes(way, keepout.place, keepout.pardoned, radius_cells + keepout.radius);
  });
}

const std::vector<SafeInterval>& ReservationTable::safe_intervals(Cell cell, double radius_cells) {
  static const std::vector<SafeInterval> kNever;
  if (is_kept_out(Displacement(centre(cell), centre(cell)), radius_cells)) return kNever;
  Timeline& timeline = timelines_[map_.index(cell)];
  if (timeline.safe_radius != radius_cells) {
    timeline.safe.reset();
    timeline.safe_radius = radius_cells;
    for (const std::vector<Presence>* presences : {&timeline.passing, &timeline.resting}) {
      for (const Presence& presence : *presences) {
        const MovingDisk& disk = disks_[presence.disk];
        timeline.safe.remove_open(collision_interval(centre(cell), disk, radius_cells + disk.radius));
      }
    }
  }
  return timeline.safe.intervals();
}

double ReservationTable::end_of_overlap(const Move& move, const MovingDisk& disk, double radius_cells,
                                        double departure_s) {
  const OpenInterval unsafe = unsafe_departures(move, disk, radius_cells + disk.radius);
  return unsafe.contains(departure_s) ? unsafe.end_s : departure_s;
}

double ReservationTable::next_departure(const Move& move, const CellVisit& visit, double radius_cells,
                                        double departure_s) {
  const Timeline& timeline = timelines_[visit.cell];
  // Unsafe departures may reach a little beyond the time that is spent near a disk.
  const double margin_s = kNearMissCells / move.speed;
  const double enter_s = departure_s + visit.enter_s - margin_s;
  const double leave_s = departure_s + visit.leave_s + margin_s;
  auto presence =
      std::lower_bound(timeline.passing.begin(), timeline.passing.end(), enter_s - timeline.longest_s,
                       [](const Presence& other, double time_s) { return other.enter_s < time_s; });
  for (; presence != timeline.passing.end() && presence->enter_s < leave_s; ++presence) {
    if (presence->exit_s <= enter_s) continue;
    const MovingDisk& disk = disks_[presence->disk];
    ++disks_examined_;
    if (!may_be_unsafe(move, departure_s, disk, radius_cells + disk.radius)) continue;
    const double later_s = end_of_overlap(move, disk, radius_cells, departure_s);
    if (later_s > departure_s) return later_s;
  }
  for (const Presence& rest : timeline.resting) {
    if (rest.enter_s >= leave_s) continue;
    const MovingDisk& disk = disks_[rest.disk];
    ++disks_examined_;
    if (!may_be_unsafe(move, departure_s, disk, radius_cells + disk.radius)) continue;
    const double later_s = end_of_overlap(move, disk, radius_cells, departure_s);
    if (later_s > departure_s) return later_s;
  }
  return departure_s;
}

double ReservationTable::earliest_departure(const Move& move, double radius_cells, double from_s,
                                            double until_s) {
  if (is_kept_out(move.way, radius_cells)) return kForever;
  double departure_s = from_s;
  // Every visit must be seen clear at the same departure: go round until all were, in a
  // row. Each jump ends where an unsafe interval ends, so no safe departure is missed.
  CellWalk walk(map_, move);
  visits_.clear();
  std::size_t at = 0;
  std::size_t clear_in_a_row = 0;
  while (!walk.done() || clear_in_a_row < visits_.size()) {
    if (at == visits_.size()) {
      if (walk.done()) {
        at = 0;
      } else {
        visits_.push_back(walk.next());
      }
    }
    const double later_s = next_departure(move, visits_[at], radius_cells, departure_s);
    if (later_s > departure_s) {
      departure_s = later_s;
      if (departure_s > until_s || departure_s == kForever) return departure_s;
      clear_in_a_row = 0;
    } else {
      ++clear_in_a_row;
      ++at;
    }
  }
  return departure_s;
}

double ReservationTable::earliest_departure_plain(const Move& move, double radius_cells, double from_s,
                                                  double until_s) const {
  if (is_kept_out(move.way, radius_cells)) return kForever;
  double departure_s = from_s;
  bool moved = true;
  while (moved && departure_s <= until_s && departure_s < kForever) {
    moved = false;
    for (const MovingDisk& disk : disks_) {
      if (disk.end_s == kRemoved) continue;
      const double later_s = end_of_overlap(move, disk, radius_cells, departure_s);
      moved = moved || later_s > departure_s;
      departure_s = later_s;
    }
  }
  return departure_s;
}

}  // namespace sipplab
