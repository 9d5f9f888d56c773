#include "planner/unit_moves/replica.hpp"

#include <utility>

namespace sipplab {
namespace {

/// By how much a plan may be worse than the best one, as a share of a robot's mean arrival: a way out of
/// plans that no change of a few robots makes better. (In trials none of it, and four times as much, gave
/// dearer plans.)
constexpr double kSlack = 1.0 / 6;

/// What it takes to put a robot out of the plan and in again, in expansions.
constexpr std::uint64_t kExpansionsPerRobot = 100;

}  // namespace

UnitReplica::UnitReplica(const UnitMoves& moves, SharedDistances& distances, const Objective& objective,
                         const SearchLimits& limits)
    : moves_(moves), distances_(distances), objective_(objective), limits_(limits) {}

void UnitReplica::begin(const std::vector<Route>& plan) {
  worker_ = std::make_unique<UnitWorker>(moves_, distances_, plan);
  best_ = cost_ = worker_->cost();
  slack_ = kSlack * value(objective_, best_) / static_cast<double>(plan.size());
  journal_.clear();
}

UnitRound UnitReplica::round() const {
  return {objective_, paths_, cost_, value(objective_, best_) + slack_};
}

UnitAttempt UnitReplica::attempt(Random random) {
  UnitAttempt attempt;
  saw_limit_ = saw_limit_ || limits_.is_over();
  if (!saw_limit_) attempt = worker_->attempt(round(), random);
  attempt.was_cut_short = saw_limit_;
  return attempt;
}

void UnitReplica::settle(const UnitAttempt& attempt) {
  is_over_ = is_over_ || attempt.was_cut_short;
  if (is_over_) return;
  paths_.learn(attempt.path, attempt.gain,
               static_cast<double>(attempt.work.expansions + kExpansionsPerRobot * attempt.robots.size()));
  if (!attempt.is_accepted) return;
  std::vector<Route> before = worker_->take_over(round(), attempt, cost_);
  if (before.empty() || before == attempt.found) return;  // the same as another attempt
  if (is_better(objective_, cost_, best_)) {
    best_ = cost_;
    journal_.clear();
    ++improvements_;
  } else {
    journal_.push_back({attempt.robots, std::move(before)});
    if (journal_.size() > plan().robots()) roll_back();
  }
}

void UnitReplica::roll_back() {
  for (; !journal_.empty(); journal_.pop_back()) {
    worker_->replace(journal_.back().robots, journal_.back().routes);
  }
  cost_ = best_;
}

}  // namespace sipplab
