// What plans cost and what bounds them, by formulas of this file: sums and ties of objectives, gaps, lower
// bounds where the work for them is given up, and which robots a rule of improvement takes out of a plan.
#include <rapidcheck.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>
#include <optional>
#include <set>
#include <vector>

#include "planner/core/random.hpp"
#include "planner/grid/line_of_sight.hpp"
#include "planner/improve/attempt.hpp"
#include "planner/improve/neighbourhoods.hpp"
#include "planner/improve/objective.hpp"
#include "planner/improve/static_times.hpp"
#include "planner/solve/plan.hpp"
#include "property_tests/support/encounters.hpp"
#include "property_tests/support/generators.hpp"
#include "property_tests/support/property.hpp"
#include "sipplab/prioritized_planner.hpp"

namespace sipplab::objectives_laws {
namespace {

/// Each draws many times.
constexpr int kFewer = kCasesOfWorlds / 10;

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

/// A plan in repair, all of its robots planned.
struct InRepair {
  PlanCase plan_case;
  Solution solution;
  PriorityOrder order;
  std::unique_ptr<SingleAgentPlanner> planner;
  std::unique_ptr<PartialPlan> plan;
  std::vector<Trajectory> fastest_paths;
  std::vector<double> static_times_s;

  const Instance& instance() const { return plan_case.instance; }
  Neighbours neighbours() const { return {plan_case.instance, *plan, static_times_s, fastest_paths}; }
};

/// Fills in what follows from case, solution and order.
std::unique_ptr<InRepair> completed(std::unique_ptr<InRepair> repaired) {
  const Instance& instance = repaired->instance();
  repaired->planner = single_agent_planner(instance, repaired->plan_case.options);
  repaired->plan = std::make_unique<PartialPlan>(instance, 0, *repaired->planner);
  for (const AgentIndex agent : repaired->order) {
    repaired->plan->insert(agent, repaired->solution.trajectories[agent]);
  }
  PartialPlan nobody(instance, 0, *repaired->planner);
  for (AgentIndex agent = 0; agent < instance.agents.size(); ++agent) {
    SearchStatistics work;
    auto alone = nobody.find(agent, {}, work);
    repaired->fastest_paths.push_back(alone ? *alone : repaired->solution.trajectories[agent]);
    repaired->static_times_s.push_back(distance(instance.agents[agent].start, instance.agents[agent].goal) /
                                       instance.agents[agent].speed_cells_per_s);
  }
  return repaired;
}

std::unique_ptr<InRepair> any_in_repair() {
  auto repaired = std::make_unique<InRepair>();
  repaired->plan_case = *any_case();
  PlannerOptions& options = repaired->plan_case.options;
  options.rescheduling = Rescheduling::kEjection;
  options.max_restarts = 40;
  options.ssi_s = 0;
  const Instance& instance = repaired->instance();
  RC_PRE(instance.agents.size() >= 2u);
  note_case(repaired->plan_case);
  const PlanResult result = plan(instance, options);
  RC_PRE(result.status == PlanStatus::kSolved);
  repaired->solution = result.solution;
  repaired->order = result.order();
  return completed(std::move(repaired));
}

/// Robots that go to and fro in rows of their own, with long rests in between.
std::unique_ptr<InRepair> any_in_rows() {
  constexpr std::int32_t kWidth = 30;
  constexpr std::int32_t kHeight = 10;
  auto repaired = std::make_unique<InRepair>();
  Instance& instance = repaired->plan_case.instance;
  instance.map = GridMap(kWidth, kHeight);
  std::vector<std::int32_t> rows(kHeight);
  std::iota(rows.begin(), rows.end(), 0);
  Random random(*rc::gen::arbitrary<std::uint64_t>());
  random.shuffle(rows);
  rows.resize(2 + random.below(7));
  for (const std::int32_t row : rows) {
    const auto any_place = [&] { return Cell{static_cast<std::int32_t>(random.below(kWidth)), row}; };
    Trajectory trajectory{any_place(), {}};
    for (auto legs = random.below(4); legs > 0; --legs) {
      const double now_s = trajectory.end_s();
      const Cell here = trajectory.end();
      const double until_s = now_s + 1 + static_cast<double>(random.below(12));
      trajectory.motions.push_back({now_s, until_s, here, here});
      const Cell next = any_place();
      if (next == here) continue;
      trajectory.motions.push_back({until_s, until_s + distance(here, next), here, next});
    }
    repaired->order.push_back(instance.agents.size());
    Agent& agent = instance.agents.emplace_back();
    agent.start = trajectory.start;
    agent.goal = trajectory.end();
    repaired->solution.trajectories.push_back(std::move(trajectory));
  }
  return completed(std::move(repaired));
}

/// A box around where a robot is at some time near `time_s`.
bool comes_near(const Trajectory& trajectory, Vec2 place, double time_s, double window_s, double cells) {
  const auto is_near = [&](Cell from, Cell to) {
    return std::min(from.x, to.x) - cells <= place.x && place.x <= std::max(from.x, to.x) + cells &&
           std::min(from.y, to.y) - cells <= place.y && place.y <= std::max(from.y, to.y) + cells;
  };
  for (const TimedMotion& motion : trajectory.motions) {
    if (motion.begin_s <= time_s + window_s && motion.end_s >= time_s - window_s &&
        is_near(motion.from, motion.to)) {
      return true;
    }
  }
  return trajectory.end_s() <= time_s + window_s && is_near(trajectory.end(), trajectory.end());
}

Vec2 place_at(const Trajectory& trajectory, double time_s) {
  for (const TimedMotion& motion : trajectory.motions) {
    if (time_s > motion.end_s || motion.end_s <= motion.begin_s) continue;
    const double share = (time_s - motion.begin_s) / (motion.end_s - motion.begin_s);
    return centre(motion.from) + (centre(motion.to) - centre(motion.from)) * share;
  }
  return centre(trajectory.end());
}

struct WindowChances {
  std::vector<double> of;  ///< by robot: to be chosen beside the first
  double nobody = 0;       ///< that nobody is near: then any may be chosen
};

/// For a moment of the first one's way, drawn uniformly.
WindowChances window_chances(const std::vector<Trajectory>& trajectories, AgentIndex first) {
  constexpr double kWindowCells = 3;
  constexpr double kHalfWindowS = 3;
  constexpr int kMoments = 500;
  WindowChances chances{std::vector<double>(trajectories.size(), 0)};
  for (int i = 0; i < kMoments; ++i) {
    const double time_s = arrival_of(trajectories[first]) * (i + 0.5) / kMoments;
    const Vec2 place = place_at(trajectories[first], time_s);
    std::vector<AgentIndex> near;
    for (AgentIndex other = 0; other < trajectories.size(); ++other) {
      if (other != first && comes_near(trajectories[other], place, time_s, kHalfWindowS, kWindowCells)) {
        near.push_back(other);
      }
    }
    if (near.empty()) chances.nobody += 1.0 / kMoments;
    for (const AgentIndex other : near)
      chances.of[other] += 1.0 / kMoments / static_cast<double>(near.size());
  }
  return chances;
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

  passed &= property("cost_of: the cost of a plan in repair is that of its solution", [] {
    const auto repaired = any_in_repair();
    const PlanCost cost = cost_of(repaired->instance(), *repaired->plan);
    double flowtime = 0;
    double makespan = 0;
    for (const Trajectory& trajectory : repaired->solution.trajectories) {
      flowtime += arrival_of(trajectory);
      makespan = std::max(makespan, arrival_of(trajectory));
    }
    RC_ASSERT(std::abs(cost.flowtime_s - flowtime) <= kRounding * (1 + flowtime));
    RC_ASSERT(cost.makespan_s == makespan);
  });

  passed &= property("choose_neighbourhood: different robots, no more than asked for, by the rule", [] {
    const auto repaired = any_in_repair();
    const std::size_t robots = repaired->instance().agents.size();
    const auto rule = static_cast<RemovalRule>(*rc::gen::inRange(0, static_cast<int>(kRemovalRules)));
    const std::size_t most = *rc::gen::inRange<std::size_t>(1, 6);
    Random random(*rc::gen::arbitrary<std::uint64_t>());
    const std::vector<AgentIndex> chosen = choose_neighbourhood(rule, repaired->neighbours(), most, random);
    RC_TAG(std::string(name(rule)));
    RC_ASSERT(!chosen.empty());
    RC_ASSERT(chosen.size() == std::min(most, robots));
    RC_ASSERT(std::set<AgentIndex>(chosen.begin(), chosen.end()).size() == chosen.size());
    RC_ASSERT(*std::max_element(chosen.begin(), chosen.end()) < robots);
    const auto& trajectories = repaired->solution.trajectories;
    if (rule == RemovalRule::kLast) {
      constexpr std::size_t kLast = 5;
      std::size_t later = 0;  // of equal arrivals the first of the input counts as later
      for (AgentIndex agent = 0; agent < robots; ++agent) {
        const double one_s = arrival_of(trajectories[agent]);
        const double first_s = arrival_of(trajectories[chosen[0]]);
        later += one_s > first_s || (one_s == first_s && agent < chosen[0]);
      }
      RC_ASSERT(later < kLast);
    }
    if (rule == RemovalRule::kLast || rule == RemovalRule::kCrossing) {
      // Who is in the way comes before all others.
      const std::vector<AgentIndex> crossing =
          repaired->plan->conflicts(chosen[0], repaired->fastest_paths[chosen[0]]);
      for (std::size_t i = 1; i < chosen.size() && i <= crossing.size(); ++i) {
        RC_ASSERT(std::count(crossing.begin(), crossing.end(), chosen[i]) == 1);
      }
      RC_CLASSIFY(!crossing.empty(), "somebody in the way");
    }
  });

  passed &= property(
      "choose_neighbourhood: each of the last five begins, and no other",
      [] {
        const auto repaired = at_full_size(any_in_rows);
        const auto& trajectories = repaired->solution.trajectories;
        std::vector<AgentIndex> last = repaired->order;
        std::stable_sort(last.begin(), last.end(), [&](AgentIndex a, AgentIndex b) {
          return arrival_of(trajectories[a]) > arrival_of(trajectories[b]);
        });
        last.resize(std::min<std::size_t>(last.size(), 5));
        Random random(*rc::gen::arbitrary<std::uint64_t>());
        std::set<AgentIndex> first;
        constexpr int kDraws = 120;  // the chance that one of five is not drawn is 1e-11
        for (int i = 0; i < kDraws; ++i) {
          first.insert(choose_neighbourhood(RemovalRule::kLast, repaired->neighbours(), 1, random).front());
        }
        RC_ASSERT(first == std::set<AgentIndex>(last.begin(), last.end()));
      },
      kFewer);

  passed &= property(
      "choose_neighbourhood: in a window is who is near at a moment drawn, as often as that",
      [] {
        const auto repaired = at_full_size(any_in_rows);
        const auto& trajectories = repaired->solution.trajectories;
        const std::size_t robots = trajectories.size();
        // By pairs: how often the second was chosen with the first.
        std::vector<std::vector<double>> chosen(robots, std::vector<double>(robots, 0));
        std::vector<double> draws(robots, 0);
        Random random(*rc::gen::arbitrary<std::uint64_t>());
        constexpr int kDraws = 1500;
        for (int i = 0; i < kDraws; ++i) {
          const auto both = choose_neighbourhood(RemovalRule::kWindow, repaired->neighbours(), 2, random);
          ++draws[both.at(0)];
          ++chosen[both[0]][both.at(1)];
        }
        for (AgentIndex first = 0; first < robots; ++first) {
          const WindowChances chances = window_chances(trajectories, first);
          const double tolerance = 3.5 * std::sqrt(draws[first]) + 0.03 * draws[first];  // seven deviations
          for (AgentIndex other = 0; other < robots; ++other) {
            const double least = chances.of[other] * draws[first];
            RC_ASSERT(chosen[first][other] >= least - tolerance);
            RC_ASSERT(chosen[first][other] <= least + chances.nobody * draws[first] + tolerance);
          }
          RC_CLASSIFY(chances.nobody < 0.5 && draws[first] > 200, "windows with others, often drawn");
        }
      },
      kFewer);

  passed &= property("RuleRoulette: favours the rule that gains, gives up none, and knows no unit", [] {
    const auto winner = static_cast<RemovalRule>(*rc::gen::inRange(0, static_cast<int>(kRemovalRules)));
    const double gain = *any_of({1.0, 1e-6, 1e6});
    RuleRoulette roulette;
    RuleRoulette same;
    constexpr int kLessons = 400;
    for (int i = 0; i < kLessons; ++i) {
      for (std::size_t rule = 0; rule < kRemovalRules; ++rule) {
        const bool wins = static_cast<RemovalRule>(rule) == winner;
        roulette.learn(rule, wins ? gain : 0, 1);
        same.learn(rule, wins ? 1 : 0, 1);
      }
    }
    const auto seed = *rc::gen::arbitrary<std::uint64_t>();
    Random random(seed);
    Random again(seed);
    std::array<int, kRemovalRules> drawn{};
    constexpr int kDraws = 400;
    for (int i = 0; i < kDraws; ++i) {
      const std::size_t rule = roulette.draw(random);
      ++drawn[rule];
      RC_ASSERT(rule == same.draw(again));
    }
    for (std::size_t rule = 0; rule < kRemovalRules; ++rule) {
      if (static_cast<RemovalRule>(rule) == winner) {
        RC_ASSERT(drawn[rule] > kDraws / 2);
      } else {
        RC_ASSERT(drawn[rule] > 0);
      }
    }
  });

  passed &= property(
      "Roulette: of equal gains for their work, draws of k times the work are rarer by the root of k", [] {
        const double times = *any_of({1.0, 4.0, 16.0, 64.0});
        const double worth = *any_of({1.0, 0.5, 0.25});  // of the one with more work
        const double unit = *any_of({1.0, 1e-3, 1e6});
        Roulette<2> roulette;
        constexpr int kLessons = 400;
        for (int i = 0; i < kLessons; ++i) {
          roulette.learn(0, 1, unit);
          roulette.learn(1, worth * times, times * unit);
        }
        Random random(*rc::gen::arbitrary<std::uint64_t>());
        constexpr int kDraws = 4000;
        int drawn = 0;
        for (int i = 0; i < kDraws; ++i) drawn += static_cast<int>(roulette.draw(random));
        const double weight = worth / std::sqrt(times);
        const double expected = kDraws * weight / (1 + weight);
        RC_ASSERT(std::abs(drawn - expected) < 7 * std::sqrt(expected));  // seven deviations
      });

  return passed;
});

}  // namespace
}  // namespace sipplab::objectives_laws
