// The reservation table against its plain twin, single collision intervals and
// distances.
#include "planner/reservation/reservation_table.hpp"

#include <rapidcheck.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <ostream>
#include <tuple>
#include <utility>
#include <vector>

#include "planner/geometry/collision_interval.hpp"
#include "planner/grid/line_of_sight.hpp"
#include "property_tests/support/distance_oracle.hpp"
#include "property_tests/support/encounters.hpp"
#include "property_tests/support/generators.hpp"
#include "property_tests/support/plain_twins.hpp"
#include "property_tests/support/property.hpp"

namespace sipplab::reservation_table_laws {
namespace {

constexpr std::int32_t kWidth = 7;
constexpr std::int32_t kHeight = 6;
constexpr int kTrafficsPerCase = 4;

/// A resting disk that may be removed again, as protected starts are.
struct Guard {
  Cell place;
  double begin_s = 0;
  double rest_s = 5;  ///< may be kForever
  double radius = 0.5;
  bool removed = false;

  MovingDisk disk() const { return MovingDisk::resting(centre(place), begin_s, begin_s + rest_s, radius); }
};

struct Traffic {
  Askers askers;
  std::vector<Cell> blocked;
  std::vector<Guard> guards;
  std::vector<Walk> walks;
  std::uint32_t removed_walks = 0;  ///< bit i is set: walk i is removed again

  bool removes_walk(std::size_t i) const { return (removed_walks >> i & 1) != 0; }
};

/// What a robot asks: when to leave for another cell.
struct Query {
  Cell from;
  Cell to;
  double radius = 0.5;
  double speed = 1;
  double from_s = 0;
  double until_s = 10;  ///< may be kForever

  Move move() const { return {Displacement(centre(from), centre(to)), speed}; }
};

std::ostream& operator<<(std::ostream& out, const Traffic& traffic) {
  out << "robots up to radius " << traffic.askers.max_radius_cells << " and about of speed "
      << traffic.askers.speed_cells_per_s << ", disks " << traffic.askers.time_margin_s
      << " s sooner and later\n";
  for (const Cell cell : traffic.blocked) out << "blocked (" << cell.x << ", " << cell.y << ")\n";
  for (const Guard& guard : traffic.guards) {
    out << (guard.removed ? "removed " : "") << "guard (" << guard.place.x << ", " << guard.place.y
        << ") radius " << guard.radius << " from " << guard.begin_s << " for " << guard.rest_s << "\n";
  }
  for (std::size_t i = 0; i < traffic.walks.size(); ++i) {
    out << (traffic.removes_walk(i) ? "removed " : "") << traffic.walks[i] << "\n";
  }
  return out;
}

std::ostream& operator<<(std::ostream& out, const Query& query) {
  return out << "(" << query.from.x << ", " << query.from.y << ") -> (" << query.to.x << ", " << query.to.y
             << ") radius " << query.radius << " speed " << query.speed << " in [" << query.from_s << ", "
             << query.until_s << "]";
}

rc::Gen<double> any_asking_radius() { return any_of({0.5, 0.5, 0.25, 1.0, 1.5, 0.3}); }

template <class Value>
rc::Gen<std::vector<Value>> up_to(std::size_t most, const rc::Gen<Value>& any) {
  return rc::gen::mapcat(
      rc::gen::resize(rc::kNominalSize, rc::gen::inRange<std::size_t>(0, most + 1)),
      [any](std::size_t count) { return rc::gen::container<std::vector<Value>>(count, any); });
}

/// None of them in half of all cases.
rc::Gen<std::uint32_t> any_walks_to_remove() {
  return rc::gen::oneOf(rc::gen::just(std::uint32_t{0}), rc::gen::inRange<std::uint32_t>(0, 64));
}

rc::Gen<Guard> any_guard() {
  return rc::gen::build<Guard>(rc::gen::set(&Guard::place, any_cell(kWidth, kHeight)),
                               rc::gen::set(&Guard::begin_s, any_of({0.0, 0.0, 1.5})),
                               rc::gen::set(&Guard::rest_s, any_of({5.0, 1.0, 2.5, kForever})),
                               rc::gen::set(&Guard::radius, any_radius()),
                               rc::gen::set(&Guard::removed, rc::gen::arbitrary<bool>()));
}

std::ostream& operator<<(std::ostream& out, const Guard& guard) {
  return out << (guard.removed ? "removed " : "") << "guard (" << guard.place.x << ", " << guard.place.y
             << ") radius " << guard.radius << " from " << guard.begin_s << " for " << guard.rest_s;
}

rc::Gen<Traffic> any_traffic() {
  const auto any_askers = rc::gen::build<Askers>(
      rc::gen::set(&Askers::max_radius_cells, any_of({1.5, 0.5, 0.25})),
      // Slower than the robots that ask, and so fast that slow ones are as good as at rest.
      rc::gen::set(&Askers::speed_cells_per_s, any_of({1.0, 1.0, 0.25, 40.0})),
      rc::gen::set(&Askers::time_margin_s, any_of({0.0, 0.0, 0.0, 0.5})));
  return rc::gen::build<Traffic>(rc::gen::set(&Traffic::askers, any_askers),
                                 rc::gen::set(&Traffic::blocked, up_to(2, any_cell(kWidth, kHeight))),
                                 rc::gen::set(&Traffic::guards, up_to(4, any_guard())),
                                 rc::gen::set(&Traffic::walks, up_to(6, any_walk(kWidth, kHeight))),
                                 rc::gen::set(&Traffic::removed_walks, any_walks_to_remove()));
}

rc::Gen<std::vector<Query>> any_queries() {
  const auto any_query = rc::gen::build<Query>(
      rc::gen::set(&Query::from, any_cell(kWidth, kHeight)),
      rc::gen::set(&Query::to, any_cell(kWidth, kHeight)), rc::gen::set(&Query::radius, any_asking_radius()),
      rc::gen::set(&Query::speed, any_speed()), rc::gen::set(&Query::from_s, any_eighths(4)),
      rc::gen::set(&Query::until_s, any_of({10.0, 2.0, 4.5, kForever})));
  return up_to(40, any_query);
}

/// A table with everything in it, and what it ought to hold.
class Filled {
 public:
  explicit Filled(const Traffic& traffic)
      : askers_(traffic.askers),
        map_(kWidth, kHeight),
        table_(map_, traffic.askers),
        twin_{{}, traffic.askers.time_margin_s} {
    for (const Cell cell : traffic.blocked) map_.set_blocked(cell, true);
    fill(traffic);
  }

