#include "planner/prioritized/prioritized_planner.hpp"

#include <algorithm>
#include <chrono>
#include <cmath>

#include "planner/core/assert.hpp"
#include "planner/core/tolerances.hpp"
#include "planner/search/sipp_search.hpp"
#include "planner/search/turning_search.hpp"

namespace sipplab {
namespace {

using Clock = std::chrono::steady_clock;

/// Beyond this many seconds a time limit is as good as none (and a clock would
/// overflow): about three years.
constexpr double kLongestTimeLimitS = 1e8;

std::optional<Clock::time_point> deadline_after(Clock::time_point begin, double limit_s) {
  if (!(limit_s < kLongestTimeLimitS)) return std::nullopt;
  return begin + std::chrono::duration_cast<Clock::duration>(std::chrono::duration<double>(limit_s));
}

double largest_radius(const Instance& instance) {
  double largest = 0;
  for (const Agent& agent : instance.agents) largest = std::max(largest, agent.radius_cells);
  return largest;
}

/// The start-safe intervals of the robots that are still to be planned: their starts
/// as resting disks in the reservation table. [AY18], section 3.
class StartGuard {
 public:
  StartGuard(const Instance& instance, double ssi_s, ReservationTable& reservations)
      : instance_(instance), ssi_s_(ssi_s), reservations_(reservations) {
    if (ssi_s_ == 0) return;
    for (AgentIndex agent = 0; agent < instance.agents.size(); ++agent) disks_.push_back(protect(agent));
  }

  /// The robot is about to be planned: its own start is no obstacle to it. Starts that are
  /// protected for ever let it in where its own goal overlaps them, while it is within the
  /// disk of its goal; else a goal on the start of another robot could never be reached.
  void begin(AgentIndex agent) {
    if (ssi_s_ == 0) return;
    lift(agent);
    if (ssi_s_ < kInfiniteSsi) return;
    for (AgentIndex other = 0; other < disks_.size(); ++other) {
      if (disks_[other] && overlaps_goal(agent, other)) {
        const Agent& owner = instance_.agents[other];
        lift(other);
        reservations_.add_keepout(centre(owner.start), owner.radius_cells,
                                  centre(instance_.agents[agent].goal));
        lifted_for_goal_.push_back(other);
      }
    }
  }

  /// The robot has been planned.
  void end() {
    reservations_.clear_keepouts();
    for (const AgentIndex other : lifted_for_goal_) disks_[other] = protect(other);
    lifted_for_goal_.clear();
  }

 private:
  std::optional<ReservationTable::DiskId> protect(AgentIndex agent) {
    const Agent& owner = instance_.agents[agent];
    return reservations_.add(MovingDisk::resting(centre(owner.start), 0, ssi_s_, owner.radius_cells));
  }

  void lift(AgentIndex agent) {
    PLANNER_ASSERT(disks_[agent]);
    reservations_.remove(*disks_[agent]);
    disks_[agent].reset();
  }

  bool overlaps_goal(AgentIndex agent, AgentIndex other) const {
    const Agent& planned = instance_.agents[agent];
    const Agent& owner = instance_.agents[other];
    return distance(planned.goal, owner.start) < planned.radius_cells + owner.radius_cells - kTouchDepthCells;
  }

  const Instance& instance_;
  double ssi_s_;
  ReservationTable& reservations_;
  std::vector<std::optional<ReservationTable::DiskId>> disks_;
  std::vector<AgentIndex> lifted_for_goal_;
};

/// How one pass over an order ended.
struct PassResult {
  std::optional<AgentIndex> failed;
  PlanFailure failure = PlanFailure::kNoPath;
};

/// Plans the agents one by one, each around those before it.
PassResult plan_in_order(const Instance& instance, const PlannerOptions& options, const PriorityOrder& order,
                         SingleAgentPlanner& planner, const SearchLimits& limits,
                         ReservationTable& reservations, SearchStatistics& statistics, Solution& solution) {
  reservations.clear();
  for (const DynamicObstacle& obstacle : instance.obstacles) {
    reservations.add(obstacle.trajectory, obstacle.radius_cells);
  }
  StartGuard starts(instance, options.ssi_s, reservations);
  for (const AgentIndex agent : order) {
    SearchLimits left = limits;
    left.max_expansions = limits.max_expansions - statistics.expansions;
    starts.begin(agent);
    Expected<Trajectory, PlanFailure> trajectory = planner.plan(agent, reservations, left, statistics);
    starts.end();
    if (!trajectory) return {agent, trajectory.error()};
    reservations.add(*trajectory, instance.agents[agent].radius_cells);
    solution.trajectories[agent] = std::move(*trajectory);
  }
  return {};
}

}  // namespace

std::string_view name(PlanStatus status) {
  switch (status) {
    case PlanStatus::kSolved:
      return "solved";
    case PlanStatus::kFailed:
      return "failed";
    case PlanStatus::kLimit:
      return "limit";
  }
  return "unknown";
}

PlanResult plan_prioritized(const Instance& instance, const PlannerOptions& options,
                            SingleAgentPlanner& planner) {
  const Clock::time_point begin = Clock::now();
  SearchLimits limits;
  limits.max_expansions = options.max_expansions;
  limits.deadline = deadline_after(begin, options.time_limit_s);

  std::vector<double> lengths_s;
  for (AgentIndex agent = 0; agent < instance.agents.size(); ++agent) {
    lengths_s.push_back(planner.lower_bound_s(agent));
  }
  Random random(options.seed);
  PriorityOrder first = initial_order(options.order, lengths_s, random);
  OrderSequence orders(options.rescheduling, std::move(first), random);

  const MotionRules& rules = options.rules;
  ReservationTable reservations(instance.map, largest_radius(instance) + rules.inflate_distance_cells,
                                rules.inflate_time_s);
  PlanResult result;
  while (true) {
    Solution solution;
    solution.trajectories.resize(instance.agents.size());
    const PassResult pass = plan_in_order(instance, options, orders.current(), planner, limits, reservations,
                                          result.statistics, solution);
    result.trace.push_back({orders.current(), pass.failed});
    if (!pass.failed) {
      result.status = PlanStatus::kSolved;
      result.solution = std::move(solution);
      break;
    }
    if (pass.failure != PlanFailure::kNoPath) {
      result.status = PlanStatus::kLimit;
      break;
    }
    if (!orders.advance(*pass.failed)) {
      result.status = PlanStatus::kFailed;
      break;
    }
    if (result.trace.size() > options.max_restarts || (limits.deadline && Clock::now() >= *limits.deadline)) {
      result.status = PlanStatus::kLimit;
      break;
    }
  }
  result.planning_seconds = std::chrono::duration<double>(Clock::now() - begin).count();
  return result;
}

PlanResult plan(const Instance& instance, const PlannerOptions& options) {
  const Clock::time_point begin = Clock::now();
  PlanResult result;
  if (options.rules.is_plain()) {
    SippSearch search(instance, {options.any_angle, options.connectedness});
    result = plan_prioritized(instance, options, search);
  } else {
    TurningSearch search(instance, {options.any_angle, options.connectedness, options.rules});
    result = plan_prioritized(instance, options, search);
  }
  result.planning_seconds = std::chrono::duration<double>(Clock::now() - begin).count();
  return result;
}

}  // namespace sipplab
