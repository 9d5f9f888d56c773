#include "planner/unit_moves/improve_unit_moves.hpp"

#include <algorithm>
#include <memory>
#include <utility>
#include <vector>

#include "planner/complete/complete_planner.hpp"
#include "planner/core/clock.hpp"
#include "planner/core/parallel.hpp"
#include "planner/improve/objective.hpp"
#include "planner/retime/steps.hpp"
#include "planner/retime/unit_schedule.hpp"
#include "planner/unit_moves/attempt.hpp"

namespace sipplab {
namespace {

/// Iterations that begin with the same plan, on any number of threads.
constexpr std::uint64_t kIterationsPerRound = 8;

/// Expansions, for each visit of a robot to a cell, after which all robots get the earliest times for their
/// routes.
constexpr std::uint64_t kExpansionsPerVisit = 8;

/// By how much a plan may be worse than the best one, as a share of a robot's mean arrival: a way out of
/// plans that no change of a few robots makes better. (In trials none of it, and four times as much, gave
/// dearer plans.)
constexpr double kSlack = 1.0 / 6;

/// Iterations for each robot in which the plan must become better by this share, or the search ends. (Paper's
/// warehouse with 160 robots, 10 s, eight runs: flowtime 3,620, 3,587 and 3,583 with 40, 80 and 160.)
constexpr std::uint64_t kIterationsPerLook = 80;
constexpr double kLeastGain = 0.002;

/// What it takes to put a robot out of the plan and in again, in expansions.
constexpr std::uint64_t kExpansionsPerRobot = 100;

/// Routes with the times that were found for visits.
std::vector<Route> routes_of(const Visits& visits, const std::vector<std::int64_t>& ticks) {
  std::vector<Route> routes(visits.robots());
  for (RobotId robot = 0; robot < visits.robots(); ++robot) {
    for (VisitId id = visits.first_of(robot); id != kNoVisit; id = visits[id].after) {
      routes[robot].push_back({visits[id].cell, static_cast<Tick>(ticks[id])});
    }
  }
  return routes;
}

class UnitImprover {
 public:
  UnitImprover(const Instance& instance, const PlannerOptions& options, const FreeGrid& grid,
               SharedDistances& distances, Clock::time_point begin)
      : instance_(instance),
        options_(options),
        budget_(options.improve.value_or(ImproveBudget{})),
        reach_cells_(std::clamp(2 * largest_radius_cells(instance), kMinRadiusCells, 1.0)),
        unit_move_s_(1 / instance.agents.front().speed_cells_per_s),
        stream_(Random(options.seed).next()),
        begin_(begin),
        grid_(grid),
        moves_(grid, reach_cells_),
        distances_(distances) {
    limits_.deadline = deadline_after(begin_, budget_.seconds);
    limits_.stop = options.stop;
    for (RobotId robot = 0; robot < instance.agents.size(); ++robot) {
      least_.flowtime += distances.least_arrival(robot);
      least_.makespan = std::max(least_.makespan, distances.least_arrival(robot));
    }
  }

  /// False if there are no times for it.
  bool begin(Visits visits, const PlanCost& cost) {
    note_progress(cost);
    return retime(std::move(visits));
  }

  void run(std::uint64_t most_expansions) {
    const std::uint64_t& done = log_.iterations;
    while (done < budget_.iterations && statistics_.expansions < most_expansions && !is_optimal() &&
           !is_stale()) {
      log_.was_cut_short = limits_.is_over();
      if (log_.was_cut_short) break;
      play_round(std::min(kIterationsPerRound, budget_.iterations - done));
      if (journal_.size() > plan().robots()) roll_back();
      if (unretimed_ < kExpansionsPerVisit * visits_ || !journal_.empty()) continue;
      retime(visits_of_plan());
      note_progress(cost_s());
    }
  }

  UnitImprovement take() {
    roll_back();
    Visits visits = visits_of_plan();
    visits.remove_round_trips();
    UnitSchedule schedule = unit_schedule(grid_, visits, reach_cells_, unit_move_s_);
    PLANNER_ASSERT(schedule.circle.empty());  // it has times in ticks, which are longer
    UnitImprovement result;
    result.solution = std::move(schedule.solution);
    result.order = longest_kept_order(instance_, visits, schedule.arrivals_s, options_.ssi_s);
    note_progress({flowtime_s(result.solution), makespan_s(result.solution)});
    result.log = std::move(log_);
    result.statistics = statistics_;
    return result;
  }

 private:
  /// Whether all robots arrive as early as alone.
  bool is_optimal() const { return best_.flowtime <= least_.flowtime && best_.makespan <= least_.makespan; }

  /// Whether the last iterations gained next to nothing.
  bool is_stale() {
    if (log_.iterations < next_look_) return false;
    const double now = value(options_.objective, best_);
    const bool stale = next_look_ > 0 && now > (1 - kLeastGain) * value_at_look_;
    next_look_ = log_.iterations + kIterationsPerLook * plan().robots();
    value_at_look_ = now;
    return stale;
  }

  const Timetable& plan() const { return workers_.front()->plan(); }

  PlanCost cost_s() const {
    const double tick_s = unit_move_s_ / kTicksPerMove;
    return {static_cast<double>(cost_.flowtime) * tick_s, cost_.makespan * tick_s};
  }

  void note_progress(const PlanCost& cost) {
    log_.curve.push_back({seconds_since(begin_), log_.iterations, cost});
  }

  Visits visits_of_plan() const {
    VisitCollector collector(grid_.size());
    for (RobotId robot = 0; robot < plan().robots(); ++robot) {
      const Route& route = plan().route(robot);
      collector.add_robot(route.front().cell);
      for (std::size_t i = 1; i < route.size(); ++i) {
        collector.add_move(route[i].cell, route[i].arrival - kMoveTicks, route[i].arrival);
      }
    }
    std::optional<Visits> visits = std::move(collector).take();
    PLANNER_ASSERT(visits.has_value());
    return std::move(*visits);
  }

