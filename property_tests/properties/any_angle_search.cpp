// AA-SIPP against SIPP. Plans of AA-SIPP are not the shortest that there are, but each
// node that SIPP comes to is offered to AA-SIPP no later, step by step, and its straight
// moves only add to that: with a heuristic that no path by steps falls below, no arrival is later.
#include <rapidcheck.h>

#include <algorithm>
#include <cstdint>

#include "planner/grid/line_of_sight.hpp"
#include "planner/search/sipp_search.hpp"
#include "property_tests/support/encounters.hpp"
#include "property_tests/support/property.hpp"

namespace sipplab::any_angle_search_laws {
namespace {

constexpr std::int32_t kWidth = 6;
constexpr std::int32_t kHeight = 5;
constexpr int kMostWalks = 5;
constexpr int kWorldsPerCase = 5;
/// Seconds. Slacks at contacts add up along a path, 1e-9 to 1e-8 each.
constexpr double kArrivalS = 1e-6;

/// One robot among obstacles that walk.
PlanCase any_world() {
  PlanCase world;
  Instance& instance = world.instance;
  instance.map = GridMap(kWidth, kHeight);
  Agent& agent = instance.agents.emplace_back();
  agent.start = *any_cell(kWidth, kHeight);
  agent.goal = *any_cell(kWidth, kHeight);
  agent.radius_cells = *any_of({0.5, 0.25, 0.4});
  agent.speed_cells_per_s = *any_speed();
  const int blocked = *rc::gen::inRange(0, 5);
  for (int i = 0; i < blocked; ++i) {
    const Cell cell = *any_cell(kWidth, kHeight);
    if (cell != agent.start && cell != agent.goal) instance.map.set_blocked(cell, true);
  }
  const int walks = *rc::gen::inRange(0, kMostWalks + 1);
  for (int i = 0; i < walks; ++i) {
    const Walk walk = *any_walk(kWidth, kHeight);
    if (distance(walk.start, agent.start) < walk.radius + agent.radius_cells) continue;
    instance.obstacles.push_back({"", walk.radius, walk.trajectory()});
  }
  world.options.connectedness = *any_of({2, 3, 4, 5});
  return world;
}

Expected<Trajectory, PlanFailure> search(const PlanCase& world, bool any_angle, SearchStatistics& work,
                                         const SearchLimits& limits = {}, bool static_distances = true) {
  SippOptions options;
  options.any_angle = any_angle;
  options.static_distances = static_distances;
  options.connectedness = world.options.connectedness;
  ReservationTable reservations(world.instance.map, world.instance.agents[0].radius_cells);
  for (const DynamicObstacle& obstacle : world.instance.obstacles) {
    reservations.add(obstacle.trajectory, obstacle.radius_cells);
  }
  return SippSearch(world.instance, options).plan(0, reservations, limits, work);
}

const PropertyRoom room("any_angle_search", [] {
  bool passed =
      property("work is counted: a node for each motion at least, one for a straight path alone", [] {
        for (int i = 0; i < kWorldsPerCase; ++i) {
          PlanCase world = any_world();
          note_case(world);
          for (const bool any_angle : {false, true}) {
            SearchStatistics work;
            const auto found = search(world, any_angle, work);
            if (!found) continue;
            const auto& motions = found->motions;
            const auto paths = static_cast<std::uint64_t>(std::count_if(
                motions.begin(), motions.end(), [](const TimedMotion& motion) { return !motion.is_wait(); }));
            RC_ASSERT(work.generations >= paths);
            RC_ASSERT(work.expansions >= std::min<std::uint64_t>(paths, 1));
            if (!any_angle) RC_ASSERT(work.expansions >= paths);
          }
          const Agent& agent = world.instance.agents[0];
          world.instance.obstacles.clear();
          const LineOfSight sight(world.instance.map, agent.radius_cells);
          if (agent.start == agent.goal || !sight.is_clear(agent.start, agent.goal)) continue;
          SearchStatistics work;
          RC_ASSERT(search(world, true, work).has_value());
          RC_ASSERT(work.expansions == 1u);
          RC_ASSERT(work.generations == 1u);
        }
      });

  passed &= property("AA-SIPP arrives wherever SIPP does, and no later, by either heuristic", [] {
    bool earlier = false;
    for (int i = 0; i < kWorldsPerCase; ++i) {
      const PlanCase world = any_world();
      note_case(world);
      SearchStatistics work;
      const auto stepwise = search(world, false, work);
      if (!stepwise) continue;
      for (const bool static_distances : {true, false}) {
        const auto any_angle = search(world, true, work, {}, static_distances);
        RC_ASSERT(static_cast<bool>(any_angle));
        RC_ASSERT(any_angle->arrival_s() <= stepwise->arrival_s() + kArrivalS);
        earlier = earlier || any_angle->arrival_s() < stepwise->arrival_s() - kArrivalS;
      }
    }
    RC_CLASSIFY(earlier, "some arrive earlier");
  });

  passed &= property("whoever arrives within a latest arrival is found; nothing later is", [] {
    bool too_late = false;
    for (int i = 0; i < kWorldsPerCase; ++i) {
      const PlanCase world = any_world();
      note_case(world);
      SearchStatistics work;
      const bool any_angle = *rc::gen::arbitrary<bool>();
      const auto found = search(world, any_angle, work);
      if (!found) continue;
      SearchLimits limits;
      limits.latest_arrival_s = found->arrival_s() * *any_of({0.5, 0.9, 1 + kArrivalS, 1.5});
      const auto limited = search(world, any_angle, work, limits);
      if (limited) RC_ASSERT(limited->arrival_s() <= limits.latest_arrival_s);
      // On a grid f never falls along a path, so that nothing is given up for its bound.
      if (!any_angle) RC_ASSERT(limited.has_value() == (found->arrival_s() <= limits.latest_arrival_s));
      too_late = too_late || found->arrival_s() > limits.latest_arrival_s;
    }
    RC_CLASSIFY(too_late, "some arrive too late");
  });
  return passed;
});

}  // namespace
}  // namespace sipplab::any_angle_search_laws
