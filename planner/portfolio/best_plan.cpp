#include "planner/portfolio/best_plan.hpp"

#include <algorithm>
#include <optional>
#include <utility>

#include "planner/complete/complete_planner.hpp"
#include "planner/prioritized/limits.hpp"

namespace sipplab {
namespace {

/// Restarts of the method of the options: where it needs many more, ejection is faster.
/// (Trials on the paper's warehouse: 3 tries on average at 128 robots, 11 at 160.)
constexpr std::uint64_t kMethodRestarts = 1;
/// Restarts with each longer start-safe interval.
constexpr std::uint64_t kEscalationRestarts = 0;
/// Robots that may fail during ejection, for each robot of the instance. (Trials: one for
/// every three robots at 192 in the paper's warehouse.)
constexpr std::uint64_t kEjectionRestartsPerRobot = 4;
/// Share of the time limit in which a plan must have been found; then the fallback makes one.
/// The rest is for improvement, which a plan of the fallback needs more than any other.
constexpr double kShareBeforeFallback = 0.3;

class BestPlan {
 public:
  BestPlan(const Instance& instance, const BestOptions& options)
      : instance_(instance),
        options_(options),
        has_fallback_(!find_beyond_complete(instance, options.planner.rules)),
        begin_(Clock::now()) {}

  BestResult run() {
    const PlannerOptions& planner = options_.planner;
    const bool is_found =
        take(BestStep::Kind::kMethod, planner.ssi_s) || escalate(BestStep::Kind::kEscalation) ||
        take(BestStep::Kind::kEjection, planner.ssi_s) || escalate(BestStep::Kind::kEjection) ||
        take(BestStep::Kind::kFallback, planner.ssi_s);
    if (is_found) improve_it();
    return std::move(result_);
  }

 private:
  double time_left_s() const { return options_.planner.time_limit_s - seconds_since(begin_); }

  /// Until the fallback must have its turn.
  double time_before_fallback_s() const {
    const double share = has_fallback_ ? kShareBeforeFallback : 1;
    return options_.planner.time_limit_s * share - seconds_since(begin_);
  }

  bool escalate(BestStep::Kind kind) {
    return std::any_of(options_.longer_ssi_s.begin(), options_.longer_ssi_s.end(),
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

  /// The options of a step; none where it cannot be taken. The first one always can, others
  /// only where something is left of every limit; the fallback has the counts anew.
  std::optional<PlannerOptions> options_of(BestStep::Kind kind, double ssi_s) const {
    const PlanResult& before = result_.plan;
    const bool is_first = result_.steps.empty();
    PlannerOptions step = options_.planner;
    step.ssi_s = ssi_s;
    step.fallback = Fallback::kNone;
    if (kind == BestStep::Kind::kFallback) {
      if (!has_fallback_) return std::nullopt;
      step.method = Method::kComplete;
      step.time_limit_s = time_left_s();
      return step;
    }
    if (!is_first) {
      if (before.tries() > step.max_restarts || before.statistics.expansions >= step.max_expansions) {
        return std::nullopt;
      }
      step = left_of(step, before);
    }
    step.time_limit_s = time_before_fallback_s();
    if (!is_first && search_limits(step, Clock::now()).is_over()) return std::nullopt;
    step.max_restarts = std::min(step.max_restarts, restarts_of(kind));
    if (kind == BestStep::Kind::kEjection) step.rescheduling = Rescheduling::kEjection;
    return step;
  }

  /// Whether that gave a plan.
  bool take(BestStep::Kind kind, double ssi_s) {
    const std::optional<PlannerOptions> step = options_of(kind, ssi_s);
    if (!step) return false;
    PlanResult next = plan(instance_, *step);
    result_.steps.push_back({kind, ssi_s, next.status, next.tries(), next.planning_seconds});
    prepend(result_.plan, next);
    result_.plan = std::move(next);
    return result_.plan.status == PlanStatus::kSolved;
  }

  void improve_it() {
    ImproveOptions improving = improve_options(options_.planner, result_.plan);
    improving.objective = options_.objective;
    improving.max_iterations = options_.max_iterations;
    improving.threads = options_.threads;
    improving.time_limit_s = std::min(options_.improve_time_limit_s, time_left_s());
    result_.improvement = improve(instance_, result_.plan.solution, result_.plan.order(), improving);
  }

  const Instance& instance_;
  const BestOptions& options_;
  bool has_fallback_;  ///< whether the complete planner knows such instances
  Clock::time_point begin_;
  BestResult result_;
};

}  // namespace

std::string_view name(BestStep::Kind kind) {
  switch (kind) {
    case BestStep::Kind::kMethod:
      return "method";
    case BestStep::Kind::kEscalation:
      return "escalation";
    case BestStep::Kind::kEjection:
      return "ejection";
    case BestStep::Kind::kFallback:
      return "fallback";
  }
  return "unknown";
}

BestResult plan_best(const Instance& instance, const BestOptions& options) {
  return BestPlan(instance, options).run();
}

}  // namespace sipplab
