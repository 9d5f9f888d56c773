#include "planner/unit_moves/improve_unit_moves.hpp"

#include <algorithm>
#include <memory>
#include <utility>
#include <vector>

#include "planner/complete/complete_planner.hpp"
#include "planner/core/attempts.hpp"
#include "planner/core/clock.hpp"
#include "planner/improve/objective.hpp"
#include "planner/retime/steps.hpp"
#include "planner/retime/unit_schedule.hpp"
#include "planner/unit_moves/replica.hpp"

namespace sipplab {
namespace {

/// Iterations between two looks at what ends the improvement.
constexpr std::uint64_t kIterationsPerRound = 64;

/// Expansions, for each visit of a robot to a cell, after which all robots get the earliest times for their
/// routes.
constexpr std::uint64_t kExpansionsPerVisit = 8;

/// Iterations for each robot in which the plan must become better by this share, or the search goes
/// elsewhere. (Paper's warehouse with 160 robots, 10 s, eight runs: flowtime 3,620, 3,587 and 3,583 with 40,
/// 80 and 160.)
constexpr std::uint64_t kIterationsPerLook = 80;
constexpr double kLeastGain = 0.002;

/// It wanders for this many iterations a robot, and meanwhile accepts plans that are worse by up to this
/// share. (Paper's warehouse with 160 robots, 30 s, four instances: flowtime 3,578 without, 3,515 to 3,524
/// with 4 or 8 iterations, 1 or 2 %, and beginning at plans that are worse by up to 0, 0.2 or 0.5 %.)
constexpr std::uint64_t kIterationsOfWandering = 8;
constexpr double kWandersBy = 0.02;
/// It begins at the last plan, or at the best one if that is better by more than this share.
constexpr double kWandersFrom = 0.005;
/// Share of the budget after which it wanders no more, to leave time for other paths.
constexpr double kShareOfWandering = 0.8;
/// So often in succession it may wander and find nothing better. (Trial runs of 20 s, random-32-32-20 with
/// 200 robots and the paper's warehouse with 160: at most twice in vain before it found a better plan.)
constexpr int kMostInVain = 10;

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
        moves_(grid, reach_cells_) {
    limits_.deadline = deadline_after(begin_, budget_.seconds);
    limits_.stop = options.stop;
    for (unsigned i = 0; i < std::max(options.threads, 1U); ++i) {
      replicas_.push_back(std::make_unique<UnitReplica>(moves_, distances, options.objective, limits_));
    }
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
    while (done < budget_.iterations && statistics_.expansions < most_expansions && !is_optimal()) {
      log_.was_cut_short = limits_.is_over();
      if (log_.was_cut_short || (done >= next_look_ && !look())) break;
      iterate(std::min(kIterationsPerRound, budget_.iterations - done));
      if (unretimed_ < kExpansionsPerVisit * visits_ || is_wandering_ || !first().is_at_best()) continue;
      retime(visits_of_plan());
      if (is_better(options_.objective, cost_s(), log_.curve.back().cost)) note_progress(cost_s());
    }
  }

  UnitImprovement take() {
    first().roll_back();
    if (!kept_.empty()) keep_best();
    if (!kept_.empty() && is_better(options_.objective, kept_cost_, first().best())) first().begin(kept_);
    PLANNER_ASSERT(!is_better(options_.objective, first().least(), first().best()));
    Visits visits = visits_of_plan();
    visits.remove_round_trips();
    UnitSchedule schedule = unit_schedule(grid_, visits, reach_cells_, unit_move_s_);
    PLANNER_ASSERT(schedule.circle.empty());  // it has times in ticks, which are longer
    UnitImprovement result;
    result.solution = std::move(schedule.solution);
    result.order = longest_kept_order(instance_, visits, schedule.arrivals_s, options_.ssi_s);
    note_progress({flowtime_s(result.solution), makespan_s(result.solution)});
    log_.improvements = first().improvements();
    result.log = std::move(log_);
    result.statistics = statistics_;
    return result;
  }

 private:
  /// Whether all robots arrive as early as alone.
  bool is_optimal() const {
    const UnitCost& best = first().best();
    return best.flowtime <= least_.flowtime && best.makespan <= least_.makespan;
  }

