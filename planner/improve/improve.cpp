#include "planner/improve/improve.hpp"

#include <algorithm>
#include <memory>
#include <numeric>
#include <utility>

#include "planner/core/assert.hpp"
#include "planner/improve/neighbourhoods.hpp"
#include "planner/prioritized/limits.hpp"

namespace sipplab {
namespace {

/// Robots taken out at once: few, so that thousands of neighbourhoods are tried in the time
/// that one plan takes. Trials on the paper's warehouse.
constexpr std::size_t kFewestRemoved = 2;
constexpr std::size_t kMostRemoved = 5;

double length_cells(const Trajectory& trajectory) {
  double cells = 0;
  for (const TimedMotion& motion : trajectory.motions) cells += distance(motion.from, motion.to);
  return cells;
}

class LargeNeighbourhoodSearch {
 public:
  LargeNeighbourhoodSearch(const Instance& instance, const Solution& given, const PriorityOrder& order,
                           const ImproveOptions& options, SingleAgentPlanner& planner)
      : instance_(instance), options_(options), random_(options.seed), begin_(Clock::now()) {
    limits_.deadline = deadline_after(begin_, options.time_limit_s);
    limits_.stop = options.stop;
    result_.log.objective = options.objective;
    fill(given, order, options.ssi_s, planner);
    if (!plan_->order()) fill(given, order, 0, planner);
    cost_ = cost_of_plan();
    find_bounds(planner);
    note_progress();
  }

  ImproveResult run() {
    while (result_.log.iterations < options_.max_iterations && !instance_.agents.empty() && !is_optimal()) {
      result_.log.was_cut_short = limits_.is_over();
      if (result_.log.was_cut_short) break;
      iterate();
    }
    note_progress();
    result_.solution = plan_->solution();
    if (result_.log.keeps_promise) result_.order = plan_->order();
    return std::move(result_);
  }

 private:
  void fill(const Solution& given, const PriorityOrder& order, double ssi_s, SingleAgentPlanner& planner) {
    result_.log.keeps_promise = ssi_s == options_.ssi_s;
    plan_ = std::make_unique<PartialPlan>(instance_, ssi_s, planner);
    for (const AgentIndex agent : order) plan_->insert(agent, given.trajectories[agent]);
  }

  /// The fastest way of each robot alone, and from these what no plan can beat.
  void find_bounds(SingleAgentPlanner& planner) {
    PartialPlan nobody(instance_, 0, planner);
    std::vector<double> solo_cells;
    for (AgentIndex agent = 0; agent < instance_.agents.size(); ++agent) {
      Expected<Trajectory, PlanFailure> alone = nobody.find(agent, {}, result_.statistics);
      fastest_ways_.push_back(alone ? std::move(*alone) : plan_->trajectory(agent));
      solo_cells.push_back(length_cells(fastest_ways_.back()));
    }
    static_times_s_ = static_times_s(instance_, options_.any_angle, options_.connectedness, solo_cells);
    result_.log.bound = lower_bound(static_times_s_);
  }

  PlanCost cost_of_plan() const {
    PlanCost cost;
    for (AgentIndex agent = 0; agent < instance_.agents.size(); ++agent) {
      const double arrival_s = plan_->trajectory(agent).arrival_s();
      cost.flowtime_s += arrival_s;
      cost.makespan_s = std::max(cost.makespan_s, arrival_s);
    }
    return cost;
  }

  bool is_optimal() const {
    return cost_.flowtime_s <= result_.log.bound.flowtime_s &&
           cost_.makespan_s <= result_.log.bound.makespan_s;
  }

  void note_progress() {
    result_.log.curve.push_back({seconds_since(begin_), result_.log.iterations, cost_});
  }

  void iterate() {
    ++result_.log.iterations;
    const RemovalRule rule = roulette_.draw(random_);
    const std::size_t most = kFewestRemoved + random_.below(kMostRemoved - kFewestRemoved + 1);
    std::vector<AgentIndex> robots =
        choose_neighbourhood(rule, {instance_, *plan_, static_times_s_, fastest_ways_}, most, random_);
    random_.shuffle(robots);
    const std::uint64_t expansions_before = result_.statistics.expansions;
    const double objective_before = options_.objective.of(cost_.flowtime_s, cost_.makespan_s);
    const bool better = plan_again(robots);
    const double gain =
        better ? objective_before - options_.objective.of(cost_.flowtime_s, cost_.makespan_s) : 0;
    const auto work = static_cast<double>(result_.statistics.expansions - expansions_before + 1);
    roulette_.learn(rule, gain / work);
    if (!better) return;
    ++result_.log.improvements;
    note_progress();
  }

