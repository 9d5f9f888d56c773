// The rules of an instance against the slow and obvious model: every body against every
// other and against every blocked cell. Radii in eighths, so that contact is exact.
#include <rapidcheck.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstdlib>
#include <functional>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "planner/instance/disk_lookup.hpp"
#include "planner/instance/reachability.hpp"
#include "property_tests/support/encounters.hpp"
#include "property_tests/support/generators.hpp"
#include "property_tests/support/property.hpp"
#include "sipplab/instance.hpp"
#include "sipplab/solution.hpp"

namespace sipplab::instance_rules_laws {
namespace {

constexpr std::int64_t kParts = 8;  // of a cell

struct Body {
  Cell cell;
  std::int64_t eighths = 4;  ///< radius
};

bool bodies_overlap(const Body& a, const Body& b) {
  const std::int64_t dx = kParts * (a.cell.x - b.cell.x);
  const std::int64_t dy = kParts * (a.cell.y - b.cell.y);
  const std::int64_t reach = a.eighths + b.eighths;
  return dx * dx + dy * dy < reach * reach;
}

/// Whether the disk leaves the grid or overlaps a blocked square.
bool stands_badly(const GridMap& map, const Body& body) {
  const auto gap = [](std::int64_t cells) {
    return std::max<std::int64_t>(0, kParts * std::abs(cells) - kParts / 2);
  };
  // The grid is surrounded by blocked cells as far as any body reaches.
  const auto beyond = static_cast<std::int32_t>(body.eighths / kParts + 2);
  for (std::int32_t y = -beyond; y < map.height() + beyond; ++y) {
    for (std::int32_t x = -beyond; x < map.width() + beyond; ++x) {
      if (map.contains({x, y}) && !map.is_blocked({x, y})) continue;
      const std::int64_t dx = gap(x - body.cell.x);
      const std::int64_t dy = gap(y - body.cell.y);
      if (dx * dx + dy * dy < body.eighths * body.eighths) return true;
    }
  }
  return false;
}

bool any_bad(const GridMap& map, const std::vector<Body>& bodies) {
  for (std::size_t i = 0; i < bodies.size(); ++i) {
    if (stands_badly(map, bodies[i])) return true;
    for (std::size_t j = 0; j < i; ++j) {
      if (bodies_overlap(bodies[i], bodies[j])) return true;
    }
  }
  return false;
}

/// Robots anywhere; about half of the instances keep all rules.
Instance any_robots(std::vector<Body>& starts, std::vector<Body>& goals) {
  Instance instance;
  instance.map = GridMap(*rc::gen::inRange(1, 24), *rc::gen::inRange(1, 24));
  const auto cell = [&] {
    return Cell{*rc::gen::inRange(0, instance.map.width()), *rc::gen::inRange(0, instance.map.height())};
  };
  const int blocked = *rc::gen::inRange(0, 4);
  for (int i = 0; i < blocked; ++i) instance.map.set_blocked(cell(), true);
  const int robots = *rc::gen::inRange(1, 24);
  for (int i = 0; i < robots; ++i) {
    const std::int64_t eighths = *rc::gen::element<std::int64_t>(1, 2, 3, 4, 4, 4, 4, 6, 8, 12, 20);
    Agent agent;
    agent.id = std::to_string(i);
    agent.radius_cells = static_cast<double>(eighths) / kParts;
    const Body start{cell(), eighths};
    const Body goal{cell(), eighths};
    // A robot that does not fit is left out, three times in four.
    const bool keep = *rc::gen::inRange(0, 40) == 0;
    std::vector<Body> with_start = starts;
    std::vector<Body> with_goal = goals;
    with_start.push_back(start);
    with_goal.push_back(goal);
    if (!keep && (any_bad(instance.map, with_start) || any_bad(instance.map, with_goal))) continue;
    agent.start = start.cell;
    agent.goal = goal.cell;
    instance.agents.push_back(agent);
    starts = with_start;
    goals = with_goal;
  }
  return instance;
}

/// One large body among many small ones, on a map on which buckets by size pay.
void large_among_small() {
  Instance instance;
  instance.map = GridMap(64, 64);
  std::vector<Body> starts;
  const auto add = [&](Cell cell, std::int64_t eighths) {
    Agent& agent = instance.agents.emplace_back();
    agent.radius_cells = static_cast<double>(eighths) / kParts;
    agent.start = cell;
    // All goals far from each other, and none in question.
    agent.goal = eighths > 4 ? Cell{58, 58}
                             : Cell{static_cast<std::int32_t>(starts.size()) % 64,
                                    static_cast<std::int32_t>(starts.size()) / 64};
    starts.push_back({cell, eighths});
  };
  const std::int64_t large = *rc::gen::inRange<std::int64_t>(8, 40);
  add({*rc::gen::inRange(6, 58), *rc::gen::inRange(20, 58)}, large);
  const Cell middle = starts.front().cell;
  // A field of small robots, without a hole of about the large one's size.
  const std::int64_t hole = large + 4 + *rc::gen::inRange<std::int64_t>(-8, 24);
  for (std::int32_t y = middle.y - 5; y <= middle.y + 5; ++y) {
    for (std::int32_t x = middle.x - 6; x <= middle.x + 5; ++x) {
      const std::int64_t dx = kParts * (x - middle.x);
      const std::int64_t dy = kParts * (y - middle.y);
      if (dx * dx + dy * dy >= hole * hole) add({x, y}, 4);
    }
  }
  bool bad = false;
  for (std::size_t i = 1; i < starts.size(); ++i) bad = bad || bodies_overlap(starts[0], starts[i]);
  RC_CLASSIFY(bad, "bad");
  RC_ASSERT(find_error(instance).has_value() == bad);
}

/// Many disks of all sizes, asked for one by one: enough of each size that buckets pay.
void least_overlap_of_many() {
  constexpr std::int32_t kSide = 96;
  const auto any_body = [] {
    return Body{*any_cell(kSide, kSide), *rc::gen::element<std::int64_t>(2, 4, 4, 12, 20, 40, 60, 200)};
  };
  std::vector<Body> bodies;
  DiskLookup lookup;
  const auto count = *rc::gen::inRange<std::size_t>(0, 120);
  for (std::size_t id = 0; id < count; ++id) {
    bodies.push_back(any_body());
    lookup.add(id, bodies[id].cell, static_cast<double>(bodies[id].eighths) / kParts);
  }
  const Body asking = any_body();
  std::optional<std::size_t> expected;
  for (std::size_t id = count; id-- > 0;) {
    if (bodies_overlap(bodies[id], asking)) expected = id;
  }
  RC_CLASSIFY(expected.has_value(), "some overlap");
  RC_ASSERT(lookup.find_overlap(asking.cell, static_cast<double>(asking.eighths) / kParts) == expected);
}

/// Whether a chain of free 4-neighbours joins the two.
bool joined(const GridMap& map, Cell from, Cell to) {
  std::vector<bool> seen(map.cell_count(), false);
  std::vector<Cell> ahead{from};
  seen[map.index(from)] = true;
  while (!ahead.empty()) {
    const Cell cell = ahead.back();
    ahead.pop_back();
    if (cell == to) return true;
    for (const Cell step : {Cell{1, 0}, Cell{-1, 0}, Cell{0, 1}, Cell{0, -1}}) {
      const Cell next{cell.x + step.x, cell.y + step.y};
      if (!map.contains(next) || map.is_blocked(next) || seen[map.index(next)]) continue;
      seen[map.index(next)] = true;
      ahead.push_back(next);
    }
  }
  return false;
}

void reachable_where_joined() {
  Instance instance;
  instance.map = GridMap(*rc::gen::inRange(1, 8), *rc::gen::inRange(1, 8));
  GridMap& map = instance.map;
  for (std::size_t i = 0; i < map.cell_count(); ++i) {
    map.set_blocked(map.cell(i), *rc::gen::inRange(0, 5) < 2);
  }
  Agent& agent = instance.agents.emplace_back();
  agent.start = {*rc::gen::inRange(0, map.width()), *rc::gen::inRange(0, map.height())};
  agent.goal = {*rc::gen::inRange(0, map.width()), *rc::gen::inRange(0, map.height())};
  agent.radius_cells = *rc::gen::element(0.5, 0.4, 0.25);
  map.set_blocked(agent.start, false);
  map.set_blocked(agent.goal, false);
  note_case({instance, {}});
  const bool reachable = joined(map, agent.start, agent.goal);
  RC_CLASSIFY(reachable, "reachable");
  RC_ASSERT(find_unreachable_goal(instance).has_value() == !reachable);
}

/// How many motions there are up to the last move or turn: what comes after are waits at the goal.
std::size_t motions_before_rest(const Trajectory& trajectory) {
  std::size_t count = 0;
  for (std::size_t i = 0; i < trajectory.motions.size(); ++i) {
    const TimedMotion& motion = trajectory.motions[i];
    if (motion.from != motion.to || motion.turn_to_deg) count = i + 1;
  }
  return count;
}

const PropertyRoom room("instance_rules", [] {
  bool passed = true;

  passed &= property("find_error: complains exactly where whole numbers do; touching is allowed", [] {
    std::vector<Body> starts;
    std::vector<Body> goals;
    const Instance instance = any_robots(starts, goals);
    note_case({instance, {}});
    const bool bad = any_bad(instance.map, starts) || any_bad(instance.map, goals);
    RC_CLASSIFY(bad, "bad");
    RC_CLASSIFY(instance.agents.size() > 10, "more than 10 robots");
    RC_ASSERT(find_error(instance).has_value() == bad);
  });

  passed &= property("find_error: a large body among many small ones overlaps where whole numbers say so",
                     [] { large_among_small(); });

  passed &= property("find_error: an obstacle begins wherever no start overlaps, touching allowed", [] {
    std::vector<Body> starts;
    std::vector<Body> goals;
    Instance instance = any_robots(starts, goals);
    RC_PRE(!any_bad(instance.map, starts) && !any_bad(instance.map, goals));
    const std::int64_t eighths = *rc::gen::element<std::int64_t>(2, 4, 8, 12, 20);
    const Body body{*any_cell(instance.map.width(), instance.map.height()), eighths};
    DynamicObstacle& obstacle = instance.obstacles.emplace_back();
    obstacle.radius_cells = static_cast<double>(eighths) / kParts;
    obstacle.trajectory.start = body.cell;
    note_case({instance, {}});
    const bool bad = std::any_of(starts.begin(), starts.end(),
                                 [&](const Body& start) { return bodies_overlap(start, body); });
    RC_CLASSIFY(bad, "bad");
    RC_ASSERT(find_error(instance).has_value() == bad);
  });

  passed &= property("find_overlap: the least disk of all that overlap, as asking each of them says",
                     [] { least_overlap_of_many(); });

  passed &= property("find_unreachable_goal: a slim robot reaches what free 4-neighbours join",
                     [] { reachable_where_joined(); });

  passed &= property("content_hash: equal for equal problems, one of its own for each change", [] {
    Instance instance = (*any_case()).instance;
    RC_PRE(!instance.agents.empty());
    instance.obstacles.push_back({"", 0.5, {{0, 0}, {{0, 1.5, {0, 0}, {1, 1}}}}});
    Instance same = instance;
    same.agents[0].id = "another name";
    RC_ASSERT(content_hash(same) == content_hash(instance));
    const auto which = *rc::gen::inRange<std::size_t>(0, instance.agents.size());
    const auto cell = *rc::gen::inRange<std::size_t>(0, instance.map.cell_count());
    using Motion = TimedMotion;
    const auto agent = [which](auto change) {
      return [which, change](Instance& other) { change(other.agents[which]); };
    };
    const auto obstacle = [](auto change) {
      return [change](Instance& other) { change(other.obstacles.back()); };
    };
    const auto motion = [](auto change) {
      return [change](Instance& other) { change(other.obstacles.back().trajectory.motions.back()); };
    };
    const std::vector<std::function<void(Instance&)>> changes = {
        agent([](Agent& it) { it.speed_cells_per_s *= 2; }),
        agent([](Agent& it) { it.radius_cells *= 2; }),
        agent([](Agent& it) { ++it.start.x; }),
        agent([](Agent& it) { ++it.start.y; }),
        agent([](Agent& it) { ++it.goal.x; }),
        agent([](Agent& it) { ++it.goal.y; }),
        agent([](Agent& it) { it.start_heading_deg += 1; }),
        agent([](Agent& it) { it.goal_heading_deg = 0; }),
        agent([](Agent& it) { it.goal_heading_deg = 90; }),
        agent([](Agent& it) { it.rotation_speed *= 2; }),
        agent([](Agent& it) {
          it.start = {it.start.y + 2, it.start.x};
        }),
        obstacle([](DynamicObstacle& it) { it.radius_cells *= 2; }),
        obstacle([](DynamicObstacle& it) { ++it.trajectory.start.x; }),
        motion([](Motion& it) { it.begin_s += 0.125; }),
        motion([](Motion& it) { it.end_s += 0.125; }),
        motion([](Motion& it) { ++it.from.x; }),
        motion([](Motion& it) { ++it.to.y; }),
        [](Instance& other) { other.agents.pop_back(); },
        [](Instance& other) { other.obstacles.pop_back(); },
        [](Instance& other) { other.obstacles.back().trajectory.motions.clear(); },
        [cell](Instance& other) {
          other.map.set_blocked(other.map.cell(cell), !other.map.is_blocked(other.map.cell(cell)));
        },
    };
    std::set<std::string> hashes = {content_hash(instance)};
    for (const auto& change : changes) {
      Instance other = instance;
      change(other);
      RC_ASSERT(hashes.insert(content_hash(other)).second);
    }
  });

  passed &= property("plan_hash: equal for equal plans, another for each change of the motion", [] {
    const Solution solution = (*any_scene()).solution;
    std::vector<std::size_t> moving;
    for (std::size_t i = 0; i < solution.trajectories.size(); ++i) {
      if (motions_before_rest(solution.trajectories[i]) > 0) moving.push_back(i);
    }
    RC_PRE(!moving.empty());
    const Solution same = solution;
    RC_ASSERT(plan_hash(same) == plan_hash(solution));
    const std::size_t which = *rc::gen::elementOf(moving);
    const auto at = *rc::gen::inRange<std::size_t>(0, motions_before_rest(solution.trajectories[which]));
    const auto changed = [&](auto change) {
      Solution other = solution;
      change(other.trajectories[which].motions[at]);
      return plan_hash(other) != plan_hash(solution);
    };
    // The next double after a time is another time.
    RC_ASSERT(changed([](TimedMotion& it) { it.begin_s = std::nextafter(it.begin_s, 1e9); }));
    RC_ASSERT(changed([](TimedMotion& it) { it.end_s = std::nextafter(it.end_s, 1e9); }));
    RC_ASSERT(changed([](TimedMotion& it) { ++it.from.y; }));
    RC_ASSERT(changed([](TimedMotion& it) { ++it.to.x; }));
    Solution other = solution;
    ++other.trajectories[which].start.x;
    RC_ASSERT(plan_hash(other) != plan_hash(solution));
    other = solution;
    other.trajectories.emplace_back();
    RC_ASSERT(plan_hash(other) != plan_hash(solution));
    other = solution;
    other.trajectories[which].motions.resize(motions_before_rest(solution.trajectories[which]) - 1);
    RC_ASSERT(plan_hash(other) != plan_hash(solution));
  });

  passed &= property("makespan is the latest arrival, flowtime the sum of all", [] {
    const Scene scene = *any_scene();
    double latest_s = 0;
    double sum_s = 0;
    for (const Trajectory& trajectory : scene.solution.trajectories) {
      const std::size_t count = motions_before_rest(trajectory);
      const double arrival_s = count == 0 ? 0 : trajectory.motions[count - 1].end_s;
      latest_s = std::max(latest_s, arrival_s);
      sum_s += arrival_s;
    }
    RC_ASSERT(makespan_s(scene.solution) == latest_s);
    RC_ASSERT(flowtime_s(scene.solution) == sum_s);
  });

  return passed;
});

}  // namespace
}  // namespace sipplab::instance_rules_laws