  /// Adds guards, then walks, removes some of both, and asks for safe intervals in
  /// between, so that they have to be kept up to date.
  void fill(const Traffic& traffic) {
    std::vector<ReservationTable::DiskId> to_remove;
    for (const Guard& guard : traffic.guards) {
      const ReservationTable::DiskId id = table_.add(guard.disk());
      if (guard.removed) {
        to_remove.push_back(id);
      } else {
        twin_.disks.push_back(guard.disk());
      }
    }
    ask_everywhere(askers_.max_radius_cells);
    for (std::size_t i = 0; i < traffic.walks.size(); ++i) {
      if (i == traffic.walks.size() / 2)
        ask_everywhere(i % 2 == 0 ? askers_.max_radius_cells : askers_.max_radius_cells / 2);
      const Walk& walk = traffic.walks[i];
      if (traffic.removes_walk(i)) {
        for (const auto id : table_.add(walk.trajectory(), walk.radius)) to_remove.push_back(id);
      } else {
        add(walk);
      }
    }
    ask_everywhere(askers_.max_radius_cells);
    for (const ReservationTable::DiskId id : to_remove) table_.remove(id);
    ask_everywhere(askers_.max_radius_cells);
    // Once more after a removal.
    if (!traffic.walks.empty()) add(traffic.walks.front());
  }

  /// Adds a disk and, if it is to be removed, takes it out after `meanwhile`.
  template <class Meanwhile>
  void add_and_remove(const Guard& guard, Meanwhile&& meanwhile) {
    const ReservationTable::DiskId id = table_.add(guard.disk());
    twin_.disks.push_back(guard.disk());
    meanwhile();
    if (!guard.removed) return;
    table_.remove(id);
    twin_.disks.pop_back();
  }

  void clear() {
    table_.clear();
    twin_.disks.clear();
  }

  double largest_radius() const { return askers_.max_radius_cells; }
  const Askers& askers() const { return askers_; }
  const GridMap& map() const { return map_; }
  ReservationTable& table() { return table_; }
  const PlainTable& twin() const { return twin_; }

