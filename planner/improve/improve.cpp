#include "sipplab/improve.hpp"

#include <algorithm>
#include <future>
#include <memory>
#include <span>
#include <utility>

#include "planner/core/attempts.hpp"
#include "planner/improve/replica.hpp"
#include "planner/improve/static_times.hpp"
#include "planner/improve/tighten.hpp"
#include "planner/prioritized/limits.hpp"
#include "sipplab/prioritized_planner.hpp"

namespace sipplab {
namespace {

/// Iterations between two looks at what ends the improvement.
constexpr std::uint64_t kIterationsPerRound = 64;

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
    PlanCost cost = cost_of(instance_, plan());
    note_progress(0, cost);
    if (budget_.iterations > 0) {
      cost = tighten_all(instance_, first().plan(), cost, limits_,
                         [&](const PlanCost& better) { note_progress(0, better); });
    }
    for (const auto& replica : replicas_) replica->set_cost(cost);
    for (std::size_t i = 1; i < replicas_.size() && !limits_.is_over(); ++i) copy_to(replicas_[i]->plan());
    find_fastest_ways(planners);
  }

  ImproveResult run() {
    const std::uint64_t& done = result_.log.iterations;
    while (done < budget_.iterations && !instance_.agents.empty()) {
      result_.log.was_cut_short = limits_.is_over();
      if (result_.log.was_cut_short || is_optimal()) break;
      iterate(std::min(kIterationsPerRound, budget_.iterations - done));
    }
    note_progress(done, first().cost());
    result_.log.bound = bound_.get();
    result_.solution = plan().solution();
    if (result_.log.keeps_guarantee) {
      result_.order = plan().order();
      result_.ssi_kept_s = options_.ssi_s;
    }
    return std::move(result_);
  }

 private:
  Replica& first() { return *replicas_.front(); }
  const Replica& first() const { return *replicas_.front(); }
  const PartialPlan& plan() const { return first().plan(); }

  void fill(const Solution& given, const PriorityOrder& order, double ssi_s, Planners planners) {
    result_.log.keeps_guarantee = ssi_s == options_.ssi_s;
    replicas_.clear();
    for (SingleAgentPlanner* planner : planners) {
      replicas_.push_back(std::make_unique<Replica>(givens_, ssi_s, *planner));
    }
    for (const AgentIndex agent : order) first().plan().insert(agent, given.trajectories[agent]);
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
    const PlanCost& cost = first().cost();
    return cost.flowtime_s <= fastest.flowtime_s && cost.makespan_s <= fastest.makespan_s;
  }

  void note_progress(std::uint64_t iteration, const PlanCost& cost) {
    result_.log.curve.push_back({seconds_since(begin_), iteration, cost});
  }

  /// Tries some neighbourhoods, and takes over those that make the plan better, in the order of their
  /// numbers.
  void iterate(std::uint64_t iterations) {
    std::uint64_t settled = result_.log.iterations;
    const std::vector<Attempt> attempts = attempt_and_settle<Attempt>(
        replicas_.size(), iterations,
        [&, begin = stream_ + settled](std::size_t worker, std::size_t i) {
          return replicas_[worker]->attempt(Random(begin + i));
        },
        [&](std::size_t worker, const Attempt& attempt) {
          const bool is_taken = replicas_[worker]->settle(attempt);
          if (worker > 0) return;
          ++settled;
          if (!is_taken) return;
          ++result_.log.improvements;
          note_progress(settled, first().cost());
        });
    for (const Attempt& attempt : attempts) {
      if (attempt.was_cut_short) break;
      ++result_.log.iterations;
      result_.statistics += attempt.work;
    }
  }

  const Instance& instance_;
  const PlannerOptions& options_;
  ImproveBudget budget_;
  std::uint64_t stream_;  ///< where the seeds of the iterations begin
  Clock::time_point begin_;
  SearchLimits limits_;
  std::vector<Trajectory> fastest_paths_;  ///< by robot
  std::vector<double> fastest_s_;          ///< by robot: arrivals on these
  Givens givens_{instance_, options_.objective, fastest_s_, fastest_paths_, limits_};
  std::vector<std::unique_ptr<Replica>> replicas_;  ///< one for each thread
  std::future<LowerBound> bound_;
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
