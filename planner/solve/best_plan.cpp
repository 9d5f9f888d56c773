#include "planner/solve/best_plan.hpp"

#include <algorithm>
#include <iterator>
#include <optional>
#include <utility>

#include "planner/complete/complete_planner.hpp"
#include "planner/prioritized/limits.hpp"
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
    const bool is_found =
        take(BestStep::Kind::kMethod, options_.ssi_s) || escalate(BestStep::Kind::kEscalation) ||
        take(BestStep::Kind::kEjection, options_.ssi_s) || escalate(BestStep::Kind::kEjection);
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
      step.cost = PlanCost{flowtime_s(next.solution), makespan_s(next.solution)};
    }
    result_.steps.push_back(step);
    prepend(before, next);
    before = std::move(next);
  }

  /// The plan of the last step, which keeps the guarantee of start-safe intervals; else that of
  /// LaCAM. What the others took comes before it.
  void choose(bool is_found) {
    const bool takes_fallback = !is_found && has_fallback_;
    result_.plan = std::move(takes_fallback ? fallback_ : planned_);
    prepend(takes_fallback ? planned_ : fallback_, result_.plan);
  }

  void improve_it() {
    PlannerOptions improving = options_;
    improving.ssi_s = result_.plan.ssi_kept_s;
    ImproveBudget budget = options_.improve.value_or(ImproveBudget{});
    budget.seconds = std::min(budget.seconds, time_left_s());
    improving.improve = budget;
    result_.improvement = improve(instance_, result_.plan.solution, result_.plan.order(), improving);
  }

  const Instance& instance_;
  PlannerOptions options_;  ///< without longer intervals, which are steps of their own
  std::vector<double> longer_ssi_s_;
  bool has_fallback_;  ///< whether LaCAM knows such instances
  Clock::time_point begin_;
  PlanResult fallback_;  ///< of LaCAM; failed if it was not asked
  PlanResult planned_;   ///< of the other steps
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
