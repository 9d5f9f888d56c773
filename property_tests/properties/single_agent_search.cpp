// SIPP and AA-SIPP for one robot against an exhaustive search.
#include <rapidcheck.h>

#include <algorithm>
#include <atomic>
#include <chrono>
#include <cmath>
#include <cstdint>
#include <optional>
#include <ostream>
#include <vector>

#include "planner/search/sipp_search.hpp"
#include "property_tests/support/distance_oracle.hpp"
#include "property_tests/support/encounters.hpp"
#include "property_tests/support/exact_line_of_sight.hpp"
#include "property_tests/support/exhaustive_search.hpp"
#include "property_tests/support/plain_twins.hpp"
#include "property_tests/support/property.hpp"

namespace sipplab::single_agent_search_laws {
namespace {

/// Seconds. Slacks at contacts add up along a path, 1e-9 to 1e-8 each; another path is
/// later or earlier by far more.
constexpr double kArrivalS = 1e-6;
/// Seconds. Rounding of sums of square roots.
constexpr double kRoundingS = 1e-9;

constexpr std::int32_t kWidth = 5;
constexpr std::int32_t kHeight = 4;

/// One robot on a small map among walking obstacles. Blocked cells and obstacles that
/// the start or the goal do not allow are left out.
struct World {
  std::vector<Cell> blocked;
  std::vector<Walk> walks;
  Cell start;
  Cell goal;
  Fraction radius;
  double speed = 1;
  int connectedness = 2;

  Instance instance() const {
    Instance instance;
    instance.map = GridMap(kWidth, kHeight);
    for (const Cell cell : blocked) {
      if (cell != start && cell != goal) instance.map.set_blocked(cell, true);
    }
    Agent agent;
    agent.start = start;
    agent.goal = goal;
    agent.radius_cells = radius.value();
    agent.speed_cells_per_s = speed;
    instance.agents.push_back(agent);
    for (const Walk& walk : walks) {
      if (distance(walk.start, start) < walk.radius + radius.value()) continue;
      DynamicObstacle obstacle;
      obstacle.radius_cells = walk.radius;
      obstacle.trajectory = walk.trajectory();
      instance.obstacles.push_back(obstacle);
    }
    return instance;
  }

