// Every robot of every try against an exhaustive search for it alone, among the robots
// that were planned before it and the starts of those that were not. [AY18], section 3.
#include "planner/solve/plan.hpp"
#include "sipplab/prioritized_planner.hpp"

#include <rapidcheck.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <ostream>
#include <string>
#include <utility>
#include <vector>

#include "planner/core/tolerances.hpp"
#include "planner/search/sipp_search.hpp"
#include "property_tests/support/distance_oracle.hpp"
#include "property_tests/support/encounters.hpp"
#include "property_tests/support/exhaustive_search.hpp"
#include "property_tests/support/generators.hpp"
#include "property_tests/support/property.hpp"

namespace sipplab::prioritized_planning_laws {
namespace {

/// Seconds. Slacks at contacts add up along a path, 1e-9 to 1e-8 each; another path is
/// later or earlier by far more.
constexpr double kArrivalS = 1e-6;
/// Cells. At the very edge of the own goal's disk a path may be judged either way.
constexpr double kEdgeCells = 1e-6;

constexpr std::int32_t kWidth = 6;
constexpr std::int32_t kHeight = 5;
constexpr std::size_t kMostRobots = 5;
/// At any angle a case says less, and takes as long.
constexpr int kWorldsPerCase = 2;
constexpr int kAnyAngleWorldsPerCase = 1;

struct Rover {
  Cell start;
  Cell goal;
  int after = 0;  ///< not 0: the goal is beside the start of the robot so many further on
  Cell beside;    ///< by as many cells, less one
  Fraction radius;
  double speed = 1;
};

/// Robots on a small map. Those that break a rule of instances are left out.
struct World {
  std::vector<Cell> blocked;
  std::vector<Rover> rovers;
  std::vector<Walk> walks;
  PlannerOptions options;
};

std::ostream& operator<<(std::ostream& out, const Rover& rover) {
  return out << "(" << rover.start.x << ", " << rover.start.y << ") -> (" << rover.goal.x << ", "
             << rover.goal.y << ") or " << rover.after << " on, (" << rover.beside.x - 1 << ", "
             << rover.beside.y - 1 << ") beside, radius " << rover.radius.value() << " speed " << rover.speed;
}

rc::Gen<Fraction> any_fraction() {
  return any_of<Fraction>({{1, 2}, {1, 2}, {3, 4}, {1, 4}, {7, 10}, {1, 1}, {1, 1}});
}

rc::Gen<Rover> any_rover() {
  return rc::gen::build<Rover>(
      rc::gen::set(&Rover::start, any_cell(kWidth, kHeight)),
      rc::gen::set(&Rover::goal, any_cell(kWidth, kHeight)), rc::gen::set(&Rover::after, any_of({0, 1, 2})),
      rc::gen::set(&Rover::beside, any_cell(3, 3)), rc::gen::set(&Rover::radius, any_fraction()),
      rc::gen::set(&Rover::speed, any_of({1.0, 1.0, 0.5, 2.0})));
}

template <class Value>
rc::Gen<std::vector<Value>> up_to(std::size_t least, std::size_t most, const rc::Gen<Value>& any) {
  return rc::gen::mapcat(
      rc::gen::resize(rc::kNominalSize, rc::gen::inRange<std::size_t>(least, most + 1)),
      [any](std::size_t count) { return rc::gen::container<std::vector<Value>>(count, any); });
}

World any_world() {
  World world;
  world.blocked = *up_to(0, 3, any_cell(kWidth, kHeight));
  world.rovers = *up_to(3, kMostRobots, any_rover());
  world.walks = *up_to(0, 1, any_walk(kWidth, kHeight));
  PlannerOptions& options = world.options;
  options.order = static_cast<InitialOrder>(*rc::gen::inRange(0, 4));
  options.rescheduling = static_cast<Rescheduling>(*rc::gen::inRange(0, 3));
  options.ssi_s = *any_of({kInfiniteSsi, 0.0, 0.375, 1.0, 2.5, kInfiniteSsi, 6.125});
  options.connectedness = *any_of({2, 2, 3, 4});
  options.seed = *rc::gen::inRange<std::uint64_t>(0, 1000);
  options.max_restarts = 2;
  return world;
}

/// A wide robot fits nowhere at the border of the map: its places move inwards.
Cell moved_inwards(Cell cell, Fraction radius) {
  const std::int32_t margin = radius.value() > kDefaultRadiusCells ? 1 : 0;
  return {std::clamp(cell.x, margin, kWidth - 1 - margin), std::clamp(cell.y, margin, kHeight - 1 - margin)};
}

/// The case, and the radius of each of its robots as a fraction.
struct Posed {
  PlanCase plan_case;
  std::vector<Fraction> radii;
};

Posed posed(const World& world, bool any_angle) {
  Posed posed{{Instance{}, world.options}, {}};
  posed.plan_case.options.any_angle = any_angle;
  Instance& instance = posed.plan_case.instance;
  instance.map = GridMap(kWidth, kHeight);
  for (const Cell cell : world.blocked) instance.map.set_blocked(cell, true);
  for (std::size_t i = 0; i < world.rovers.size(); ++i) {
    const Rover& rover = world.rovers[i];
    Agent& agent = instance.agents.emplace_back();
    agent.id = std::to_string(i);
    agent.start = moved_inwards(rover.start, rover.radius);
    agent.goal = moved_inwards(rover.goal, rover.radius);
    if (rover.after > 0) {
      const Rover& other = world.rovers[(i + static_cast<std::size_t>(rover.after)) % world.rovers.size()];
      const Cell there = moved_inwards(other.start, other.radius);
      agent.goal = moved_inwards({there.x + rover.beside.x - 1, there.y + rover.beside.y - 1}, rover.radius);
    }
    agent.radius_cells = rover.radius.value();
    agent.speed_cells_per_s = rover.speed;
    posed.radii.push_back(rover.radius);
    if (!find_error(instance)) continue;
    instance.agents.pop_back();
    posed.radii.pop_back();
  }
  for (const Walk& walk : world.walks) {
    instance.obstacles.push_back({"", walk.radius, walk.trajectory()});
    if (find_error(instance)) instance.obstacles.pop_back();
  }
  return posed;
}

std::unique_ptr<SingleAgentPlanner> search_of(const PlanCase& plan_case) {
  const PlannerOptions& options = plan_case.options;
  const SippOptions search{options.any_angle, options.connectedness, 1, options.rules};
  if (options.rules.is_plain()) return std::make_unique<SippSearch>(plan_case.instance, search);
  return std::make_unique<TurningSearch>(plan_case.instance, search);
}

/// What was seen on the way, for classes.
struct Seen {
  int planned = 0;
  int failed = 0;
  int late = 0;      ///< a contact was not made use of
  int pardoned = 0;  ///< robots whose goal overlaps a start that is protected for ever
};

/// Plans as plan() does and compares each trajectory with the exhaustive search.
class ComparedSearch : public SingleAgentPlanner {
 public:
  explicit ComparedSearch(const Posed& posed)
      : posed_(posed),
        instance_(posed.plan_case.instance),
        options_(posed.plan_case.options),
        search_(search_of(posed.plan_case)),
        planned_(instance_.agents.size()) {}

