#include "planner/complete/complete_planner.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "planner/complete/lacam.hpp"
#include "planner/complete/start_order.hpp"
#include "planner/core/clock.hpp"
#include "planner/core/tolerances.hpp"
#include "planner/retime/unit_schedule.hpp"
#include "sipplab/error.hpp"

namespace sipplab {
namespace {

/// Bytes of configurations and constraints: with what the plan takes after the search, less
/// than the 4 GiB that a small machine has.
constexpr std::size_t kMaxSearchBytes = std::size_t{2} << 30;

/// Cells. Bodies up to this size stay apart on unit moves that share no cell.
constexpr double kLargestRadiusCells = 0.5;

/// Plans from different seeds, of which the cheapest is kept: at most so many, and no more once robots have
/// looked at so many cells (950 robots on the empty map of 32 x 32 cells and 1,000 in warehouse-10-20-10-2-1
/// plan once, 400 there three times).
constexpr int kMostPlans = 24;
constexpr std::uint64_t kMostCellsSeen = 1'800'000;
/// Every other plan has cheap rows of pushes (LacamLimits::push_cheaply): the first one from this share of
/// the free cells on. (1,000 robots in warehouse-10-20-10-2-1, 0.18: 15 % dearer; 300 in mazes, 0.38: 17 %
/// cheaper.)
constexpr double kShareForCheapPushes = 0.25;
/// A search that takes so many times the steps of the best plan is given up.
constexpr std::uint64_t kMostLengths = 2;
/// A plan as cheap as all shortest paths, up to the rounding of sums, is the best of all.
constexpr double kRounding = 1e-9;

std::string name_of(const Instance& instance, AgentIndex agent) {
  const std::string& id = instance.agents[agent].id;
  return "agent " + (id.empty() ? std::to_string(agent) : id);
}

}  // namespace

std::optional<InstanceError> find_beyond_complete(const Instance& instance, const MotionRules& rules) {
  if (!rules.is_plain()) {
    return InstanceError{std::nullopt, std::nullopt, "headings, delays or inflation", "none for LaCAM"};
  }
  if (!instance.obstacles.empty()) {
    return InstanceError{std::nullopt, std::size_t{0}, "the instance has dynamic obstacles",
                         "none for LaCAM"};
  }
  for (AgentIndex i = 0; i < instance.agents.size(); ++i) {
    const Agent& agent = instance.agents[i];
    if (agent.radius_cells > kLargestRadiusCells + kTouchDepthCells) {
      return InstanceError{i, std::nullopt,
                           fmt::format("{}: radius {}", name_of(instance, i), agent.radius_cells),
                           fmt::format("at most {} for LaCAM", kLargestRadiusCells)};
    }
    const double speed = instance.agents.front().speed_cells_per_s;
    if (agent.speed_cells_per_s != speed) {
      return InstanceError{i, std::nullopt,
                           fmt::format("{}: speed {}", name_of(instance, i), agent.speed_cells_per_s),
                           fmt::format("the speed of {}, {}, for LaCAM", name_of(instance, 0), speed)};
    }
  }
  return std::nullopt;
}

CompleteResult plan_complete(const Instance& instance, const PlannerOptions& options) {
  const FreeGrid grid(instance.map);
  Configuration starts;
  Configuration goals;
  for (const Agent& agent : instance.agents) {
    starts.push_back(grid.id(agent.start));
    goals.push_back(grid.id(agent.goal));
  }
  LacamLimits limits;
  limits.max_steps = options.max_expansions;
  limits.max_memory_bytes = kMaxSearchBytes;
  limits.deadline = deadline_after(Clock::now(), options.time_limit_s);
  limits.stop = options.stop;
  const double unit_move_s = instance.agents.empty() ? 1 : 1 / instance.agents.front().speed_cells_per_s;
  const double reach_cells = std::clamp(2 * largest_radius_cells(instance), kMinRadiusCells, 1.0);
  Lacam lacam(grid, starts, goals, limits);
  Random seeds(options.seed);
  CompleteResult result;
  const double no_less = options.objective.of(static_cast<double>(lacam.least_moves()) * unit_move_s,
                                              static_cast<double>(lacam.least_steps()) * unit_move_s);
  double least_cost = 0;
  std::uint64_t most_steps = UINT64_MAX;
  std::uint64_t cells_seen = 0;
  const bool begins_cheaply =
      static_cast<double>(starts.size()) >= kShareForCheapPushes * static_cast<double>(grid.size());
  for (int plans = 0; plans < kMostPlans && cells_seen <= kMostCellsSeen; ++plans) {
    limits.push_cheaply = (plans % 2 == 0) == begins_cheaply;
    limits.max_steps = std::min(options.max_expansions - result.steps_tried, most_steps);
    const LacamResult search = lacam.search(seeds.next(), limits);
    result.steps_tried += search.steps_tried;
    result.configurations += search.configurations;
    cells_seen += search.cells_seen;
    if (plans == 0) result.status = search.status;
    if (result.status != LacamStatus::kSolved) break;
    if (search.status != LacamStatus::kSolved) {
      if (search.steps_tried < limits.max_steps) break;  // out of time
      continue;                                          // a plan that is longer than the best by far
    }

    Visits visits(search.steps, grid.size());
    visits.remove_round_trips();
    UnitSchedule schedule = unit_schedule(grid, visits, reach_cells, unit_move_s);
    PLANNER_ASSERT(schedule.circle.empty());  // rings do not turn in the search
    const double cost = options.objective.of(flowtime_s(schedule.solution), makespan_s(schedule.solution));
    if (plans > 0 && cost >= least_cost) continue;
    least_cost = cost;
    most_steps = kMostLengths * search.steps.size();
    result.solution = std::move(schedule.solution);
    StartOrder kept = longest_kept_order(instance, visits, schedule.arrivals_s, options.ssi_s);
    result.order = std::move(kept.order);
    result.ssi_kept_s = kept.kept_s;
    if (cost <= no_less * (1 + kRounding)) break;
  }
  return result;
}

}  // namespace sipplab