  LoneRobot robot() const { return {start, goal, radius, speed, connectedness}; }
};

std::ostream& operator<<(std::ostream& out, const World& world) {
  for (const Cell cell : world.blocked) out << "blocked (" << cell.x << ", " << cell.y << ")\n";
  for (const Walk& walk : world.walks) out << walk << "\n";
  return out << "(" << world.start.x << ", " << world.start.y << ") -> (" << world.goal.x << ", "
             << world.goal.y << ") radius " << world.radius.value() << " speed " << world.speed
             << " connectedness " << world.connectedness;
}

/// Radii of one half and less, so that every free cell can be stood on.
rc::Gen<Fraction> any_slim_radius() { return any_of<Fraction>({{1, 2}, {1, 2}, {1, 4}, {3, 10}, {2, 5}}); }

template <class Value>
rc::Gen<std::vector<Value>> up_to(std::size_t most, const rc::Gen<Value>& any) {
  return rc::gen::mapcat(
      rc::gen::resize(rc::kNominalSize, rc::gen::inRange<std::size_t>(0, most + 1)),
      [any](std::size_t count) { return rc::gen::container<std::vector<Value>>(count, any); });
}

rc::Gen<World> any_world(std::size_t most_walks) {
  return rc::gen::build<World>(
      rc::gen::set(&World::blocked, up_to(5, any_cell(kWidth, kHeight))),
      rc::gen::set(&World::walks, up_to(most_walks, any_walk(kWidth, kHeight))),
      rc::gen::set(&World::start, any_cell(kWidth, kHeight)),
      rc::gen::set(&World::goal, any_cell(kWidth, kHeight)), rc::gen::set(&World::radius, any_slim_radius()),
      rc::gen::set(&World::speed, any_speed()), rc::gen::set(&World::connectedness, any_of({2, 2, 3, 4, 5})));
}

SippOptions plain_sipp(const World& world) {
  SippOptions options;
  options.any_angle = false;
  options.connectedness = world.connectedness;
  return options;
}

SippOptions any_angle_sipp(const World& world) {
  SippOptions options;
  options.connectedness = world.connectedness;
  return options;
}

void fill(ReservationTable& reservations, const Instance& instance) {
  for (const DynamicObstacle& obstacle : instance.obstacles) {
    reservations.add(obstacle.trajectory, obstacle.radius_cells);
  }
}

struct Outcome {
  std::optional<Trajectory> trajectory;
  PlanFailure failure = PlanFailure::kNoPath;  ///< if there is no trajectory
  SearchStatistics statistics;
};

Outcome search(const Instance& instance, const SippOptions& options, const SearchLimits& limits = {}) {
  ReservationTable reservations(instance.map, instance.agents[0].radius_cells);
  fill(reservations, instance);
  SippSearch sipp(instance, options);
  Outcome outcome;
  const auto planned = sipp.plan(0, reservations, limits, outcome.statistics);
  if (planned) {
    outcome.trajectory = *planned;
  } else {
    outcome.failure = planned.error();
  }
  return outcome;
}

std::vector<MovingDisk> disks_of(const Instance& instance) {
  std::vector<MovingDisk> disks;
  for (const DynamicObstacle& obstacle : instance.obstacles) {
    for (const MovingDisk& disk : disks_of(obstacle.trajectory, obstacle.radius_cells)) disks.push_back(disk);
  }
  return disks;
}

/// Whether the robot is later than it would be alone: else a case says little.
bool has_to_give_way(const Instance& instance, const Trajectory& trajectory, const SippOptions& options) {
  Instance alone = instance;
  alone.obstacles.clear();
  const Outcome free = search(alone, options);
  return free.trajectory && trajectory.arrival_s() > free.trajectory->arrival_s() + kArrivalS;
}

/// SIPP arrives when it does without lazy successors, an indexed table and a heuristic.
void arrives_with_its_twin(const World& world, const SippOptions& options) {
  const Instance instance = world.instance();
  const Outcome fast = search(instance, options);
  const auto plain_s = plain_arrival_s(instance.map, PlainTable{disks_of(instance)}, instance.agents[0],
                                       options.connectedness);
  RC_ASSERT(fast.trajectory.has_value() == plain_s.has_value());
  if (!fast.trajectory) return;
  RC_ASSERT(std::abs(fast.trajectory->arrival_s() - *plain_s) <= kArrivalS);
  RC_CLASSIFY(has_to_give_way(instance, *fast.trajectory, options), "has to give way");
}

/// What became of a robot among obstacles.
enum class Meeting { kNoPath, kUnhindered, kGivesWay };

Meeting arrives_as_early_as_exhaustive_search(const World& world) {
  const Instance instance = world.instance();
  const Outcome outcome = search(instance, plain_sipp(world));
  const auto expected_s = earliest_arrival_s(instance.map, disks_of(instance), world.robot());
  RC_ASSERT(outcome.trajectory.has_value() == expected_s.has_value());
  if (!expected_s) return Meeting::kNoPath;
  RC_LOG() << outcome.trajectory->arrival_s() << " s, expected " << *expected_s << " s" << std::endl;
  RC_ASSERT(std::abs(outcome.trajectory->arrival_s() - *expected_s) <= kArrivalS);
  return has_to_give_way(instance, *outcome.trajectory, plain_sipp(world)) ? Meeting::kGivesWay
                                                                           : Meeting::kUnhindered;
}

void keeps_clear(const Instance& instance, const World& world, const Trajectory& trajectory) {
  RC_ASSERT(trajectory.start == world.start);
  RC_ASSERT(trajectory.end() == world.goal);
  std::vector<Leg> legs;
  double now_s = 0;
  Cell here = world.start;
  for (const TimedMotion& motion : trajectory.motions) {
    RC_ASSERT(motion.begin_s == now_s);
    RC_ASSERT(motion.from == here);
    RC_ASSERT(motion.end_s > motion.begin_s);
    if (!motion.is_wait()) {
      const double duration_s = distance(motion.from, motion.to) / world.speed;
      RC_ASSERT(std::abs(motion.end_s - motion.begin_s - duration_s) <= kRoundingS);
    }
    RC_ASSERT(exactly_clear(instance.map, world.radius, motion.from, motion.to));
    legs.push_back({centre(motion.from), centre(motion.to), motion.begin_s, motion.end_s});
    now_s = motion.end_s;
    here = motion.to;
  }
  legs.push_back({centre(here), centre(here), now_s, kForever});
  for (const MovingDisk& disk : disks_of(instance)) {
    for (const Leg& leg : legs) {
      const double apart = closest_approach(leg, leg_of(disk));
      RC_ASSERT(apart >= world.radius.value() + disk.radius - kValidatorToleranceCells);
    }
  }
}

/// Any-angle, two motions in a row and in one line are one motion, unless they are apart in time.
void goes_each_line_at_once(const Trajectory& trajectory) {
  for (std::size_t i = 1; i < trajectory.motions.size(); ++i) {
    const TimedMotion& before = trajectory.motions[i - 1];
    const TimedMotion& motion = trajectory.motions[i];
    if (before.is_wait() || motion.is_wait()) continue;
    const Displacement one(centre(before.from), centre(before.to));
    const Displacement next(centre(motion.from), centre(motion.to));
    RC_ASSERT(dot(one.direction, next.direction) < 1 - kRoundingS);
  }
}

/// Arrival over the 2^k neighbourhood when nothing moves.
std::optional<double> alone_arrival_s(const World& world, int connectedness) {
  LoneRobot robot = world.robot();
  robot.connectedness = connectedness;
  return earliest_arrival_s(world.instance().map, {}, robot);
}

void is_straight_or_stepwise_alone(World world) {
  world.walks.clear();
  const Instance instance = world.instance();
  const auto stepwise_s = alone_arrival_s(world, world.connectedness);
  for (const bool any_angle : {false, true}) {
    const Outcome outcome = search(instance, any_angle ? any_angle_sipp(world) : plain_sipp(world));
    RC_ASSERT(outcome.trajectory.has_value() == stepwise_s.has_value());
    if (!stepwise_s) continue;
    const double arrival_s = outcome.trajectory->arrival_s();
    const double straight_s = distance(world.start, world.goal) / world.speed;
    RC_ASSERT(arrival_s >= straight_s - kRoundingS);
    RC_ASSERT(arrival_s <= *stepwise_s + kRoundingS);
    if (!any_angle) RC_ASSERT(std::abs(arrival_s - *stepwise_s) <= kRoundingS);
    const bool visible = exactly_clear(instance.map, world.radius, world.start, world.goal);
    if (any_angle && visible) RC_ASSERT(arrival_s <= straight_s + kRoundingS);
  }
}

/// How much later than the earliest arrival by steps a weighted search is, as a factor; none if
/// there is no path.
std::optional<double> is_late_by_its_weight_at_most(const Instance& instance, const SippOptions& options,
                                                    std::optional<double> earliest_s) {
  const Outcome outcome = search(instance, options);
  // Straight moves may lead where steps do not.
  RC_ASSERT(outcome.trajectory.has_value() == earliest_s.has_value() || (options.any_angle && !earliest_s));
  if (!earliest_s) return std::nullopt;
  const double arrival_s = outcome.trajectory->arrival_s();
  RC_LOG() << arrival_s << " s with weight " << options.weight << ", earliest " << *earliest_s << " s"
           << std::endl;
  RC_ASSERT(arrival_s <= options.weight * *earliest_s + kArrivalS);
  if (!options.any_angle) {  // else f may fall along a path
    RC_ASSERT(arrival_s >= *earliest_s - kArrivalS);
    SearchLimits just_in_time;
    just_in_time.latest_arrival_s = arrival_s + kRoundingS;
    RC_ASSERT(search(instance, options, just_in_time).trajectory == outcome.trajectory);
  }
  return *earliest_s > 0 ? arrival_s / *earliest_s : 1;
}

/// By how many seconds a path got shorter when it was pulled tight; none if there is no path.
std::optional<double> gains_by_elastic(const World& world, SippOptions options) {
  const Instance instance = world.instance();
  const Outcome tight = search(instance, options);
  options.elastic = false;
  const Outcome found = search(instance, options);
  RC_ASSERT(tight.trajectory.has_value() == found.trajectory.has_value());
  RC_ASSERT(tight.statistics.expansions == found.statistics.expansions);
  if (!found.trajectory) return std::nullopt;
  keeps_clear(instance, world, *tight.trajectory);
  goes_each_line_at_once(*tight.trajectory);
  goes_each_line_at_once(*found.trajectory);
  const double gain_s = found.trajectory->arrival_s() - tight.trajectory->arrival_s();
  RC_ASSERT(gain_s >= 0);
  return gain_s;
}

/// Every stop is left as soon as the move to the next one is safe and ends in the safe interval in which it
/// does. How many are left later than they were reached.
int leaves_each_stop_early(const Instance& instance, const Trajectory& trajectory) {
  const PlainTable table{disks_of(instance)};
  const Agent& agent = instance.agents[0];
  int waits = 0;
  double reached_s = 0;
  for (const TimedMotion& motion : trajectory.motions) {
    if (motion.is_wait()) continue;
    const Move move(Displacement(centre(motion.from), centre(motion.to)), agent.speed_cells_per_s);
    for (const SafeInterval& interval : table.safe_intervals(motion.to, agent.radius_cells)) {
      if (!interval.contains(motion.end_s)) continue;
      const double from_s = std::max(reached_s, interval.begin_s - move.duration);
      const double least_s = table.earliest_departure(move, agent.radius_cells, from_s, motion.begin_s);
      RC_ASSERT(motion.begin_s <= least_s + kArrivalS);
    }
    waits += motion.begin_s > reached_s;
    reached_s = motion.end_s;
  }
  return waits;
}

/// How many stops could be left out, as far as the reservations go: the straight move from the stop before to
/// the one after is clear and safe, and arrives no later.
int stops_to_leave_out(const Instance& instance, const World& world, const Trajectory& trajectory) {
  struct Stop {
    Cell cell;
    double arrival_s;
  };
  const PlainTable table{disks_of(instance)};
  const Agent& agent = instance.agents[0];
  std::vector<Stop> stops = {{trajectory.start, 0}};
  for (const TimedMotion& motion : trajectory.motions) {
    if (!motion.is_wait()) stops.push_back({motion.to, motion.end_s});
  }
  const auto interval_at = [&](const Stop& stop) {
    for (const SafeInterval& interval : table.safe_intervals(stop.cell, agent.radius_cells)) {
      if (interval.contains(stop.arrival_s)) return interval;
    }
    return SafeInterval{kForever, kForever};
  };
  int found = 0;
  for (std::size_t i = 1; i + 1 < stops.size(); ++i) {
    const Stop& before = stops[i - 1];
    const Stop& after = stops[i + 1];
    if (before.cell == after.cell || !exactly_clear(instance.map, world.radius, before.cell, after.cell))
      continue;
    const SafeInterval from = interval_at(before);
    const SafeInterval to = interval_at(after);
    const Move move(Displacement(centre(before.cell), centre(after.cell)), agent.speed_cells_per_s);
    const double from_s = std::max(before.arrival_s, to.begin_s - move.duration);
    const double until_s = std::min(from.end_s, to.end_s - move.duration);
    if (from_s > until_s) continue;
    const double departs_s = table.earliest_departure(move, agent.radius_cells, from_s, until_s);
    found += departs_s <= until_s && departs_s + move.duration <= after.arrival_s - kRoundingS;
  }
  return found;
}

/// How many expansions the search takes without a limit.
std::uint64_t respects_limit(const World& world, const SippOptions& options) {
  const Instance instance = world.instance();
  const Outcome whole = search(instance, options);
  const std::uint64_t needed = whole.statistics.expansions;
  for (const std::uint64_t limit :
       {std::uint64_t{0}, std::uint64_t{1}, needed / 2, needed - (needed > 0 ? 1 : 0), needed, needed + 1}) {
    SearchLimits limits;
    limits.max_expansions = limit;
    const Outcome cut = search(instance, options, limits);
    RC_ASSERT(cut.statistics.expansions == std::min(limit, needed));
    RC_ASSERT(cut.trajectory == (limit < needed ? std::nullopt : whole.trajectory));
    if (limit < needed) RC_ASSERT(cut.failure == PlanFailure::kExpansionLimit);
  }
  return needed;
}

const PropertyRoom room("single_agent_search", [] {
  bool passed = true;

  passed &= property("SIPP arrives exactly as early as an exhaustive search", [] {
    constexpr int kWorlds = 2;
    int late = 0;
    int unsolved = 0;
    for (int i = 0; i < kWorlds; ++i) {
      const Meeting meeting = arrives_as_early_as_exhaustive_search(*any_world(4));
      late += meeting == Meeting::kGivesWay;
      unsolved += meeting == Meeting::kNoPath;
    }
    RC_CLASSIFY(late > 0, "some have to give way");
    RC_CLASSIFY(unsolved > 0, "some without a path");
  });

  passed &= property("SIPP and AA-SIPP keep clear of everything that moves and stands", [] {
    constexpr int kWorlds = 5;
    int found = 0;
    for (int i = 0; i < kWorlds; ++i) {
      const World world = *any_world(5);
      const Instance instance = world.instance();
      for (const SippOptions& options : {plain_sipp(world), any_angle_sipp(world)}) {
        const Outcome outcome = search(instance, options);
        if (!outcome.trajectory) continue;
        ++found;
        keeps_clear(instance, world, *outcome.trajectory);
        if (options.any_angle) goes_each_line_at_once(*outcome.trajectory);
      }
    }
    RC_CLASSIFY(found >= kWorlds, "many trajectories");
  });

  passed &= property("alone, SIPP takes the shortest stepwise path and AA-SIPP straight where it can", [] {
    constexpr int kWorlds = 5;
    for (int i = 0; i < kWorlds; ++i) is_straight_or_stepwise_alone(*any_world(0));
  });

  passed &=
      property("SIPP arrives with its plain twin, with the map's distances in the heuristic and without", [] {
        const World world = *any_world(5);
        SippOptions options = plain_sipp(world);
        arrives_with_its_twin(world, options);
        options.static_distances = false;
        arrives_with_its_twin(world, options);
      });

  passed &= property("weighted, a path is found where there is one, and no later than the weight allows", [] {
    const World world = *any_world(4);
    const double weight = *any_of({1.0, 1.0625, 1.25, 2.0, 5.0});
    const Instance instance = world.instance();
    const auto earliest_s = earliest_arrival_s(instance.map, disks_of(instance), world.robot());
    double lateness = 1;
    for (SippOptions options : {plain_sipp(world), any_angle_sipp(world)}) {
      options.weight = weight;
      const auto late = is_late_by_its_weight_at_most(instance, options, earliest_s);
      lateness = std::max(lateness, late.value_or(1));
    }
    RC_CLASSIFY(lateness > 1 + kArrivalS, "later than it might be");
  });

  passed &= property("paths are pulled tight: clear of everything, and never later", [] {
    constexpr int kWorlds = 5;
    int gains = 0;
    for (int i = 0; i < kWorlds; ++i) {
      const World world = *any_world(5);
      SippOptions options = any_angle_sipp(world);
      options.weight = *any_of({1.0, 1.25, 2.0, 5.0});
      gains += gains_by_elastic(world, options).value_or(0) > kArrivalS;
    }
    RC_CLASSIFY(gains > 0, "some earlier");
  });

  passed &= property("every stop is left as early as is safe, whatever the weight", [] {
    constexpr int kWorlds = 5;
    int waits = 0;
    for (int i = 0; i < kWorlds; ++i) {
      const World world = *any_world(5);
      const double weight = *any_of({1.0, 1.25, 2.0, 5.0});
      const Instance instance = world.instance();
      for (const bool elastic : {false, true}) {
        SippOptions options = any_angle_sipp(world);
        options.elastic = elastic;
        options.weight = weight;
        const Outcome outcome = search(instance, options);
        if (!outcome.trajectory) continue;
        waits += leaves_each_stop_early(instance, *outcome.trajectory);
        const int stops = stops_to_leave_out(instance, world, *outcome.trajectory);
        // Pulling tight ends where no single change gains; some stops stay that a straight line could spare.
        RC_CLASSIFY(stops > 0 && !elastic, "stops to leave out");
        RC_CLASSIFY(stops > 0 && elastic, "stops to leave out, pulled tight");
      }
    }
    RC_CLASSIFY(waits > 0, "some wait");
  });

  passed &= property("a search and a table that were used before change nothing", [] {
    const World world = *any_world(5);
    const Instance instance = world.instance();
    for (const SippOptions& options : {plain_sipp(world), any_angle_sipp(world)}) {
      const Outcome fresh = search(instance, options);
      ReservationTable reservations(instance.map, instance.agents[0].radius_cells);
      SippSearch sipp(instance, options);
      SearchStatistics statistics;
      const auto alone = sipp.plan(0, reservations, {}, statistics);
      RC_ASSERT(alone.has_value() || !fresh.trajectory);
      fill(reservations, instance);
      for (int i = 0; i < 2; ++i) {
        const auto again = sipp.plan(0, reservations, {}, statistics);
        RC_ASSERT(again.has_value() == fresh.trajectory.has_value());
        if (again) RC_ASSERT(*again == *fresh.trajectory);
      }
    }
  });

  passed &= property("a search that is out of time, or told to stop, says so at once", [] {
    const World world = *any_world(4);
    const Instance instance = world.instance();
    for (const SippOptions& options : {plain_sipp(world), any_angle_sipp(world)}) {
      const Outcome whole = search(instance, options);
      SearchLimits limits;
      const std::atomic<bool> stop{true};
      if (*rc::gen::arbitrary<bool>()) {
        limits.stop = &stop;
      } else {
        limits.deadline = std::chrono::steady_clock::now() - std::chrono::seconds(1);
      }
      const Outcome cut = search(instance, options, limits);
      RC_ASSERT(cut.statistics.expansions == 0U);
      if (whole.statistics.expansions == 0) continue;
      RC_ASSERT(!cut.trajectory);
      RC_ASSERT(cut.failure == PlanFailure::kTimeLimit);
    }
  });

  passed &= property("max_expansions: no more than so many, and the failure says so", [] {
    const World world = *any_world(4);
    const std::uint64_t plain = respects_limit(world, plain_sipp(world));
    respects_limit(world, any_angle_sipp(world));
    RC_CLASSIFY(plain > 3, "more than three expansions");
  });

  return passed;
});

}  // namespace
}  // namespace sipplab::single_agent_search_laws