 private:
  void add(const Walk& walk) {
    const Trajectory trajectory = walk.trajectory();
    table_.add(trajectory, walk.radius);
    for (const MovingDisk& disk : disks_of(trajectory, walk.radius)) twin_.disks.push_back(disk);
  }

  void ask_everywhere(double radius) {
    for (std::size_t i = 0; i < map_.cell_count(); ++i) table_.safe_intervals(map_.cell(i), radius);
  }

  Askers askers_;
  GridMap map_;
  ReservationTable table_;
  PlainTable twin_;
};

void intervals_are_cut_by_every_disk(Filled& filled) {
  std::size_t points = 0;
  const double largest = filled.largest_radius();
  for (const double radius : {largest, largest / 2, 0.125, largest}) {
    for (std::size_t i = 0; i < filled.map().cell_count(); ++i) {
      const Cell cell = filled.map().cell(i);
      if (filled.map().is_blocked(cell)) continue;
      const std::vector<SafeInterval> expected = filled.twin().safe_intervals(cell, radius);
      RC_LOG() << "cell (" << cell.x << ", " << cell.y << ") radius " << radius << std::endl;
      const std::span<const SafeInterval> safe = filled.table().safe_intervals(cell, radius);
      RC_ASSERT(std::vector<SafeInterval>(safe.begin(), safe.end()) == expected);
      for (const Interval& interval : expected) {
        points += interval.end_s - interval.begin_s < 4 * kContactSlackCells;
      }
    }
  }
  RC_CLASSIFY(points > 0, "some single points");
}

/// Queries that a robot could pose: not larger than it said, between two different cells
/// with nothing blocked between.
std::vector<Query> posed(const std::vector<Query>& queries, const Filled& filled) {
  std::vector<Query> kept;
  for (Query query : queries) {
    query.radius = std::min(query.radius, filled.largest_radius());
    const LineOfSight line_of_sight(filled.map(), query.radius);
    if (query.from == query.to) continue;
    if (!line_of_sight.is_legal(query.from) || !line_of_sight.is_legal(query.to)) continue;
    if (line_of_sight.is_clear(query.from, query.to)) kept.push_back(query);
  }
  return kept;
}

/// How many have to wait.
int agrees_with_plain_twin(Filled& filled, const std::vector<Query>& queries) {
  int delayed = 0;
  for (const Query& query : posed(queries, filled)) {
    const Move move = query.move();
    const double indexed_s =
        filled.table().earliest_departure(move, query.radius, query.from_s, query.until_s);
    const double plain_s = filled.twin().earliest_departure(move, query.radius, query.from_s, query.until_s);
    RC_LOG() << query << std::endl;
    const Reservations& asked = filled.table();
    RC_ASSERT(asked.earliest_departure(query.from, query.to, query.speed, query.radius, query.from_s,
                                       query.until_s) == indexed_s);
    if (indexed_s > query.until_s && plain_s > query.until_s) continue;
    RC_ASSERT(indexed_s == plain_s);
    delayed += indexed_s > query.from_s;
  }
  return delayed;
}

/// Overlap of a move with all disks that are there together with it for `least_s` at least.
double deepest_overlap(const std::vector<MovingDisk>& disks, const Query& query, double departure_s,
                       double least_s) {
  const Move move = query.move();
  double deepest = -kForever;
  for (const MovingDisk& disk : disks) {
    const double together_s =
        std::min(disk.end_s, departure_s + move.duration) - std::max(disk.begin_s, departure_s);
    if (together_s < least_s) continue;
    const double apart = closest_approach(leg_of(move, departure_s), leg_of(disk));
    deepest = std::max(deepest, query.radius + disk.radius - apart);
  }
  return deepest;
}

/// How many departures were found, and how often there was none. Without a margin in time.
std::pair<int, int> is_the_earliest_safe(Filled& filled, const std::vector<Query>& queries) {
  /// Seconds: between departures that are tried, and the last of them.
  constexpr double kTryStepS = 1.0 / 16;
  constexpr double kTryUntilS = 25;
  /// Later than a safe departure by more than this is too late.
  constexpr double kToleranceS = 1e-6;
  int found = 0;
  int given_up = 0;
  for (const Query& query : posed(queries, filled)) {
    const double departure_s =
        filled.table().earliest_departure(query.move(), query.radius, query.from_s, query.until_s);
    RC_LOG() << query << ": " << departure_s << std::endl;
    RC_ASSERT(departure_s >= query.from_s);
    if (departure_s <= query.until_s && departure_s < kForever) {
      const double rounding = rounding_cells(departure_s, 4);
      RC_ASSERT(deepest_overlap(filled.twin().disks, query, departure_s, kContactSlackCells) <=
                kPermittedDepthCells + rounding);
      ++found;
    } else {
      ++given_up;
    }
    const double before_s = std::min({departure_s - kToleranceS, query.until_s, kTryUntilS});
    for (double tried_s = query.from_s; tried_s < before_s; tried_s += kTryStepS) {
      RC_LOG() << "tried " << tried_s << std::endl;
      RC_ASSERT(deepest_overlap(filled.twin().disks, query, tried_s, 0) > -rounding_cells(tried_s, 4));
    }
  }
  return {found, given_up};
}

/// Of all disks in the way at this departure the one that is met first, or one that is likely to be; of those
/// met together the same one in whatever order they were added. Returns how many moves are blocked.
int is_the_first_in_the_way(Filled& filled, const std::vector<Query>& queries) {
  ReservationTable reversed(filled.map(), filled.askers());
  const std::vector<MovingDisk>& disks = filled.twin().disks;
  std::for_each(disks.rbegin(), disks.rend(), [&](const MovingDisk& disk) { reversed.add(disk); });
  const auto what = [](const ReservationTable& table, ReservationTable::DiskId id) {
    const MovingDisk disk = id == ReservationTable::kNoDisk ? MovingDisk{} : table.disk(id);
    const auto [from, to] = std::pair(disk.path.from, disk.path.to);
    return std::tuple(disk.begin_s, disk.end_s, from.x, from.y, to.x, to.y, disk.radius);
  };
  int blocked = 0;
  auto likely = ReservationTable::kNoDisk;
  for (const Query& query : posed(queries, filled)) {
    RC_LOG() << query << std::endl;
    const Move move = query.move();
    double first_s = kForever;
    for (const MovingDisk& disk : filled.twin().disks) {
      first_s = std::min(first_s, first_overlap_s(move, query.from_s, disk, query.radius + disk.radius));
    }
    const auto met_s = [&](ReservationTable::DiskId id) {
      if (id == ReservationTable::kNoDisk) return kForever;
      const MovingDisk& disk = filled.table().disk(id);
      return first_overlap_s(move, query.from_s, disk, query.radius + disk.radius);
    };
    const auto first = filled.table().blocker(move, query.radius, query.from_s, ReservationTable::kNoDisk);
    RC_ASSERT(met_s(first) == first_s);
    const auto other = reversed.blocker(move, query.radius, query.from_s, ReservationTable::kNoDisk);
    RC_ASSERT(what(filled.table(), first) == what(reversed, other));
    const auto found = filled.table().blocker(move, query.radius, query.from_s, likely);
    RC_ASSERT(found == (met_s(likely) < kForever ? likely : first));
    if (first != ReservationTable::kNoDisk) likely = first;
    blocked += first_s < kForever;
  }
  return blocked;
}

const PropertyRoom room("reservation_table", [] {
  bool passed = true;

  passed &=
      property("safe_intervals: all time less the collision intervals of every disk, after any changes", [] {
        Filled filled(*any_traffic());
        intervals_are_cut_by_every_disk(filled);
      });

  passed &= property("earliest_departure: the same as its plain twin, to the last bit", [] {
    int delayed = 0;
    for (int i = 0; i < kTrafficsPerCase; ++i) {
      Filled filled(*any_traffic());
      delayed += agrees_with_plain_twin(filled, *any_queries());
    }
    RC_CLASSIFY(delayed >= 10, "ten or more have to wait");
  });

  passed &= property("blocker: of all disks in the way the one that is met first", [] {
    int blocked = 0;
    for (int i = 0; i < kTrafficsPerCase; ++i) {
      Filled filled(*any_traffic());
      blocked += is_the_first_in_the_way(filled, *any_queries());
    }
    RC_CLASSIFY(blocked >= 10, "ten or more are blocked");
  });

  passed &= property("earliest_departure: what comes within the inflated time counts, far away as it is", [] {
    constexpr std::int32_t kLength = 24;
    const GridMap map(kLength, 3);
    const double margin_s = *any_of({1.0, 2.5, 4.0});
    ReservationTable table(map, {0.25, 1, margin_s});
    PlainTable twin{{}, margin_s};
    const Displacement path(centre(Cell{0, 1}), centre(Cell{kLength - 1, *rc::gen::inRange(0, 3)}));
    const double begin_s = *any_eighths(4);
    const MovingDisk disk =
        MovingDisk::moving(path, begin_s, begin_s + path.length / *any_of({1.0, 2.0, 0.5}), 0.25);
    table.add(disk);
    twin.disks.push_back(disk);
    constexpr int kQueries = 20;
    for (int i = 0; i < kQueries; ++i) {
      const Cell from = *any_cell(kLength - 1, 3);
      const Move move(Displacement(centre(from), centre(Cell{from.x + 1, from.y})), 1);
      const double from_s = *any_eighths(24);
      RC_LOG() << "from " << from << " at " << from_s << std::endl;
      RC_ASSERT(table.earliest_departure(move, 0.25, from_s, kForever) ==
                twin.earliest_departure(move, 0.25, from_s, kForever));
    }
  });

  passed &= property("earliest_departure: safe by distances, and nothing earlier on the lattice is", [] {
    int found = 0;
    int given_up = 0;
    for (int i = 0; i < kTrafficsPerCase; ++i) {
      Traffic traffic = *any_traffic();
      traffic.askers.time_margin_s = 0;
      Filled filled(traffic);
      const std::pair<int, int> counts = is_the_earliest_safe(filled, *any_queries());
      found += counts.first;
      given_up += counts.second;
    }
    RC_CLASSIFY(found >= 10, "ten departures or more");
    RC_CLASSIFY(given_up >= 10, "ten times none or more");
  });

  passed &=
      property("safe_intervals: robots of more sizes than are kept up to date, one after the other", [] {
        Filled filled(*any_traffic());
        const std::vector<double> radii = {0.125, 0.25, 0.3, 0.4, 0.5, 0.625, 0.75};
        const auto ask = [&](double radius) {
          radius = std::min(radius, filled.largest_radius());
          const std::size_t index = *rc::gen::inRange<std::size_t>(0, filled.map().cell_count());
          const Cell cell = filled.map().cell(index);
          if (filled.map().is_blocked(cell)) return;
          const auto safe = filled.table().safe_intervals(cell, radius);
          RC_LOG() << "cell (" << cell.x << ", " << cell.y << ") radius " << radius << std::endl;
          RC_ASSERT(std::vector<SafeInterval>(safe.begin(), safe.end()) ==
                    filled.twin().safe_intervals(cell, radius));
        };
        for (const Guard& guard : *up_to(6, any_guard())) {
          for (int i = 0; i < 12; ++i) ask(*rc::gen::elementOf(radii));
          filled.add_and_remove(guard, [&] { ask(*rc::gen::elementOf(radii)); });
        }
        for (const double radius : radii) {
          for (int i = 0; i < 6; ++i) ask(radius);
        }
      });

  passed &= property("askers_of: the widest, a usual speed, and what the rules add", [] {
    PlanCase plan_case = *any_turning_case();
    const Askers askers = askers_of(plan_case.instance, plan_case.options.rules);
    double widest = 0;
    std::vector<double> speeds;
    for (const Agent& agent : plan_case.instance.agents) {
      widest = std::max(widest, agent.radius_cells);
      speeds.push_back(agent.speed_cells_per_s);
    }
    RC_ASSERT(askers.max_radius_cells == widest + plan_case.options.rules.inflate_distance_cells);
    if (speeds.empty()) speeds = {1};
    // The median, or a quarter of the fastest.
    std::sort(speeds.begin(), speeds.end());
    RC_ASSERT(askers.speed_cells_per_s == std::max(speeds[speeds.size() / 2], speeds.back() / 4));
    RC_ASSERT(askers.time_margin_s == plan_case.options.rules.inflate_time_s);
  });

  passed &= property("clear: nothing of the time before is remembered", [] {
    Filled filled(*any_traffic());
    filled.clear();
    intervals_are_cut_by_every_disk(filled);
    const auto queries = *any_queries();
    for (const Query& query : posed(queries, filled)) {
      RC_ASSERT(filled.table().earliest_departure(query.move(), query.radius, query.from_s, query.until_s) ==
                query.from_s);
    }
    const Traffic traffic = *any_traffic();
    filled.fill(traffic);
    intervals_are_cut_by_every_disk(filled);
    agrees_with_plain_twin(filled, queries);
  });

  return passed;
});

}  // namespace
}  // namespace sipplab::reservation_table_laws
