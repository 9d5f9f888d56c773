// The verdict on a solution: one check after another; see validator.hpp.
#include "sipplab/validator.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "planner/core/tolerances.hpp"
#include "planner/validator/body_track.hpp"
#include "planner/validator/heading_check.hpp"
#include "planner/validator/separation.hpp"
#include "planner/validator/spacing_check.hpp"
#include "planner/validator/start_safe_check.hpp"
#include "planner/validator/trajectory_check.hpp"

namespace sipplab {
namespace {

std::string obstacle_label(const Instance& instance, std::size_t obstacle) {
  const std::string& id = instance.obstacles[obstacle].id;
  return "obstacle " + (id.empty() ? std::to_string(obstacle) : id);
}

bool is_permutation(const std::vector<AgentIndex>& order, std::size_t agents) {
  std::vector<bool> seen(agents, false);
  for (const AgentIndex agent : order) {
    if (agent >= agents || seen[agent]) return false;
    seen[agent] = true;
  }
  return order.size() == agents;
}

Violation collision(const Instance& instance, const BodyConflict& conflict) {
  const std::size_t agents = instance.agents.size();
  const bool with_obstacle = conflict.second >= agents;
  const std::size_t other = with_obstacle ? conflict.second - agents : conflict.second;
  const std::string other_label =
      with_obstacle ? obstacle_label(instance, other) : agent_label(instance, other);
  return {with_obstacle ? ViolationKind::kObstacleCollision : ViolationKind::kAgentCollision,
          conflict.first,
          other,
          conflict.time_s,
          conflict.depth_cells,
          fmt::format("{} and {} overlap by {:.3g} cells at time {}", agent_label(instance, conflict.first),
                      other_label, conflict.depth_cells, conflict.time_s)};
}

void check_guarantee(const Instance& instance, const std::vector<BodyTrack>& robots,
                     const ValidationOptions& options, std::size_t max_violations,
                     std::vector<Violation>& violations) {
  if (options.ssi_s <= 0 || options.order.empty() || violations.size() >= max_violations) return;
  // Not <=: a start-safe interval that is no number guarantees nothing that can be checked.
  if (!(options.ssi_s > 0) || !is_permutation(options.order, instance.agents.size())) {
    violations.push_back(
        {ViolationKind::kStartSafeInterval, 0, std::nullopt, 0, 0,
         fmt::format("a start-safe interval of {} and an order of {} agents guarantee nothing: expected "
                     "a number and each of {} agents once",
                     options.ssi_s, options.order.size(), instance.agents.size())});
    return;
  }
  for (const StartIntrusion& intrusion :
       check_start_safe_intervals(instance, robots, options.order, options.ssi_s, kValidatorToleranceCells,
                                  max_violations - violations.size())) {
    violations.push_back(
        {ViolationKind::kStartSafeInterval, intrusion.agent, intrusion.other, intrusion.time_s,
         intrusion.depth_cells,
         fmt::format("{} overlaps the protected start of {} by {:.3g} cells at time {}",
                     agent_label(instance, intrusion.agent), agent_label(instance, intrusion.other),
                     intrusion.depth_cells, intrusion.time_s)});
  }
}

/// What the rules ask for beyond bodies that do not overlap.
void check_rules(const Instance& instance, const std::vector<BodyTrack>& bodies,
                 const ValidationOptions& options, std::size_t max_violations,
                 std::vector<Violation>& violations) {
  const std::size_t agents = instance.agents.size();
  std::vector<AgentIndex> order = options.order;
  if (!is_permutation(order, agents)) order.clear();
  const std::size_t room = std::max(max_violations, violations.size()) - violations.size();
  for (const SpacingConflict& conflict :
       check_spacing(bodies, agents, order, options.rules, kValidatorToleranceCells, room)) {
    const bool with_obstacle = conflict.other >= agents;
    const std::size_t other = with_obstacle ? conflict.other - agents : conflict.other;
    violations.push_back(
        {ViolationKind::kSpacing, conflict.body, other, conflict.time_s, conflict.depth_cells,
         fmt::format("{} is {:.3g} cells too near to {} at time {} for an inflation by {}",
                     agent_label(instance, conflict.body), conflict.depth_cells,
                     with_obstacle ? obstacle_label(instance, other) : agent_label(instance, other),
                     conflict.time_s,
                     conflict.in_time ? fmt::format("{} s", options.rules.inflate_time_s)
                                      : fmt::format("{} cells", options.rules.inflate_distance_cells))});
  }
}

}  // namespace

std::string_view name(ViolationKind kind) {
  constexpr std::string_view kNames[] = {
      "agent-count",     "not-finite",      "endpoint",           "discontinuity",       "speed",
      "static-obstacle", "agent-collision", "obstacle-collision", "start-safe-interval", "heading",
      "standing-time",   "spacing"};
  return kNames[static_cast<std::size_t>(kind)];
}

ValidationReport validate(const Instance& instance, const Solution& solution,
                          const ValidationOptions& options) {
  const std::size_t max_violations = std::max<std::size_t>(1, options.max_violations);
  const std::size_t agents = instance.agents.size();
  ValidationReport report;
  if (solution.trajectories.size() != agents) {
    const auto difference = static_cast<double>(solution.trajectories.size()) - static_cast<double>(agents);
    report.violations.push_back(
        {ViolationKind::kAgentCount, 0, std::nullopt, 0, std::abs(difference),
         fmt::format("{} trajectories for {} agents", solution.trajectories.size(), agents)});
    return report;
  }

  bool comparable = true;
  for (AgentIndex i = 0; i < agents; ++i) {
    const Trajectory& trajectory = solution.trajectories[i];
    if (check_trajectory(instance, i, trajectory, max_violations, report.violations)) {
      check_headings(instance, i, trajectory, options.rules, max_violations, report.violations);
    } else {
      comparable = false;
    }
  }
  // Without times there is no place to compare, and the verdict is known.
  if (!comparable) return report;

  std::vector<BodyTrack> bodies;
  bodies.reserve(agents + instance.obstacles.size());
  for (AgentIndex i = 0; i < agents; ++i) {
    bodies.push_back(make_track(solution.trajectories[i], instance.agents[i].radius_cells));
  }
  std::vector<BodyTrack> robots;
  if (options.ssi_s != 0 && !options.order.empty()) robots = bodies;
  for (const DynamicObstacle& obstacle : instance.obstacles) {
    bodies.push_back(make_track(obstacle.trajectory, obstacle.radius_cells));
  }

  const std::size_t room = std::max<std::size_t>(1, max_violations - report.violations.size());
  const Separation separation =
      check_separation(instance.map, bodies, agents, kValidatorToleranceCells, room);
  report.min_clearance_cells = separation.min_clearance_cells;
  for (const BodyConflict& conflict : separation.conflicts) {
    if (report.violations.size() < max_violations) report.violations.push_back(collision(instance, conflict));
  }
  check_rules(instance, bodies, options, max_violations, report.violations);
  check_guarantee(instance, robots, options, max_violations, report.violations);
  return report;
}

}  // namespace sipplab
