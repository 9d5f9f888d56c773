// Reservations of [YA17], section 4, with exact collision intervals. Differs from
// [YA17]: a query looks at the cells under the mover's centre line only, each disk being
// entered in every cell from which it can be touched.
#include "planner/reservation/reservation_table.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "planner/core/assert.hpp"
#include "planner/geometry/collision_interval.hpp"

namespace sipplab {
namespace {

/// End of a disk that was removed: before every beginning.
constexpr double kRemoved = -kForever;

/// Room that a timeline begins with: most have this many entries at the end or more.
constexpr std::size_t kFirstPresences = 8;

/// Bytes for each cell that are set aside at first.
constexpr std::size_t kBytesPerCell = 256;

/// End of a presence that does not end.
constexpr float kNever = std::numeric_limits<float>::infinity();

/// A float below x, or above, by one or two units in its last place. REQUIRES: finite.
float at_most(double x) {
  const auto near = static_cast<float>(x);
  return near - std::abs(near) * std::numeric_limits<float>::epsilon();
}
float at_least(double x) { return -at_most(-x); }

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

ReservationTable::ReservationTable(const GridMap& map, double max_radius_cells, double time_margin_s)
    : map_(map),
      max_radius_(max_radius_cells),
      time_margin_s_(time_margin_s),
      memory_(kBytesPerCell * map.cell_count()),
      visits_(static_cast<std::size_t>(map.width() + map.height())) {
  timelines_.reserve(map.cell_count());
  while (timelines_.size() < map.cell_count()) timelines_.emplace_back(&memory_);
}

void ReservationTable::clear() {
  for (const std::size_t cell : used_cells_) {
    Timeline& timeline = timelines_[cell];
    timeline.passing.clear();
    timeline.resting.clear();
    timeline.safe_radius = -1;
    timeline.used = false;
  }
  used_cells_.clear();
  disks_.clear();
  free_ids_.clear();
  answered_.clear();
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

const ReservationTable::Presence* ReservationTable::Timeline::first_after(float time_s) const {
  const Presence* first = passing.data();
  // Halving without branches: which half is as good as random.
  for (std::size_t left = passing.size(); left > 0;) {
    const std::size_t half = left / 2;
    const bool over = first[half].latest_exit_s <= time_s;
    first = over ? first + half + 1 : first;
    left = over ? left - half - 1 : half;
  }
  return first;
}

void ReservationTable::Timeline::insert(const Presence& presence) {
  if (passing.capacity() == 0) passing.reserve(kFirstPresences);
  auto place = std::upper_bound(passing.begin(), passing.end(), presence.enter_s,
                                [](float enter_s, const Presence& other) { return enter_s < other.enter_s; });
  place = passing.insert(place, presence);
  if (place != passing.begin()) {
    place->latest_exit_s = std::max(presence.exit_s, std::prev(place)->latest_exit_s);
  }
  while (++place != passing.end() && place->latest_exit_s < presence.exit_s) {
    place->latest_exit_s = presence.exit_s;
  }
}

void ReservationTable::Timeline::repair_from(std::pmr::vector<Presence>::iterator place) {
  float latest_exit_s = place == passing.begin() ? -kNever : std::prev(place)->latest_exit_s;
  for (; place != passing.end(); ++place) {
    latest_exit_s = std::max(latest_exit_s, place->exit_s);
    if (place->latest_exit_s == latest_exit_s) return;  // and all those behind it, too
    place->latest_exit_s = latest_exit_s;
  }
}

ReservationTable::DiskId ReservationTable::add(const MovingDisk& disk) {
  auto id = static_cast<DiskId>(disks_.size());
  if (free_ids_.empty()) {
    disks_.push_back(disk);
    answered_.push_back(0);
  } else {
    id = free_ids_.back();
    free_ids_.pop_back();
    disks_[id] = disk;
  }
  for_each_cell_near(disk, [&](std::size_t cell, Span near) {
    Timeline& timeline = timelines_[cell];
    if (!std::exchange(timeline.used, true)) used_cells_.push_back(cell);
    if (timeline.safe_radius >= 0) {
      timeline.safe.remove_open(
          widened(collision_interval(centre(map_.cell(cell)), disk, timeline.safe_radius + disk.radius)));
    }
    if (disk.end_s == kForever) {
      timeline.resting.push_back({at_most(disk.begin_s), kNever, kNever, id});
      return;
    }
    double enter_s = disk.begin_s;
    double exit_s = disk.end_s;
    if (!disk.at_rest()) {
      enter_s = disk.begin_s + near.begin / disk.speed;
      if (near.end < disk.way.length) exit_s = disk.begin_s + near.end / disk.speed;
    }
    const float latest_exit_s = at_least(exit_s);
    timeline.insert({at_most(enter_s), latest_exit_s, latest_exit_s, id});
  });
  return id;
}

void ReservationTable::remove(DiskId id) {
  const MovingDisk& disk = disks_[id];
  for_each_cell_near(disk, [&](std::size_t cell, Span) {
    Timeline& timeline = timelines_[cell];
    timeline.safe_radius = -1;
    std::pmr::vector<Presence>& presences = disk.end_s == kForever ? timeline.resting : timeline.passing;
    const auto place = std::find_if(presences.begin(), presences.end(),
                                    [id](const Presence& presence) { return presence.disk == id; });
    PLANNER_ASSERT(place != presences.end());
    const auto behind = presences.erase(place);
    if (disk.end_s < kForever) timeline.repair_from(behind);
  });
  disks_[id].end_s = kRemoved;
  free_ids_.push_back(id);
}

std::vector<ReservationTable::DiskId> ReservationTable::add(const Trajectory& trajectory,
                                                            double radius_cells) {
  std::vector<DiskId> ids;
  ids.reserve(trajectory.motions.size() + 1);
  for (const TimedMotion& motion : trajectory.motions) {
    const Displacement way(centre(motion.from), centre(motion.to));
    ids.push_back(add(MovingDisk::moving(way, motion.begin_s, motion.end_s, radius_cells)));
  }
  ids.push_back(
      add(MovingDisk::resting(centre(trajectory.end()), trajectory.arrival_s(), kForever, radius_cells)));
  return ids;
}

void ReservationTable::add_keepout(Vec2 place, double radius_cells, Vec2 pardoned) {
  keepouts_.push_back({place, radius_cells, pardoned});
}

bool ReservationTable::is_kept_out(const Displacement& way, double radius_cells) const {
  return std::any_of(keepouts_.begin(), keepouts_.end(), [&](const Keepout& keepout) {
    return intrudes(way, keepout.place, keepout.pardoned, radius_cells + keepout.radius);
  });
}

std::span<const SafeInterval> ReservationTable::safe_intervals(Cell cell, double radius_cells) {
  if (!keepouts_.empty() && is_kept_out(Displacement(centre(cell), centre(cell)), radius_cells)) return {};
  Timeline& timeline = timelines_[map_.index(cell)];
  if (timeline.safe_radius != radius_cells) {
    timeline.safe.reset();
    timeline.safe_radius = radius_cells;
    for (const std::pmr::vector<Presence>* presences : {&timeline.passing, &timeline.resting}) {
      for (const Presence& presence : *presences) {
        const MovingDisk& disk = disks_[presence.disk];
        timeline.safe.remove_open(
            widened(collision_interval(centre(cell), disk, radius_cells + disk.radius)));
      }
    }
  }
  return timeline.safe.intervals();
}

double ReservationTable::end_of_overlap(const Move& move, const MovingDisk& disk, double radius_cells,
                                        double departure_s) const {
  const OpenInterval unsafe = widened(unsafe_departures(move, disk, radius_cells + disk.radius));
  return unsafe.contains(departure_s) ? unsafe.end_s : departure_s;
}

double ReservationTable::next_departure(const Move& move, const CellVisit& visit, double radius_cells,
                                        double departure_s, DiskId& blocker) {
  const Timeline& timeline = timelines_[visit.cell];
  // Unsafe departures may reach a little beyond the time that is spent near a disk.
  const double margin_s = kNearMissCells * move.seconds_per_cell + time_margin_s_;
  const float enter_s = at_most(departure_s + visit.enter_s - margin_s);
  const float leave_s = at_least(departure_s + visit.leave_s + margin_s);
  const Presence* const end = timeline.passing.data() + timeline.passing.size();
  for (const Presence* presence = timeline.first_after(enter_s); presence != end; ++presence) {
    if (presence->enter_s >= leave_s) break;
    if (presence->exit_s <= enter_s || !is_news(presence->disk)) continue;
    const MovingDisk& disk = disks_[presence->disk];
    if (time_margin_s_ == 0 && !may_be_unsafe(move, departure_s, disk, radius_cells + disk.radius)) continue;
    const double later_s = end_of_overlap(move, disk, radius_cells, departure_s);
    if (later_s > departure_s) {
      blocker = presence->disk;
      return later_s;
    }
  }
  for (const Presence& rest : timeline.resting) {
    if (rest.enter_s >= leave_s || !is_news(rest.disk)) continue;
    const MovingDisk& disk = disks_[rest.disk];
    if (passes_by(move.way, disk.from, radius_cells + disk.radius)) continue;
    const double later_s = end_of_overlap(move, disk, radius_cells, departure_s);
    if (later_s > departure_s) {
      blocker = rest.disk;
      return later_s;
    }
  }
  return departure_s;
}

double ReservationTable::earliest_departure(const Move& move, double radius_cells, double from_s,
                                            double until_s, DiskId* likely_blocker) {
  if (!keepouts_.empty() && is_kept_out(move.way, radius_cells)) return kForever;
  double departure_s = from_s;
  DiskId blocker = likely_blocker ? *likely_blocker : kNoDisk;
  if (blocker != kNoDisk) {
    departure_s = end_of_overlap(move, disks_[blocker], radius_cells, departure_s);
    if (departure_s > until_s || departure_s == kForever) return departure_s;
  }
  // Every visit must be seen clear at the same departure: go round until all were, in a
  // row. Each jump ends where an unsafe interval ends, so no safe departure is missed.
  CellWalk walk(map_, move);
  std::size_t known = 0;  // visits_ that were made for this way
  std::size_t at = 0;
  std::size_t clear_in_a_row = 0;
  ++question_;
  while (!walk.done() || clear_in_a_row < known) {
    if (at == known) {
      if (walk.done()) {
        at = 0;
      } else {
        visits_[known++] = walk.next();
      }
    }
    const bool deserted = timelines_[visits_[at].cell].is_empty();
    const double later_s =
        deserted ? departure_s : next_departure(move, visits_[at], radius_cells, departure_s, blocker);
    if (later_s > departure_s) {
      departure_s = later_s;
      if (departure_s > until_s || departure_s == kForever) break;
      clear_in_a_row = 0;
      // Another departure, another question, except for the disk that was just answered.
      ++question_;
      answered_[blocker] = question_;
    } else {
      ++clear_in_a_row;
      ++at;
    }
  }
  if (likely_blocker) *likely_blocker = blocker;
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
