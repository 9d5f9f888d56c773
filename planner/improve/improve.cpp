#include "sipplab/improve.hpp"

#include <algorithm>
#include <future>
#include <memory>
#include <span>
#include <utility>

#include "planner/core/parallel.hpp"
#include "planner/improve/attempt.hpp"
#include "planner/improve/static_times.hpp"
#include "planner/improve/tighten.hpp"
#include "planner/prioritized/limits.hpp"
#include "sipplab/prioritized_planner.hpp"

namespace sipplab {
namespace {

/// Iterations that begin with the same plan, on any number of threads: enough to keep several
/// busy, few enough that not many are tried on a plan that is no longer the best. (Trials on the
/// paper's warehouse: one or two of ten iterations gain something.)
constexpr std::uint64_t kIterationsPerRound = 4;

using Planners = std::span<SingleAgentPlanner* const>;

class LargeNeighbourhoodSearch {
 public:
  /// One thread for each planner.
  LargeNeighbourhoodSearch(const Instance& instance, const Solution& given, const PriorityOrder& order,
                           const PlannerOptions& options, Planners planners, Clock::time_point begin)
      : instance_(instance),
        options_(options),
        budget_(options.improve.value_or(ImproveBudget{})),
        stream_(Random(options.seed).next()),
        begin_(begin) {
    limits_.deadline = deadline_after(begin_, budget_.seconds);
    limits_.stop = options.stop;
    result_.log.objective = options.objective;
    fill(given, order, options.ssi_s, planners);
    if (!plan().order()) fill(given, order, 0, planners);
    cost_ = cost_of(instance_, plan());
    note_progress(0);
    if (budget_.iterations > 0) {
      cost_ = tighten_all(instance_, *plans_.front(), cost_, limits_, [&](const PlanCost& cost) {
        cost_ = cost;
        note_progress(0);
      });
    }
    for (std::size_t i = 1; i < planners.size() && !limits_.is_over(); ++i) copy_to(*plans_[i]);
    find_fastest_ways(planners);
  }

  ImproveResult run() {
    const std::uint64_t& done = result_.log.iterations;
    while (done < budget_.iterations && !instance_.agents.empty()) {
      result_.log.was_cut_short = limits_.is_over();
      if (result_.log.was_cut_short || is_optimal()) break;
      play_round(std::min(kIterationsPerRound, budget_.iterations - done));
    }
    note_progress(done);
    result_.log.bound = bound_.get();
    result_.solution = plan().solution();
    if (result_.log.keeps_guarantee) {
      result_.order = plan().order();
      result_.ssi_kept_s = options_.ssi_s;
    }
    return std::move(result_);
  }

 private:
  const PartialPlan& plan() const { return *plans_.front(); }

  void fill(const Solution& given, const PriorityOrder& order, double ssi_s, Planners planners) {
    result_.log.keeps_guarantee = ssi_s == options_.ssi_s;
    plans_.clear();
    for (SingleAgentPlanner* planner : planners) {
      plans_.push_back(std::make_unique<PartialPlan>(instance_, ssi_s, *planner));
    }
    for (const AgentIndex agent : order) plans_.front()->insert(agent, given.trajectories[agent]);
  }

  void copy_to(PartialPlan& copy) const {
    for (AgentIndex agent = 0; agent < instance_.agents.size(); ++agent) {
      copy.insert(agent, plan().trajectory(agent));
    }
  }

  /// The fastest path of each robot alone, or the one that it has once time is over; how early any path could
  /// be is found out meanwhile.
  void find_fastest_ways(Planners planners) {
    std::vector<std::unique_ptr<PartialPlan>> nobody;  // plans without robots, one for each thread
    for (SingleAgentPlanner* planner : planners) {
      nobody.push_back(std::make_unique<PartialPlan>(instance_, 0, *planner));
    }
    fastest_paths_.resize(instance_.agents.size());
    fastest_s_.resize(instance_.agents.size());
    std::vector<double> solo_cells(instance_.agents.size());
    std::vector<SearchStatistics> work(planners.size());
    for_each_in_parallel(planners.size(), fastest_paths_.size(), [&](std::size_t worker, AgentIndex agent) {
      Expected<Trajectory, PlanFailure> alone = nobody[worker]->find(agent, limits_, work[worker]);
      fastest_paths_[agent] = alone ? std::move(*alone) : plan().trajectory(agent);
      fastest_s_[agent] = fastest_paths_[agent].arrival_s();
      solo_cells[agent] = length_cells(fastest_paths_[agent]);
    });
    for (const SearchStatistics& done : work) result_.statistics += done;
    bound_ = std::async(std::launch::async, [this, solo_cells = std::move(solo_cells)] {
      return lower_bound(
          static_times_s(instance_, options_.any_angle, options_.connectedness, solo_cells, limits_));
    });
  }

