// Claim: wherever there is a fast path, it gives what its plain twin gives: the indexed
// reservation table and lazy successors. The traffic is the plan of the case
// itself, in which contacts are everywhere. Nothing is claimed of the straight shot at the
// goal: with other robots about, the search may arrive earlier without it, or later.
#include <algorithm>
#include <cmath>
#include <optional>
#include <vector>

#include "fuzz/support/case_input.hpp"
#include "fuzz/support/claims.hpp"
#include "fuzz/support/target.hpp"
#include "planner/core/tolerances.hpp"
#include "planner/grid/line_of_sight.hpp"
#include "planner/search/sipp_search.hpp"
#include "planner/solve/plan.hpp"
#include "property_tests/support/plain_twins.hpp"

namespace {

using namespace sipplab;
using fuzz::Claim;

/// Seconds. Where two disks set the mover free at the same time, each gives that time with
/// its own slack and rounding, and the twins may look at either first.
constexpr double kTwinS = 1e-7;
/// Seconds. Slacks at contacts add up along a path, 1e-9 to 1e-8 each.
constexpr double kArrivalS = 1e-6;
/// Cells. More than all slacks along a path, less than any real excess.
constexpr double kNoContactCells = 1e-7;
/// Times from which departures are asked for, in seconds.
constexpr double kFromS[] = {0, 0.125, 1, 2.5};

void require_twins(bool condition, const char* detail) {
  fuzz::require(Claim::kTwinsAgree, condition, detail);
}

/// Everything that moves around one robot: obstacles, and the plan of the others.
struct Traffic {
  std::vector<Trajectory> trajectories;
  std::vector<double> radii;
};

Traffic traffic_around(const PlanCase& plan_case, AgentIndex agent) {
  Traffic traffic;
  const auto add = [&](const Trajectory& trajectory, double radius) {
    traffic.trajectories.push_back(trajectory);
    traffic.radii.push_back(radius);
  };
  for (const DynamicObstacle& obstacle : plan_case.instance.obstacles) {
    add(obstacle.trajectory, obstacle.radius_cells);
  }
  const PlanResult result = plan(plan_case.instance, plan_case.options);
  if (result.status != PlanStatus::kSolved) return traffic;
  fuzz::count(fuzz::Event::kSolved);
  for (AgentIndex other = 0; other < plan_case.instance.agents.size(); ++other) {
    if (other != agent)
      add(result.solution.trajectories[other], plan_case.instance.agents[other].radius_cells);
  }
  return traffic;
}

/// The same with bodies so much larger that no path along them touches.
Traffic kept_apart(Traffic traffic) {
  for (double& radius : traffic.radii) radius += kNoContactCells;
  return traffic;
}

PlainTable twin_of(const Traffic& traffic) {
  PlainTable twin;
  for (std::size_t i = 0; i < traffic.trajectories.size(); ++i) {
    const Trajectory& trajectory = traffic.trajectories[i];
    const double radius = traffic.radii[i];
    for (const TimedMotion& motion : trajectory.motions) {
      twin.disks.push_back(MovingDisk::moving(Displacement(centre(motion.from), centre(motion.to)),
                                              motion.begin_s, motion.end_s, radius));
    }
    twin.disks.push_back(MovingDisk::resting(centre(trajectory.end()), trajectory.end_s(), kForever, radius));
  }
  return twin;
}

void fill(ReservationTable& table, const Traffic& traffic) {
  for (std::size_t i = 0; i < traffic.trajectories.size(); ++i) {
    table.add(traffic.trajectories[i], traffic.radii[i]);
  }
}

void check_departures(const Instance& instance, const Agent& agent, const Traffic& traffic) {
  ReservationTable table(instance.map, agent.radius_cells);
  fill(table, traffic);
  const PlainTable twin = twin_of(traffic);
  const LineOfSight sight(instance.map, agent.radius_cells);
  for (std::size_t i = 0; i < instance.map.cell_count(); ++i) {
    const Cell to = instance.map.cell(i);
    if (to == agent.start || !sight.is_legal(to) || !sight.is_clear(agent.start, to)) continue;
    const Move move(Displacement(centre(agent.start), centre(to)), agent.speed_cells_per_s);
    const double from_s = kFromS[i % std::size(kFromS)];
    const double fast_s = table.earliest_departure(move, agent.radius_cells, from_s, kForever);
    const double plain_s = twin.earliest_departure(move, agent.radius_cells, from_s, kForever);
    fuzz::count(fuzz::Event::kComparisons);
    require_twins(fast_s == plain_s || std::abs(fast_s - plain_s) <= kTwinS, "another earliest departure");
  }
}

void check_safe_intervals(const Instance& instance, const Agent& agent, const Traffic& traffic) {
  ReservationTable table(instance.map, agent.radius_cells);
  fill(table, traffic);
  const PlainTable twin = twin_of(traffic);
  for (std::size_t i = 0; i < instance.map.cell_count(); ++i) {
    const Cell cell = instance.map.cell(i);
    if (instance.map.is_blocked(cell)) continue;
    require_twins(std::ranges::equal(table.safe_intervals(cell, agent.radius_cells),
                                     twin.safe_intervals(cell, agent.radius_cells)),
                  "other safe intervals");
  }
}

struct Arrival {
  bool found = false;
  double arrival_s = 0;
};

Arrival search(const PlanCase& plan_case, AgentIndex agent, const Traffic& traffic,
               const SippOptions& options) {
  ReservationTable table(plan_case.instance.map, plan_case.instance.agents[agent].radius_cells);
  fill(table, traffic);
  SearchStatistics statistics;
  const auto trajectory = SippSearch(plan_case.instance, options).plan(agent, table, {}, statistics);
  if (!trajectory) return {};
  return {true, trajectory->arrival_s()};
}

void check_searches(const PlanCase& plan_case, AgentIndex agent, const Traffic& traffic) {
  SippOptions options;
  options.connectedness = plan_case.options.connectedness;
  options.any_angle = false;
  const Arrival grid = search(plan_case, agent, traffic, options);
  const auto plain_s = plain_arrival_s(plan_case.instance.map, twin_of(traffic),
                                       plan_case.instance.agents[agent], options.connectedness);
  const Arrival plain{plain_s.has_value(), plain_s.value_or(0)};
  options.static_distances = false;
  const Arrival straight = search(plan_case, agent, traffic, options);
  for (const Arrival& twin : {plain, straight}) {
    require_twins(twin.found == grid.found, "found by one twin only");
    require_twins(!grid.found || std::abs(twin.arrival_s - grid.arrival_s) <= kArrivalS, "another arrival");
  }
  options.static_distances = true;
  options.weight = plan_case.options.weight;
  const Arrival weighted = search(plan_case, agent, traffic, options);
  require_twins(weighted.found == grid.found, "found with one weight of the heuristic only");
  options.any_angle = true;
  const Arrival tight = search(plan_case, agent, traffic, options);
  options.elastic = false;
  const Arrival bent = search(plan_case, agent, traffic, options);
  require_twins(tight.found == bent.found, "found only where pulled tight");
  require_twins(tight.arrival_s <= bent.arrival_s, "pulled tight and later");
  if (!grid.found) return;
  require_twins(weighted.arrival_s <= options.weight * grid.arrival_s + kArrivalS,
                "later than the weight allows");
  options = {};
  options.connectedness = plan_case.options.connectedness;
  const Arrival any_angle = search(plan_case, agent, traffic, options);
  if (any_angle.found && any_angle.arrival_s <= grid.arrival_s + kArrivalS) return;
  // The move between neighbours may run through a slot of zero width that the slacks of several
  // robots have closed to all but the last bit: without contacts it has to hold.
  options.any_angle = false;
  const Arrival apart = search(plan_case, agent, kept_apart(traffic), options);
  require_twins(!apart.found || (any_angle.found && any_angle.arrival_s <= apart.arrival_s + kArrivalS),
                "any-angle arrives later than moves between neighbours");
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const auto plan_case = fuzz::read_case(data, size);
  if (!plan_case) return -1;
  if (plan_case->instance.agents.empty()) return 0;
  const AgentIndex agent = plan_case->options.seed % plan_case->instance.agents.size();
  const Traffic traffic = traffic_around(*plan_case, agent);
  check_departures(plan_case->instance, plan_case->instance.agents[agent], traffic);
  check_safe_intervals(plan_case->instance, plan_case->instance.agents[agent], traffic);
  check_searches(*plan_case, agent, traffic);
  return 0;
}
