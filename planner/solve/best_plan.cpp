#include "planner/solve/best_plan.hpp"

#include <algorithm>
#include <iterator>
#include <optional>
#include <utility>

#include "planner/complete/complete_planner.hpp"
#include "planner/improve/objective.hpp"
#include "planner/prioritized/limits.hpp"
#include "planner/solve/improve_stages.hpp"
#include "planner/solve/plan.hpp"
#include "sipplab/solution.hpp"
#include "sipplab/solve.hpp"

namespace sipplab {
namespace {

/// Restarts of the method of the options: if it needs many more, ejection is faster.
/// (Trials on the paper's warehouse: 3 tries on average at 128 robots, 11 at 160.)
constexpr std::uint64_t kMethodRestarts = 1;
/// Restarts with each longer start-safe interval.
constexpr std::uint64_t kEscalationRestarts = 0;
/// Robots that may fail during ejection, for each robot of the instance. (Trials: one for
/// every three robots at 192 in the paper's warehouse.)
constexpr std::uint64_t kEjectionRestartsPerRobot = 4;
/// Steps of LaCAM for a first plan. (Trials: some hundreds, however many robots.)
constexpr std::uint64_t kFirstPlanSteps = 10'000;
/// ... if LaCAM has given a plan: ejection is worth its time where few robots fail.
constexpr std::uint64_t kFewEjections = 8;
constexpr std::size_t kRobotsPerEjection = 40;
/// Expansions for improvement by unit moves before the two plans are compared: for each one that the other
/// plan took, which took ten times as long, and at least for each robot.
constexpr std::uint64_t kUnitExpansions = 10;
constexpr std::uint64_t kUnitExpansionsPerRobot = 4000;

PlanCost cost_of(const Solution& plan) { return {flowtime_s(plan), makespan_s(plan)}; }

class BestPlan {
 public:
  BestPlan(const Instance& instance, const PlannerOptions& options)
      : instance_(instance),
        options_(options),
        longer_ssi_s_(std::exchange(options_.longer_ssi_s, {})),
        has_fallback_(!find_beyond_complete(instance, options.rules)),
        begin_(Clock::now()) {
    if (longer_ssi_s_.empty()) longer_ssi_s_.assign(std::begin(kLongerSsiS), std::end(kLongerSsiS));
  }

  SolveResult run() {
    if (has_fallback_) fall_back(kFirstPlanSteps, options_.time_limit_s * kShareOfFirstPlan);
    const bool is_found = take(BestStep::Kind::kMethod, options_.ssi_s) ||
                          escalate(BestStep::Kind::kEscalation) ||
                          take(BestStep::Kind::kEjection, options_.ssi_s) ||
                          (fallback_.status != PlanStatus::kSolved && escalate(BestStep::Kind::kEjection));
    if (!is_found && fallback_.status == PlanStatus::kLimit) {
      fall_back(UINT64_MAX, time_left_s());
    }
    choose(is_found);
    if (result_.plan.status == PlanStatus::kSolved) improve_it();
    return std::move(result_);
  }

 private:
  double seconds() const { return seconds_since(begin_); }
  double time_left_s() const { return options_.time_limit_s - seconds(); }

  /// Until improvement must have its turn, or LaCAM again; without either all
  /// of the time is for the other steps.
  double time_before_improvement_s() const {
    double share = 1;
    if (fallback_.status == PlanStatus::kSolved) share = kShareBeforeImprovement;
    if (fallback_.status == PlanStatus::kLimit) share = kShareBeforeImprovement + kShareOfFirstPlan;
    return options_.time_limit_s * share - seconds();
  }

  bool escalate(BestStep::Kind kind) {
    return std::any_of(longer_ssi_s_.begin(), longer_ssi_s_.end(),
                       [this, kind](double ssi_s) { return take(kind, ssi_s); });
  }

  std::uint64_t restarts_of(BestStep::Kind kind) const {
    switch (kind) {
      case BestStep::Kind::kMethod:
        return kMethodRestarts;
      case BestStep::Kind::kEscalation:
        return kEscalationRestarts;
      case BestStep::Kind::kEjection:
        if (fallback_.status == PlanStatus::kSolved) {
          return std::max<std::uint64_t>(kFewEjections, instance_.agents.size() / kRobotsPerEjection);
        }
        return kEjectionRestartsPerRobot * instance_.agents.size();
      case BestStep::Kind::kFallback:
        return 0;
    }
    return 0;
  }