  Expected<Trajectory, PlanFailure> plan(AgentIndex agent, Reservations& reservations,
                                         const SearchLimits& limits, SearchStatistics& statistics) override {
    const SearchStatistics before = statistics;
    auto trajectory = search_->plan(agent, reservations, limits, statistics);
    work_.expansions += statistics.expansions - before.expansions;
    work_.generations += statistics.generations - before.generations;
    std::optional<double> arrival_s;
    if (trajectory) arrival_s = trajectory->arrival_s();
    compare(agent, arrival_s);
    ++(trajectory ? seen_.planned : seen_.failed);
    if (trajectory) {
      planned_[agent] = *trajectory;
    } else {
      planned_.assign(planned_.size(), std::nullopt);  // another try begins, if any
    }
    return trajectory;
  }

  double lower_bound_s(AgentIndex agent) const override { return search_->lower_bound_s(agent); }

  const Seen& seen() const { return seen_; }
  /// Of all robots and tries.
  const SearchStatistics& work() const { return work_; }

 private:
  void compare(AgentIndex agent, std::optional<double> arrival_s) {
    const Agent& asked = instance_.agents[agent];
    const MotionRules& rules = options_.rules;
    LoneRobot robot{asked.start, asked.goal, posed_.radii[agent], asked.speed_cells_per_s,
                    options_.connectedness};
    if (rules.turns)
      robot.turning = {asked.start_heading_deg, asked.goal_heading_deg, 180 * asked.rotation_speed};
    robot.wait_before_move_s = rules.wait_before_move_s;
    robot.extra_reach_cells = rules.inflate_distance_cells;
    robot.extra_time_s = rules.inflate_time_s;
    std::vector<MovingDisk> disks;
    std::vector<Forbidden> forbidden;
    look_round(agent, disks, forbidden);
    seen_.pardoned += !forbidden.empty();
    const double arrives_s = arrival_s.value_or(kForever);
    const double earliest_s = earliest_arrival_s(instance_.map, disks, robot, forbidden).value_or(kForever);
    RC_LOG() << "robot " << agent << " arrives at " << arrives_s << " s, expected " << earliest_s << " s"
             << std::endl;
    if (!options_.any_angle) RC_ASSERT(arrives_s >= earliest_s - kArrivalS);
    if (arrives_s <= earliest_s + kArrivalS) return;
    // No slot of zero width may be lost but those that the slacks of several robots close.
    ++seen_.late;
    const auto latest_s = earliest_arrival_s(instance_.map, disks, robot, forbidden, Contacts::kAvoided);
    RC_ASSERT(arrives_s <= latest_s.value_or(kForever) + kArrivalS);
  }