  /// The earliest times for the plan's paths and orders; false if there are none.
  bool retime(Visits visits) {
    visits.remove_round_trips();
    const std::vector<std::int64_t> ticks = unit_ticks(grid_, visits, reach_cells_);
    if (ticks.size() != visits.size()) return false;
    const std::vector<Route> routes = routes_of(visits, ticks);
    workers_.resize(std::max(options_.threads, 1U));
    for_each_in_parallel(workers_.size(), workers_.size(), [&](std::size_t, std::size_t i) {
      workers_[i] = std::make_unique<UnitWorker>(moves_, distances_, routes);
    });
    best_ = cost_ = workers_.front()->cost();
    slack_ = kSlack * value(options_.objective, best_) / static_cast<double>(plan().robots());
    journal_.clear();
    visits_ = visits.size();
    unretimed_ = 0;
    return true;
  }

  /// Tries some neighbourhoods of the same plan, then takes over what makes it no worse, in the order of
  /// their numbers, so that it does not matter which thread tried which.
  void play_round(std::uint64_t iterations) {
    const UnitRound round{options_.objective, paths_, cost_, value(options_.objective, best_) + slack_};
    std::vector<UnitAttempt> attempts(iterations);
    for_each_in_parallel(workers_.size(), attempts.size(), [&](std::size_t worker, std::size_t i) {
      attempts[i] = workers_[worker]->attempt(round, Random(stream_ + log_.iterations + i));
    });
    std::vector<RobotId> changed;
    for (const UnitAttempt& attempt : attempts) {
      ++log_.iterations;
      statistics_ += attempt.work;
      unretimed_ += attempt.work.expansions;
      paths_.learn(
          attempt.path, attempt.gain,
          static_cast<double>(attempt.work.expansions + kExpansionsPerRobot * attempt.robots.size()));
      if (attempt.is_accepted) take_over(round, attempt, changed);
    }
  }

  void take_over(const UnitRound& round, const UnitAttempt& attempt, std::vector<RobotId>& changed) {
    const auto is_changed = [&](RobotId robot) {
      return std::find(changed.begin(), changed.end(), robot) != changed.end();
    };
    if (std::any_of(attempt.robots.begin(), attempt.robots.end(), is_changed)) return;
    std::vector<Route> before = workers_.front()->take_over(round, attempt, cost_);
    if (before.empty()) return;
    for (std::size_t i = 1; i < workers_.size(); ++i) workers_[i]->replace(attempt.robots, attempt.found);
    changed.insert(changed.end(), attempt.robots.begin(), attempt.robots.end());
    if (is_better(options_.objective, cost_, best_)) {
      best_ = cost_;
      journal_.clear();
      ++log_.improvements;
    } else {
      journal_.push_back({attempt.robots, std::move(before)});
    }
  }

  /// Back to the best plan.
  void roll_back() {
    for (; !journal_.empty(); journal_.pop_back()) {
      for (const auto& worker : workers_) worker->replace(journal_.back().robots, journal_.back().routes);
    }
    cost_ = best_;
  }

  /// The routes of some robots before a change.
  struct Change {
    std::vector<RobotId> robots;
    std::vector<Route> routes;
  };

  const Instance& instance_;
  const PlannerOptions& options_;
  ImproveBudget budget_;
  double reach_cells_;
  double unit_move_s_;
  std::uint64_t stream_;  ///< where the seeds of the iterations begin
  Clock::time_point begin_;
  SearchLimits limits_;
  const FreeGrid& grid_;
  UnitMoves moves_;
  SharedDistances& distances_;
  std::vector<std::unique_ptr<UnitWorker>> workers_;  ///< the same plan, once for each thread
  Roulette<kUnitWays> paths_;
  UnitCost cost_;
  UnitCost best_;
  UnitCost least_;               ///< of robots that are alone
  double slack_ = 0;             ///< by which a plan may be worse than the best one, in ticks
  std::uint64_t next_look_ = 0;  ///< iterations
  double value_at_look_ = 0;     ///< what the best plan cost at the last look
  std::vector<Change> journal_;  ///< from the best plan to this one
  std::size_t visits_ = 0;
  std::uint64_t unretimed_ = 0;  ///< expansions since the last times for all
  ImprovementLog log_;
  SearchStatistics statistics_;
};

}  // namespace

std::optional<UnitImprovement> improve_unit_moves(const Instance& instance, const Solution& given,
                                                  const PlannerOptions& options,
                                                  std::uint64_t most_expansions) {
  const Clock::time_point begin = Clock::now();
  if (instance.agents.empty() || find_beyond_complete(instance, options.rules)) return std::nullopt;
  const FreeGrid grid(instance.map);
  std::optional<Visits> visits = unit_visits(instance, grid, given);
  if (!visits) return std::nullopt;
  std::vector<CellId> starts;
  std::vector<CellId> goals;
  for (const Agent& agent : instance.agents) {
    starts.push_back(grid.id(agent.start));
    goals.push_back(grid.id(agent.goal));
  }
  SharedDistances distances(grid, starts, goals);
  UnitImprover improver(instance, options, grid, distances, begin);
  const PlanCost before{flowtime_s(given), makespan_s(given)};
  if (!improver.begin(std::move(*visits), before)) return std::nullopt;
  improver.run(most_expansions);
  UnitImprovement result = improver.take();
  if (is_better(options.objective, before, result.log.curve.back().cost)) return std::nullopt;
  return result;
}

}  // namespace sipplab