  /// Iterated local search (Lourenco, Martin and Stutzle, 2003): where the last iterations gained next to
  /// nothing, the search goes on at a plan that is a little worse. False if that is no use any more.
  bool look() {
    if (is_wandering_) {
      const bool has_found = is_better(options_.objective, first().best(), kept_cost_);
      for (const auto& replica : replicas_) {
        if (has_found) replica->roll_back();
        replica->stay();
      }
      is_wandering_ = false;
    } else if (next_look_ > 0 &&
               value(options_.objective, first().best()) > (1 - kLeastGain) * value_at_look_) {
      keep_best();
      if (in_vain_ >= kMostInVain || is_late()) return false;
      wander();
      next_look_ = log_.iterations + kIterationsOfWandering * plan().robots();
      return true;
    }
    value_at_look_ = value(options_.objective, first().best());
    next_look_ = log_.iterations + kIterationsPerLook * plan().robots();
    return true;
  }

  bool is_late() const {
    return seconds_since(begin_) >= kShareOfWandering * budget_.seconds ||
           static_cast<double>(log_.iterations) >=
               kShareOfWandering * static_cast<double>(budget_.iterations);
  }

  void wander() {
    const bool is_far = value(options_.objective, first().best()) >
                        (1 + kWandersFrom) * value(options_.objective, kept_cost_);
    for_each_in_parallel(replicas_.size(), replicas_.size(), [&](std::size_t, std::size_t i) {
      if (is_far) replicas_[i]->begin(kept_);
      replicas_[i]->wander(kWandersBy);
    });
    is_wandering_ = true;
  }

  /// Back to the best plan since the last wandering, which is kept if it is the best of all.
  void keep_best() {
    for (const auto& replica : replicas_) replica->roll_back();
    retime(visits_of_plan());
    ++in_vain_;
    if (!kept_.empty() && !is_better(options_.objective, first().best(), kept_cost_)) return;
    in_vain_ = 0;
    kept_.clear();
    for (RobotId robot = 0; robot < plan().robots(); ++robot) kept_.push_back(plan().route(robot));
    kept_cost_ = first().best();
  }

  UnitReplica& first() { return *replicas_.front(); }
  const UnitReplica& first() const { return *replicas_.front(); }
  const Timetable& plan() const { return first().plan(); }

  PlanCost cost_s() const {
    const double tick_s = unit_move_s_ / kTicksPerMove;
    const UnitCost& cost = first().cost();
    return {static_cast<double>(cost.flowtime) * tick_s, cost.makespan * tick_s};
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
    for_each_in_parallel(replicas_.size(), replicas_.size(),
                         [&](std::size_t, std::size_t i) { replicas_[i]->begin(routes); });
    visits_ = visits.size();
    unretimed_ = 0;
    return true;
  }

  /// Tries changes of the plan, and takes over those that make it little worse at most, in the order of their
  /// numbers.
  void iterate(std::uint64_t iterations) {
    const std::vector<UnitAttempt> attempts = attempt_and_settle<UnitAttempt>(
        replicas_.size(), iterations,
        [&, begin = stream_ + log_.iterations](std::size_t worker, std::size_t i) {
          return replicas_[worker]->attempt(Random(begin + i));
        },
        [&](std::size_t worker, const UnitAttempt& attempt) { replicas_[worker]->settle(attempt); });
    for (const UnitAttempt& attempt : attempts) {
      if (attempt.was_cut_short) break;
      ++log_.iterations;
      statistics_ += attempt.work;
      unretimed_ += attempt.work.expansions;
    }
  }

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
  std::vector<std::unique_ptr<UnitReplica>> replicas_;  ///< one for each thread
  UnitCost least_;                                      ///< of robots that are alone
  std::uint64_t next_look_ = 0;                         ///< iterations
  double value_at_look_ = 0;                            ///< what the best plan cost at the last look
  bool is_wandering_ = false;
  std::vector<Route> kept_;  ///< the best plan when the search went elsewhere last
  UnitCost kept_cost_;
  int in_vain_ = 0;  ///< how often it wandered since that plan was found
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
