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
  const bool is_first = worker_ == nullptr;
  worker_ = std::make_unique<UnitWorker>(moves_, distances_, plan);
  cost_ = worker_->cost();
  stay();
  if (is_first || is_better(objective_, cost_, least_)) least_ = cost_;
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
    if (!is_better(objective_, best_, least_)) return;
    least_ = best_;
    ++improvements_;
  } else {
    journal_.push_back({attempt.robots, std::move(before)});
    if (!is_wandering_ && journal_.size() > plan().robots()) roll_back();
  }
}

void UnitReplica::roll_back() {
  for (; !journal_.empty(); journal_.pop_back()) {
    worker_->replace(journal_.back().robots, journal_.back().routes);
  }
  cost_ = best_;
}

void UnitReplica::wander(double share) {
  slack_ = share * value(objective_, best_);
  is_wandering_ = true;
}

void UnitReplica::stay() {
  best_ = cost_;
  slack_ = kSlack * value(objective_, best_) / static_cast<double>(plan().robots());
  is_wandering_ = false;
  journal_.clear();
}

}  // namespace sipplab