  /// The options of a step other than the fallback; none if it cannot be taken. The first
  /// one always can, others only if something is left of every limit.
  std::optional<PlannerOptions> options_of(BestStep::Kind kind, double ssi_s) const {
    const bool is_first = planned_.trace.empty();
    PlannerOptions step = options_;
    step.ssi_s = ssi_s;
    step.fallback = Fallback::kNone;
    if (!is_first) {
      if (planned_.tries() > step.max_restarts || planned_.statistics.expansions >= step.max_expansions) {
        return std::nullopt;
      }
      step = left_of(step, planned_);
    }
    step.time_limit_s = time_before_improvement_s();
    if (!is_first && search_limits(step, Clock::now()).is_over()) return std::nullopt;
    step.max_restarts = std::min(step.max_restarts, restarts_of(kind));
    if (kind == BestStep::Kind::kEjection) step.rescheduling = Rescheduling::kEjection;
    return step;
  }

  /// Whether that gave a plan.
  bool take(BestStep::Kind kind, double ssi_s) {
    const std::optional<PlannerOptions> step = options_of(kind, ssi_s);
    if (!step) return false;
    take_step(kind, *step, planned_);
    return planned_.status == PlanStatus::kSolved;
  }

  /// LaCAM, which has the counts of the limits for itself.
  void fall_back(std::uint64_t most_steps, double time_limit_s) {
    PlannerOptions step = options_;
    step.method = Method::kComplete;
    step.max_expansions = std::min(step.max_expansions, most_steps);
    step.time_limit_s = time_limit_s;
    take_step(BestStep::Kind::kFallback, step, fallback_);
  }

  /// Its tries and work are added to those of `before`, whose plan is none.
  void take_step(BestStep::Kind kind, const PlannerOptions& options, PlanResult& before) {
    PlanResult next = plan(instance_, options);
    BestStep step{kind, options.ssi_s, next.status, next.tries(), next.planning_seconds, seconds(), {}};
    if (next.status == PlanStatus::kSolved) {
      step.cost = cost_of(next.solution);
    }
    result_.steps.push_back(step);
    prepend(before, next);
    before = std::move(next);
  }

  /// The plan that is cheaper, that of LaCAM after some improvement; of the same cost the one
  /// that keeps the guarantee of start-safe intervals. What the others took comes before it.
  void choose(bool is_found) {
    const bool takes_fallback = !is_found ? has_fallback_ : fallback_.status == PlanStatus::kSolved && wins();
    if (!takes_fallback) begun_.reset();
    result_.plan = std::move(takes_fallback ? fallback_ : planned_);
    prepend(takes_fallback ? planned_ : fallback_, result_.plan);
  }

  /// Whether the plan of LaCAM is the better one after the work that the other one took, and with its corners
  /// cut, as those of the other one are. (Four instances each: improvement ends with the better plan then in
  /// all of the warehouse with 96 and 128 robots and in 7 of 8 of the empty map with 128 and 192; with 32 and
  /// 64 in the warehouse both ends are within 2 %.)
  bool wins() {
    PlannerOptions improving = options_;
    const ImproveBudget budget = options_.improve.value_or(ImproveBudget{});
    const double most_s = time_left_s() * kShareBeforeImprovement;
    improving.improve = budget_of_unit_moves(budget);
    improving.improve->seconds = std::min(improving.improve->seconds, most_s);
    begun_ = improve_unit_moves(instance_, fallback_.solution, improving,
                                std::max(kUnitExpansions * planned_.statistics.expansions,
                                         kUnitExpansionsPerRobot * instance_.agents.size()));
    PlanCost cost = cost_of(begun_ ? begun_->solution : fallback_.solution);
    if (begun_ && budget.iterations > 0) {
      const Clock::time_point before = Clock::now();
      improving.improve->seconds = most_s;
      cost = tightened_cost(instance_, *begun_, improving);
      begun_->log.curve.back().seconds += seconds_since(before);
    }
    return is_better(options_.objective, cost, cost_of(planned_.solution));
  }

  void improve_it() {
    PlannerOptions improving = options_;
    ImproveBudget budget = options_.improve.value_or(ImproveBudget{});
    if (begun_) budget.iterations -= begun_->log.iterations;
    budget.seconds = std::min(budget.seconds, time_left_s());
    improving.improve = budget;
    result_.improvement = improve_in_stages(instance_, result_.plan, improving, begun_);
  }

  const Instance& instance_;
  PlannerOptions options_;  ///< without longer intervals, which are steps of their own
  std::vector<double> longer_ssi_s_;
  bool has_fallback_;  ///< whether LaCAM knows such instances
  Clock::time_point begin_;
  PlanResult fallback_;  ///< of LaCAM; failed if it was not asked
  PlanResult planned_;   ///< of the other steps
  Begun begun_;          ///< of the plan of LaCAM
  SolveResult result_;
};

}  // namespace

std::string_view name(BestStep::Kind kind) {
  constexpr std::string_view kNames[] = {"method", "escalation", "ejection", "fallback"};
  return kNames[static_cast<std::size_t>(kind)];
}

SolveResult best_plan(const Instance& instance, const PlannerOptions& options) {
  return BestPlan(instance, options).run();
}

}  // namespace sipplab