  /// What the robot has to keep away from.
  void look_round(AgentIndex agent, std::vector<MovingDisk>& disks, std::vector<Forbidden>& forbidden) const {
    const auto add = [&](const Trajectory& trajectory, double radius) {
      for (const MovingDisk& disk : disks_of(trajectory, radius)) disks.push_back(disk);
    };
    for (const DynamicObstacle& obstacle : instance_.obstacles)
      add(obstacle.trajectory, obstacle.radius_cells);
    const Agent& asking = instance_.agents[agent];
    for (AgentIndex other = 0; other < planned_.size(); ++other) {
      const Agent& owner = instance_.agents[other];
      const double reach = asking.radius_cells + owner.radius_cells;
      if (planned_[other]) {
        add(*planned_[other], owner.radius_cells);
      } else if (other == agent || options_.ssi_s == 0) {
        continue;
      } else if (std::isinf(options_.ssi_s) && distance(asking.goal, owner.start) < reach - kEdgeCells) {
        forbidden.push_back({centre(owner.start), reach, centre(asking.goal)});
      } else {
        disks.push_back(MovingDisk::resting(centre(owner.start), 0, options_.ssi_s, owner.radius_cells));
      }
    }
  }

  const Posed& posed_;
  const Instance& instance_;
  const PlannerOptions& options_;
  std::unique_ptr<SingleAgentPlanner> search_;
  std::vector<std::optional<Trajectory>> planned_;  ///< in this try
  Seen seen_;
  SearchStatistics work_;
};

enum class Robots { kPlain, kTurning };

Seen compares_well(bool any_angle, Robots robots) {
  Posed question = posed(any_world(), any_angle);
  if (robots == Robots::kTurning) {
    const auto seed = *rc::gen::noShrink(rc::gen::arbitrary<std::uint64_t>());
    question.plan_case = with_motion_rules(question.plan_case, seed);
  }
  note_case(question.plan_case);
  ComparedSearch search(question);
  const PlanResult result = plan_prioritized(question.plan_case.instance, question.plan_case.options, search);
  const PlanResult usual = plan(question.plan_case.instance, question.plan_case.options);
  RC_ASSERT(result.status == usual.status);
  RC_ASSERT(result.solution == usual.solution);
  for (const PlanResult* counted : {&result, &usual}) {
    RC_ASSERT(counted->statistics.expansions == search.work().expansions);
    RC_ASSERT(counted->statistics.generations == search.work().generations);
  }
  return search.seen();
}

void compare_worlds(bool any_angle, Robots robots = Robots::kPlain) {
  Seen all;
  const int worlds = any_angle ? kAnyAngleWorldsPerCase : kWorldsPerCase;
  for (int i = 0; i < worlds; ++i) {
    const Seen seen = compares_well(any_angle, robots);
    all.planned += seen.planned > 1;
    all.pardoned += seen.pardoned;
    all.failed += seen.failed;
    all.late += seen.late;
  }
  RC_CLASSIFY(all.planned == worlds, "two robots or more in each world");
  RC_CLASSIFY(all.pardoned > 0, "goals on protected starts");
  RC_CLASSIFY(all.late > 0, "some later than contacts allow");
  RC_CLASSIFY(all.failed > 0, "some without a path");
}

const PropertyRoom room("prioritized_planning", [] {
  bool passed = true;

  passed &=
      property("each robot of each try arrives exactly as early as an exhaustive search, or fails with it",
               [] { compare_worlds(false); });

  passed &= property("each robot of each try arrives no later at any angle than stepwise",
                     [] { compare_worlds(true); });

  passed &=
      property("with headings, delays and inflation, too, each arrives as early as an exhaustive search",
               [] { compare_worlds(false, Robots::kTurning); });

  return passed;
});

}  // namespace
}  // namespace sipplab::prioritized_planning_laws
