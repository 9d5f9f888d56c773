#include "planner/complete/complete_planner.hpp"

#include <fmt/format.h>

#include <algorithm>

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

std::string name_of(const Instance& instance, AgentIndex agent) {
  const std::string& id = instance.agents[agent].id;
  return "agent " + (id.empty() ? std::to_string(agent) : id);
}

}  // namespace

std::optional<InstanceError> find_beyond_complete(const Instance& instance, const MotionRules& rules) {
  if (!rules.is_plain()) {
    return InstanceError{std::nullopt, std::nullopt, "headings, delays or inflation",
                         "none for the complete planner"};
  }
  if (!instance.obstacles.empty()) {
    return InstanceError{std::nullopt, std::size_t{0}, "the instance has dynamic obstacles",
                         "none for the complete planner"};
  }
  for (AgentIndex i = 0; i < instance.agents.size(); ++i) {
    const Agent& agent = instance.agents[i];
    if (agent.radius_cells > kLargestRadiusCells + kTouchDepthCells) {
      return InstanceError{i, std::nullopt,
                           fmt::format("{}: radius {}", name_of(instance, i), agent.radius_cells),
                           fmt::format("at most {} for the complete planner", kLargestRadiusCells)};
    }
    const double speed = instance.agents.front().speed_cells_per_s;
    if (agent.speed_cells_per_s != speed) {
      return InstanceError{
          i, std::nullopt, fmt::format("{}: speed {}", name_of(instance, i), agent.speed_cells_per_s),
          fmt::format("the speed of {}, {}, for the complete planner", name_of(instance, 0), speed)};
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
  LacamResult search = search_lacam(grid, starts, goals, options.seed, limits);

  CompleteResult result;
  result.status = search.status;
  result.steps_tried = search.steps_tried;
  result.configurations = search.configurations;
  if (search.status != LacamStatus::kSolved) return result;

  Visits visits(search.steps, grid.size());
  search.steps.clear();
  visits.remove_round_trips();
  const double unit_move_s = instance.agents.empty() ? 1 : 1 / instance.agents.front().speed_cells_per_s;
  const double reach_cells = std::clamp(2 * largest_radius_cells(instance), kMinRadiusCells, 1.0);
  UnitSchedule schedule = unit_schedule(grid, visits, reach_cells, unit_move_s);
  PLANNER_ASSERT(schedule.circle.empty());  // rings do not turn in the search
  result.solution = std::move(schedule.solution);
  StartOrder kept = longest_kept_order(instance, visits, schedule.arrivals_s, options.ssi_s);
  result.order = std::move(kept.order);
  result.ssi_kept_s = kept.kept_s;
  return result;
}

}  // namespace sipplab
