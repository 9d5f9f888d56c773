// Reservations of [YA17], section 4, with exact collision intervals.
// Differs from [YA17]: a query looks once for each slice of time, where the mover is then. Each disk is
// entered wherever it can be touched from.
#include "planner/reservation/reservation_table.hpp"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <limits>
#include <tuple>
#include <utility>

#include "planner/geometry/collision_interval.hpp"
#include "sipplab/error.hpp"

namespace sipplab {
namespace {

/// Cells. How far a robot of usual speed gets in a slice, and any robot between two look-ups.
/// (Instructions of a plan with 1, 2 and 3 cells, one instance each: empty 64 100 / 89 / 87 %, empty 192
/// 100 / 95 / 98 %, warehouse 64 100 / 95 / 95 %.)
constexpr double kSliceCells = 2;
constexpr double kHalfStepCells = kSliceCells / 2;
/// Slices suit robots that are at most this many times as slow as the fastest one, which would otherwise be
/// in too many places in a slice. (Suite mixed, 16 robots of speeds 0.5 to 2: 1.05 and 1.07 times as fast
/// with slices that suit speeds 1 and 0.5, the same plans.)
constexpr double kSpeedRange = 4;

/// Cells, and cells for each cell of the map's longer side. The error of distances in floats.
constexpr double kFilterMargin = 1e-4;
constexpr double kFilterMarginPerCell = 5e-7;

/// Slots of one slice: 256 KiB of them. Maps of more than 256 x 256 cells have larger blocks.
constexpr std::size_t kMostBlocks = std::size_t{1} << 14;

double filter_margin(const GridMap& map) {
  return kFilterMargin + kFilterMarginPerCell * std::max(map.width(), map.height());
}

}  // namespace

Askers askers_of(const Instance& instance, const MotionRules& rules) {
  Askers askers{largest_radius_cells(instance) + rules.inflate_distance_cells, 1, rules.inflate_time_s};
  if (instance.agents.empty()) return askers;
  std::vector<double> speeds;
  for (const Agent& agent : instance.agents) speeds.push_back(agent.speed_cells_per_s);
  const auto middle = speeds.begin() + static_cast<std::ptrdiff_t>(speeds.size() / 2);
  std::nth_element(speeds.begin(), middle, speeds.end());
  const double fastest = *std::max_element(middle, speeds.end());
  askers.speed_cells_per_s = std::max(*middle, fastest / kSpeedRange);
  return askers;
}

ReservationTable::ReservationTable(const GridMap& map, const Askers& askers)
    : map_(map),
      askers_(askers),
      blocks_(map, askers.max_radius_cells + kHalfStepCells + filter_margin(map), kMostBlocks),
      filter_margin_(filter_margin(map)),
      slices_(blocks_, kSliceCells / askers.speed_cells_per_s, askers.time_margin_s, arena_),
      safe_times_(map, askers.max_radius_cells, askers.time_margin_s, arena_),
      disks_(arena_) {
  clear();
}

void ReservationTable::clear() {
  arena_.reset();
  slices_.clear();
  safe_times_.clear();
  disks_.abandon();
  free_ids_.clear();
  keepouts_.clear();
}

ReservationTable::DiskId ReservationTable::add(const MovingDisk& disk) {
  auto id = static_cast<DiskId>(disks_.size());
  if (free_ids_.empty()) {
    disks_.push_back(disk);
  } else {
    id = free_ids_.back();
    free_ids_.pop_back();
    disks_[id] = disk;
  }
  slices_.put(disk, id);
  safe_times_.add(disk, id);
  return id;
}

void ReservationTable::remove(DiskId id) {
  slices_.remove(disks_[id], id);
  safe_times_.remove(disks_[id], id);
  free_ids_.push_back(id);
}

std::vector<ReservationTable::DiskId> ReservationTable::add(const Trajectory& trajectory,
                                                            double radius_cells) {
  std::vector<DiskId> ids;
  ids.reserve(trajectory.motions.size() + 1);
  for (const TimedMotion& motion : trajectory.motions) {
    const Displacement path(centre(motion.from), centre(motion.to));
    ids.push_back(add(MovingDisk::moving(path, motion.begin_s, motion.end_s, radius_cells)));
  }
  ids.push_back(
      add(MovingDisk::resting(centre(trajectory.end()), trajectory.end_s(), kForever, radius_cells)));
  return ids;
}

void ReservationTable::add_keepout(Vec2 place, double radius_cells, Vec2 pardoned) {
  keepouts_.push_back({place, radius_cells, pardoned});
}

double ReservationTable::earliest_departure(Cell from, Cell to, double speed_cells_per_s, double radius_cells,
                                            double from_s, double until_s) const {
  const Move move(Displacement(centre(from), centre(to)), speed_cells_per_s);
  return earliest_departure(move, radius_cells, from_s, until_s);
}

bool ReservationTable::is_kept_out(const Displacement& path, double radius_cells) const {
  return std::any_of(keepouts_.begin(), keepouts_.end(), [&](const Keepout& keepout) {
    return intrudes(path, keepout.place, keepout.pardoned, radius_cells + keepout.radius);
  });
}

double ReservationTable::end_of_overlap(const Move& move, const MovingDisk& disk, double radius_cells,
                                        double departure_s) const {
  OpenInterval unsafe = unsafe_departures(move, disk, radius_cells + disk.radius);
  if (unsafe.empty()) return departure_s;
  unsafe = {unsafe.begin_s - askers_.time_margin_s, unsafe.end_s + askers_.time_margin_s};
  return unsafe.contains(departure_s) ? unsafe.end_s : departure_s;
}

/// A query about a move, and what it remembers.
struct ReservationTable::Question {
  const Move& move;
  double radius;
  int splits;  ///< of a slice by two, until the mover gets no farther than kSliceCells in a part
  NearFilter filter;
  double departure_s;
  double until_s;
  double later_s;             ///< the next departure to ask about
  DiskId blocker;             ///< met last
  double resume_s = 0;        ///< after departure: when it was met
  std::uint32_t cleared = 0;  ///< disks found clear at this departure
  std::array<DiskId, 4> clear_disks{kNoDisk, kNoDisk, kNoDisk, kNoDisk};

