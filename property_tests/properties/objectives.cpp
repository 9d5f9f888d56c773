// What plans cost and what bounds them, by formulas of this file: sums and ties of objectives, gaps, and
// lower bounds where the work for them is given up.
#include <rapidcheck.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>
#include <vector>

#include "planner/grid/line_of_sight.hpp"
#include "planner/improve/objective.hpp"
#include "planner/improve/static_times.hpp"
#include "planner/solve/plan.hpp"
#include "property_tests/support/generators.hpp"
#include "property_tests/support/property.hpp"
#include "sipplab/prioritized_planner.hpp"

namespace sipplab::objectives_laws {
namespace {

/// Seconds or cells: rounding of sums.
constexpr double kRounding = 1e-9;

/// When a robot has moved and turned for the last time.
double arrival_of(const Trajectory& trajectory) {
  double arrival_s = 0;
  for (const TimedMotion& motion : trajectory.motions) {
    const bool changes = motion.from.x != motion.to.x || motion.from.y != motion.to.y;
    if (changes || motion.turn_to_deg) arrival_s = motion.end_s;
  }
  return arrival_s;
}

/// Which of two is less, the first difference decides.
bool comes_first(const std::array<double, 3>& one, const std::array<double, 3>& other) {
  for (std::size_t i = 0; i < one.size(); ++i) {
    if (one[i] != other[i]) return one[i] < other[i];
  }
  return false;
}

/// Lengths of the shortest ways of straight sections (Bellman 1958); kForever if there is none.
double shortest_way(const GridMap& map, const LineOfSight& sight, Cell from, Cell to) {
  std::vector<double> paths(map.cell_count(), kForever);
  paths[map.index(from)] = 0;
  for (bool changed = true; changed;) {
    changed = false;
    for (std::size_t a = 0; a < paths.size(); ++a) {
      if (paths[a] == kForever) continue;
      for (std::size_t b = 0; b < paths.size(); ++b) {
        const double path = paths[a] + distance(map.cell(a), map.cell(b));
        if (path >= paths[b] - kRounding || !sight.is_legal(map.cell(b))) continue;
        if (!sight.is_clear(map.cell(a), map.cell(b))) continue;
        paths[b] = path;
        changed = true;
      }
    }
  }
  return paths[map.index(to)];
}

/// Robots of all sizes on small maps with many walls.
PlanCase any_walled_case() {
  PlanCase plan_case = *any_case();
  RC_PRE(plan_case.instance.map.cell_count() <= 64u);
  note_case(plan_case);
  return plan_case;
}

/// Columns for rows.
PlanCase turned(const PlanCase& plan_case) {
  PlanCase turned = plan_case;
  const GridMap& map = plan_case.instance.map;
  turned.instance.map = GridMap(map.height(), map.width());
  for (std::size_t i = 0; i < map.cell_count(); ++i) {
    const Cell cell = map.cell(i);
    turned.instance.map.set_blocked({cell.y, cell.x}, map.is_blocked(cell));
  }
  for (Agent& agent : turned.instance.agents) {
    agent.start = {agent.start.y, agent.start.x};
    agent.goal = {agent.goal.y, agent.goal.x};
  }
  return turned;
}

/// A wall between start and goal with one way around its end, far aside of the straight line.
PlanCase any_long_wall() {
  constexpr std::int32_t kWidth = 9;
  constexpr std::int32_t kHeight = 11;
  PlanCase plan_case;
  plan_case.instance.map = GridMap(kWidth, kHeight);
  const std::int32_t column = *rc::gen::inRange(2, kWidth - 2);
  const std::int32_t thickness = *rc::gen::inRange(1, 3);
  const std::int32_t end = *rc::gen::inRange(1, kHeight - 1);
  for (std::int32_t y = 0; y < end; ++y) {
    for (std::int32_t x = column; x < std::min(column + thickness, kWidth - 1); ++x) {
      plan_case.instance.map.set_blocked({x, y}, true);
    }
  }
  Agent agent;
  agent.start = {*rc::gen::inRange(0, column), *rc::gen::inRange(0, kHeight)};
  agent.goal = {*rc::gen::inRange(std::min(column + thickness, kWidth - 1), kWidth),
                *rc::gen::inRange(0, kHeight)};
  agent.radius_cells = *any_of({0.5, 0.25});
  plan_case.instance.agents = {agent};
  if (*rc::gen::arbitrary<bool>()) plan_case = turned(plan_case);
  note_case(plan_case);
  return plan_case;
}

/// Free cells on a diagonal that bends once, and a body that fits between the walls only in their centres:
/// it has a way of two straight lines, and no steps to four neighbours.
PlanCase any_diagonal_lane() {
  PlanCase plan_case;
  const std::int32_t down = *rc::gen::inRange(1, 5);
  const std::int32_t up = *rc::gen::inRange(1, 5);
  const std::int32_t margin = 1;
  plan_case.instance.map = GridMap(down + up + 1 + 2 * margin, std::max(down, up) + 1 + 2 * margin);
  GridMap& map = plan_case.instance.map;
  const std::int32_t bottom = map.height() - 1 - margin;
  const auto row = [&](std::int32_t i) { return bottom - std::abs(i - down); };
  for (std::size_t i = 0; i < map.cell_count(); ++i) map.set_blocked(map.cell(i), true);
  for (std::int32_t i = 0; i <= down + up; ++i) {
    for (const Cell beside : {Cell{0, 0}, Cell{1, 0}, Cell{-1, 0}, Cell{0, 1}, Cell{0, -1}}) {
      map.set_blocked({margin + i + beside.x, row(i) + beside.y}, false);
    }
  }
  Agent agent;
  agent.start = {margin, row(0)};
  agent.goal = {margin + down + up, row(down + up)};
  agent.radius_cells = 0.7;  // less than half the diagonal of a cell, more than half its side
  plan_case.instance.agents = {agent};
  note_case(plan_case);
  return plan_case;
}

const PropertyRoom room("objectives", [] {
  bool passed = true;

  passed &= property("flowtime is the sum of arrivals, makespan the latest; objectives weigh them", [] {
    Scene scene = *any_scene();
    for (Trajectory& trajectory : scene.solution.trajectories) {
      if (*rc::gen::arbitrary<bool>()) {
        const double now_s = trajectory.end_s();
        trajectory.motions.push_back({now_s, now_s + 2, trajectory.end(), trajectory.end()});
      }
      if (*rc::gen::inRange(0, 3) == 0) {
        const double now_s = trajectory.end_s();
        trajectory.motions.push_back({now_s, now_s + 1, trajectory.end(), trajectory.end(), 90.0});
      }
    }
    double flowtime = 0;
    double makespan = 0;
    for (const Trajectory& trajectory : scene.solution.trajectories) {
      flowtime += arrival_of(trajectory);
      makespan = std::max(makespan, arrival_of(trajectory));
      RC_ASSERT(trajectory.arrival_s() == arrival_of(trajectory));
    }
    RC_ASSERT(std::abs(flowtime_s(scene.solution) - flowtime) <= kRounding * std::max(1.0, flowtime));
    RC_ASSERT(makespan_s(scene.solution) == makespan);
    const Objective objective{*any_of({1.0, 0.0, 3.0}), *any_of({20.0, 1.0, 0.0})};
    RC_ASSERT(objective.of(flowtime, makespan) ==
              objective.flowtime_weight * flowtime + objective.makespan_weight * makespan);
  });

  passed &= property("is_better: less by the objective, then less flowtime, then less makespan", [] {
    const Objective objective = *rc::gen::element(Objective{1, 0}, Objective{0, 1}, Objective{1, 1},
                                                  Objective{1, 2}, Objective{2, 1});
    const auto any_cost = [] {
      return PlanCost{static_cast<double>(*rc::gen::inRange(0, 6)),
                      static_cast<double>(*rc::gen::inRange(0, 4))};
    };
    const auto key = [&](const PlanCost& cost) {
      return std::array<double, 3>{
          objective.flowtime_weight * cost.flowtime_s + objective.makespan_weight * cost.makespan_s,
          cost.flowtime_s, cost.makespan_s};
    };
    const PlanCost one = any_cost();
    const PlanCost other = any_cost();
    RC_ASSERT(is_better(objective, one, other) == comes_first(key(one), key(other)));
    RC_CLASSIFY(key(one)[0] == key(other)[0], "ties");
  });

  passed &= property("gap: the share of a cost that is above its bound", [] {
    const double bound = *rc::gen::inRange(0, 40) / 8.0;
    const double cost = *rc::gen::inRange(0, 80) / 8.0;
    RC_ASSERT(gap(cost, bound) == (cost > bound ? (cost - bound) / cost : 0));
  });

  passed &= property("a way's bound that is given up is a bound: straight <= bound <= shortest", [] {
    const PlanCase plan_case = any_walled_case();
    const Instance& instance = plan_case.instance;
    RC_PRE(!instance.agents.empty());
    const Agent& agent = instance.agents[*rc::gen::inRange<AgentIndex>(0, instance.agents.size())];
    const LineOfSight sight(instance.map, agent.radius_cells);
    const double shortest = shortest_way(instance.map, sight, agent.start, agent.goal);
    RC_PRE(shortest < kForever);
    const double straight = distance(agent.start, agent.goal);
    const double longest = shortest * *any_of({1.0, 1.25, 3.0});
    const std::size_t work = *rc::gen::element<std::size_t>(0, 1, 10, 30, 60, 100, 200, 400);
    const double bound =
        shortest_any_angle_cells(instance.map, sight, agent.start, agent.goal, longest, work);
    RC_ASSERT(bound >= straight - kRounding);
    RC_ASSERT(bound <= shortest + kRounding);
    // Bounds grow with the work for them.
    RC_ASSERT(bound <=
              shortest_any_angle_cells(instance.map, sight, agent.start, agent.goal, longest) + kRounding);
    RC_CLASSIFY(shortest > straight + kRounding, "round a corner");
    RC_CLASSIFY(bound < shortest - kRounding, "given up");
  });

  passed &= property("a way's bound is the shortest way, however far aside that bends", [] {
    const PlanCase plan_case = at_full_size(any_long_wall);
    const Instance& instance = plan_case.instance;
    const Agent& agent = instance.agents.front();
    const LineOfSight sight(instance.map, agent.radius_cells);
    const double shortest = shortest_way(instance.map, sight, agent.start, agent.goal);
    RC_PRE(shortest < kForever);
    RC_CLASSIFY(shortest > 1.1 * distance(agent.start, agent.goal), "far aside");
    for (const double longer : {1.0, 1.001, 1.03, 1.2}) {
      const double bound =
          shortest_any_angle_cells(instance.map, sight, agent.start, agent.goal, longer * shortest);
      RC_ASSERT(std::abs(bound - shortest) <= kRounding);
    }
  });

  passed &=
      property("a large body that has a way and no steps has its bound, without a way a straight one", [] {
        PlanCase plan_case = at_full_size(any_diagonal_lane);
        Instance& instance = plan_case.instance;
        const Agent& agent = instance.agents.front();
        const LineOfSight sight(instance.map, agent.radius_cells);
        RC_ASSERT(shortest_grid_cells(instance.map, sight, agent.start, agent.goal, 2) == kForever);
        const double shortest = shortest_way(instance.map, sight, agent.start, agent.goal);
        RC_ASSERT(std::abs(lower_bound(instance, true, 2).makespan_s - shortest) <= kRounding);
        const double straight = distance(agent.start, agent.goal);
        RC_ASSERT(std::abs(lower_bound(instance, false, 2).makespan_s - straight) <= kRounding);
      });

  passed &=
      property("lower bounds of an instance: of the shortest ways, or straight where that is too much", [] {
        const PlanCase plan_case = any_walled_case();
        const Instance& instance = plan_case.instance;
        const bool any_angle = *rc::gen::arbitrary<bool>();
        const int k = plan_case.options.connectedness;
        LowerBound straight;
        LowerBound shortest;
        bool all_have_ways = true;
        for (const Agent& agent : instance.agents) {
          const double blocks =
              std::abs(agent.start.x - agent.goal.x) + std::abs(agent.start.y - agent.goal.y);
          const double line = distance(agent.start, agent.goal);
          const LineOfSight sight(instance.map, agent.radius_cells);
          const double path = any_angle
                                  ? shortest_way(instance.map, sight, agent.start, agent.goal)
                                  : shortest_grid_cells(instance.map, sight, agent.start, agent.goal, k);
          all_have_ways = all_have_ways && path < kForever;
          if (!any_angle && k == 2) RC_ASSERT(path >= blocks - kRounding);
          const double straight_s = (any_angle || k > 2 ? line : blocks) / agent.speed_cells_per_s;
          straight.flowtime_s += straight_s;
          straight.makespan_s = std::max(straight.makespan_s, straight_s);
          shortest.flowtime_s += path / agent.speed_cells_per_s;
          shortest.makespan_s = std::max(shortest.makespan_s, path / agent.speed_cells_per_s);
        }
        RC_PRE(all_have_ways);
        const LowerBound ample = lower_bound(instance, any_angle, k);
        RC_ASSERT(std::abs(ample.flowtime_s - shortest.flowtime_s) <= kRounding * (1 + shortest.flowtime_s));
        RC_ASSERT(std::abs(ample.makespan_s - shortest.makespan_s) <= kRounding * (1 + shortest.makespan_s));
        RC_CLASSIFY(shortest.flowtime_s > straight.flowtime_s + kRounding, "round corners");
        // Too little work for any, or for all that it takes.
        for (const std::size_t work : {std::size_t{0}, instance.map.cell_count() * instance.agents.size()}) {
          const LowerBound cheap = lower_bound(instance, any_angle, k, work);
          RC_ASSERT(cheap.flowtime_s >= straight.flowtime_s - kRounding);
          RC_ASSERT(cheap.makespan_s >= straight.makespan_s - kRounding);
          RC_ASSERT(cheap.flowtime_s <= shortest.flowtime_s + kRounding * (1 + shortest.flowtime_s));
          RC_ASSERT(cheap.makespan_s <= shortest.makespan_s + kRounding * (1 + shortest.makespan_s));
          if (work > 0 || instance.agents.empty() || (!any_angle && k > 2)) continue;
          RC_ASSERT(std::abs(cheap.flowtime_s - straight.flowtime_s) <=
                    kRounding * (1 + straight.flowtime_s));
        }
      });

  passed &= property("static times are divided by speeds, and below what is given", [] {
    const PlanCase plan_case = any_walled_case();
    const Instance& instance = plan_case.instance;
    std::vector<double> paths;
    for (const Agent& agent : instance.agents) {
      const LineOfSight sight(instance.map, agent.radius_cells);
      paths.push_back(shortest_way(instance.map, sight, agent.start, agent.goal));
      RC_PRE(paths.back() < kForever);
    }
    const std::vector<double> times_s = static_times_s(instance, true, 2, paths);
    RC_ASSERT(times_s.size() == paths.size());
    for (std::size_t i = 0; i < paths.size(); ++i) {
      RC_ASSERT(std::abs(times_s[i] - paths[i] / instance.agents[i].speed_cells_per_s) <=
                kRounding * (1 + times_s[i]));
    }
    const std::vector<double> given_up_s = static_times_s(instance, true, 2, paths, {}, 0);
    for (std::size_t i = 0; i < paths.size(); ++i) {
      RC_ASSERT(given_up_s[i] <= paths[i] / instance.agents[i].speed_cells_per_s + kRounding);
    }
    const LowerBound bound = lower_bound(given_up_s);
    RC_ASSERT(bound.flowtime_s == std::accumulate(given_up_s.begin(), given_up_s.end(), 0.0));
    RC_ASSERT(bound.makespan_s ==
              (given_up_s.empty() ? 0 : *std::max_element(given_up_s.begin(), given_up_s.end())));
  });

  return passed;
});

}  // namespace
}  // namespace sipplab::objectives_laws