  /// Whether all robots are as fast as alone.
  bool is_optimal() const {
    const LowerBound fastest = lower_bound(fastest_s_);
    return cost_.flowtime_s <= fastest.flowtime_s && cost_.makespan_s <= fastest.makespan_s;
  }

  void note_progress(std::uint64_t iteration) {
    result_.log.curve.push_back({seconds_since(begin_), iteration, cost_});
  }

  /// Tries some neighbourhoods of the same plan, then takes over those that make it better, in
  /// the order of their numbers, so that it does not matter which thread tried which.
  void play_round(std::uint64_t iterations) {
    const Round round{instance_, options_.objective, roulette_, fastest_s_, fastest_paths_, cost_, limits_};
    std::vector<Attempt> attempts(iterations);
    for_each_in_parallel(plans_.size(), attempts.size(), [&](std::size_t worker, std::size_t i) {
      attempts[i] = try_neighbourhood(round, *plans_[worker], Random(stream_ + result_.log.iterations + i));
    });
    std::vector<AgentIndex> changed;
    for (const Attempt& attempt : attempts) {
      // An iteration that a limit cut short does not count, nor do those after it: the
      // result depends on the number of iterations alone.
      if (attempt.was_cut_short) break;
      ++result_.log.iterations;
      result_.statistics += attempt.work;
      roulette_.learn(static_cast<std::size_t>(attempt.rule), attempt.gain,
                      static_cast<double>(attempt.work.expansions + 1));
      if (attempt.is_better) take(round, attempt, changed);
    }
  }

  /// Takes over an attempt if it still fits and the plan is better with it.
  void take(const Round& round, const Attempt& attempt, std::vector<AgentIndex>& changed) {
    const auto is_changed = [&](AgentIndex robot) {
      return std::find(changed.begin(), changed.end(), robot) != changed.end();
    };
    if (std::any_of(attempt.robots.begin(), attempt.robots.end(), is_changed)) return;
    if (!take_over(round, attempt, changed, *plans_.front(), cost_)) return;
    for (std::size_t i = 1; i < plans_.size(); ++i) repeat(attempt, *plans_[i]);
    changed.insert(changed.end(), attempt.robots.begin(), attempt.robots.end());
    ++result_.log.improvements;
    note_progress(result_.log.iterations);
  }

  const Instance& instance_;
  const PlannerOptions& options_;
  ImproveBudget budget_;
  std::uint64_t stream_;  ///< where the seeds of the iterations begin
  Clock::time_point begin_;
  SearchLimits limits_;
  std::vector<std::unique_ptr<PartialPlan>> plans_;  ///< the same plan, once for each thread
  std::vector<Trajectory> fastest_paths_;            ///< by robot
  std::vector<double> fastest_s_;                    ///< by robot: arrivals on these
  std::future<LowerBound> bound_;
  RuleRoulette roulette_;
  PlanCost cost_;
  ImproveResult result_;
};

}  // namespace

ImproveResult improve(const Instance& instance, const Solution& given, const PriorityOrder& order,
                      const PlannerOptions& options) {
  const Clock::time_point begin = Clock::now();
  std::vector<std::unique_ptr<SingleAgentPlanner>> planners;
  std::vector<SingleAgentPlanner*> workers;
  for (unsigned i = 0; i < std::max(options.threads, 1U); ++i) {
    workers.push_back(planners.emplace_back(single_agent_planner(instance, options)).get());
  }
  return LargeNeighbourhoodSearch(instance, given, order, options, workers, begin).run();
}

}  // namespace sipplab