  /// Takes the robots out and plans them in this sequence. True where the plan is better now;
  /// else it is as before.
  bool plan_again(const std::vector<AgentIndex>& robots) {
    std::vector<PartialPlan::Taken> before;
    for (const AgentIndex robot : robots) before.push_back(plan_->take_out(robot));
    std::size_t planned = 0;
    while (planned < robots.size()) {
      SearchLimits limits = limits_;
      limits.latest_arrival_s = latest_arrival_s(robots, before, planned);
      Expected<Trajectory, PlanFailure> found = plan_->find(robots[planned], limits, result_.statistics);
      if (!found) {
        // An iteration that a limit cut short never was: what counts is how many there were.
        if (found.error() != PlanFailure::kNoPath) --result_.log.iterations;
        break;
      }
      plan_->insert(robots[planned], std::move(*found));
      ++planned;
    }
    if (planned == robots.size()) {
      const PlanCost cost = cost_of_plan();
      if (is_better(options_.objective, cost, cost_)) {
        cost_ = cost;
        return true;
      }
    }
    while (planned > 0) plan_->take_out(robots[--planned]);
    for (PartialPlan::Taken& taken : before) plan_->put_back(std::move(taken));
    return false;
  }

  /// The latest arrival of robots[planned] with which the plan may still become better, if
  /// those behind it were as fast as can be.
  double latest_arrival_s(const std::vector<AgentIndex>& robots,
                          const std::vector<PartialPlan::Taken>& before, std::size_t planned) const {
    double left_s = 0;            // of the flowtime that these robots had together
    double least_makespan_s = 0;  // whatever robots[planned] does
    for (std::size_t i = 0; i < robots.size(); ++i) {
      left_s += before[i].trajectory.arrival_s();
      if (i == planned) continue;
      const double arrival_s =
          i < planned ? plan_->trajectory(robots[i]).arrival_s() : static_times_s_[robots[i]];
      left_s -= arrival_s;
      least_makespan_s = std::max(least_makespan_s, arrival_s);
    }
    for (AgentIndex agent = 0; agent < instance_.agents.size(); ++agent) {
      if (plan_->is_planned(agent)) {
        least_makespan_s = std::max(least_makespan_s, plan_->trajectory(agent).arrival_s());
      }
    }
    const Objective& objective = options_.objective;
    if (objective.flowtime_weight == 0) return cost_.makespan_s;
    const double makespan_gain_s = std::max(cost_.makespan_s - least_makespan_s, 0.0);
    return left_s + objective.makespan_weight / objective.flowtime_weight * makespan_gain_s +
           kArrivalToleranceS;
  }

  /// Seconds. Rounding of sums of arrivals: a robot that is exactly as fast as before may make
  /// room for others.
  static constexpr double kArrivalToleranceS = 1e-9;

  const Instance& instance_;
  const ImproveOptions& options_;
  Random random_;
  Clock::time_point begin_;
  SearchLimits limits_;
  std::unique_ptr<PartialPlan> plan_;
  std::vector<Trajectory> fastest_ways_;  ///< by robot
  std::vector<double> static_times_s_;    ///< by robot
  RuleRoulette roulette_;
  PlanCost cost_;
  ImproveResult result_;
};

}  // namespace

ImproveOptions improve_options(const PlannerOptions& planner, const PlanResult& plan) {
  ImproveOptions options;
  options.ssi_s = plan.ssi_kept_s;
  options.any_angle = planner.any_angle;
  options.connectedness = planner.connectedness;
  options.rules = planner.rules;
  options.seed = planner.seed;
  options.stop = planner.stop;
  return options;
}

ImproveResult improve(const Instance& instance, const Solution& given, const PriorityOrder& order,
                      const ImproveOptions& options, SingleAgentPlanner& planner) {
  return LargeNeighbourhoodSearch(instance, given, order, options, planner).run();
}

ImproveResult improve(const Instance& instance, const Solution& given, const PriorityOrder& order,
                      const ImproveOptions& options) {
  PlannerOptions planner;
  planner.any_angle = options.any_angle;
  planner.connectedness = options.connectedness;
  planner.rules = options.rules;
  return improve(instance, given, order, options, *single_agent_planner(instance, planner));
}

}  // namespace sipplab