  bool is_news(DiskId disk) const {
    return disk != clear_disks[0] && disk != clear_disks[1] && disk != clear_disks[2] &&
           disk != clear_disks[3];
  }
};

/// Whether departing then is unsafe because of the disk; if so, later_s is when it no longer is.
inline bool ReservationTable::stands_in_the_way(Question& question, DiskId id) const {
  if (!question.is_news(id)) return false;
  const MovingDisk& disk = disks_[id];
  if (askers_.time_margin_s == 0) {
    const double reach = question.radius + disk.radius;
    const Closeness close = closeness(question.move, question.departure_s, disk, reach);
    if (close == Closeness::kApart) return false;
    // Unsafe departures past one disk are one interval: it holds all that lies between two of them.
    const double last_s = std::max(question.departure_s, question.until_s);
    if (close == Closeness::kOverlapping && last_s < kForever &&
        (last_s == question.departure_s || closeness(question.move, last_s, disk, reach) == close)) {
      question.later_s = std::nextafter(last_s, kForever);  // how much later does not matter
      question.blocker = id;
      return true;
    }
  }
  question.later_s = end_of_overlap(question.move, disk, question.radius, question.departure_s);
  if (question.later_s > question.departure_s) {
    question.blocker = id;
    return true;
  }
  question.clear_disks[question.cleared++ % question.clear_disks.size()] = id;
  return false;
}

template <class Test, class After>
inline bool ReservationTable::walk(const Move& move, double departure_s, int splits, NearFilter& filter,
                                   double from_s, double to_s, Test&& test, After&& after) const {
  const Vec2 velocity = move.velocity;
  const Vec2 origin = move.path.from + velocity * -departure_s;  // its place at time 0, extrapolated
  const double windows_per_s = slices_.per_second() * static_cast<double>(std::int64_t{1} << splits);
  const double window_s = 1 / windows_per_s;
  for (auto window = static_cast<std::int64_t>(from_s * windows_per_s);; ++window) {
    const double next_s = static_cast<double>(window + 1) * window_s;
    const double until_s = std::min(next_s, to_s);
    const std::size_t block = blocks_.at(origin + velocity * ((from_s + until_s) / 2));
    if (slices_.any_near(static_cast<std::size_t>(window >> splits), block, filter, origin, velocity, from_s,
                         until_s, test) ||
        after(from_s, until_s)) {
      return true;
    }
    if (!(next_s < to_s)) return false;
    from_s = next_s;
  }
}

/// Whether a disk that is met in [from_s, to_s] of absolute time blocks the move.
bool ReservationTable::is_stopped(Question& question, double from_s, double to_s) const {
  double window_s = from_s;
  const bool stopped = walk(
      question.move, question.departure_s, question.splits, question.filter, from_s, to_s,
      [&](DiskId id) { return stands_in_the_way(question, id); },
      [&](double begin_s, double) {
        window_s = begin_s;
        return false;
      });
  if (stopped) question.resume_s = window_s - question.departure_s;
  return stopped;
}

int ReservationTable::splits_of(const Move& move) const {
  int splits = 0;
  for (double cells = move.speed * slices_.slice_s(); cells > kSliceCells + kFilterMargin; cells /= 2)
    ++splits;
  return splits;
}

ReservationTable::DiskId ReservationTable::blocker(const Move& move, double radius_cells, double departure_s,
                                                   DiskId likely) const {
  const auto met_s = [&](const MovingDisk& disk) {
    return first_overlap_s(move, departure_s, disk, radius_cells + disk.radius);
  };
  if (likely != kNoDisk && met_s(disks_[likely]) < kForever) return likely;
  NearFilter filter(move.velocity * slices_.slice_s(), radius_cells + filter_margin_);
  DiskId first = kNoDisk;
  double first_s = kForever;
  // Of those met together, such as a robot at its start and the guard of that start, the one that stays.
  const auto key = [&](DiskId id) {
    const MovingDisk& disk = disks_[id];
    const auto [from, to] = std::pair(disk.from, disk.path.to);
    return std::tuple(disk.begin_s, -disk.end_s, from.x, from.y, to.x, to.y, disk.radius);
  };
  walk(
      move, departure_s, splits_of(move), filter, departure_s, departure_s + move.duration,
      [&](DiskId id) {
        const double overlap_s = met_s(disks_[id]);
        if (overlap_s < first_s || (overlap_s == first_s && first != kNoDisk && key(id) < key(first))) {
          first = id;
          first_s = overlap_s;
        }
        return false;
      },
      [&](double, double end_s) { return first_s <= end_s; });
  return first;
}

double ReservationTable::earliest_departure(const Move& move, double radius_cells, double from_s,
                                            double until_s, DiskId* likely_blocker) const {
  if (from_s == kForever || (!keepouts_.empty() && is_kept_out(move.path, radius_cells))) return kForever;
  // Unsafe departures may reach this much beyond the time that is spent near a disk.
  const double slack_s = kNearMissCells * move.seconds_per_cell;
  const double margin_s = slack_s < slices_.margin_s() ? 0 : slack_s;  // entries are that much longer already
  Question question{move,
                    radius_cells,
                    splits_of(move),
                    NearFilter(move.velocity * slices_.slice_s(), radius_cells + filter_margin_),
                    from_s,
                    until_s,
                    from_s,
                    likely_blocker ? *likely_blocker : kNoDisk};
  if (question.blocker != kNoDisk) stands_in_the_way(question, question.blocker);
  // Each jump ends where an unsafe interval ends, so no safe departure is missed.
  bool stopped = question.later_s > from_s;
  do {
    if (stopped) {
      question.departure_s = question.later_s;
      if (question.departure_s > until_s || question.departure_s == kForever) break;
      // A new departure: all disks are news again, except the one just answered.
      question.clear_disks.fill(question.blocker);
    }
    const double begin_s = std::max(question.departure_s - margin_s, 0.0);
    const double end_s = question.departure_s + move.duration + margin_s;
    // First from where the last disk was met: what lies beyond it is news.
    const double resume_s = std::min(std::max(begin_s, question.departure_s + question.resume_s), end_s);
    stopped = is_stopped(question, resume_s, end_s) ||
              (resume_s > begin_s && is_stopped(question, begin_s, resume_s));
  } while (stopped);
  if (likely_blocker) *likely_blocker = question.blocker;
  return question.departure_s;
}

}  // namespace sipplab
