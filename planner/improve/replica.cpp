#include "planner/improve/replica.hpp"

#include <algorithm>

namespace sipplab {

Round Replica::round() const {
  return {givens_.instance, givens_.objective, roulette_, givens_.fastest_s, givens_.fastest_paths, cost_,
          givens_.limits};
}

Attempt Replica::attempt(Random random) {
  Attempt attempt;
  if (!saw_limit_) attempt = try_neighbourhood(round(), plan_, random);
  saw_limit_ = attempt.was_cut_short = saw_limit_ || attempt.was_cut_short;
  attempt.seen = settled_;
  return attempt;
}

bool Replica::settle(const Attempt& attempt) {
  ++settled_;
  is_over_ = is_over_ || attempt.was_cut_short;
  if (is_over_) return false;
  roulette_.learn(static_cast<std::size_t>(attempt.rule), attempt.gain,
                  static_cast<double>(attempt.work.expansions + 1));
  forget(attempt.seen);
  const auto is_changed = [&](AgentIndex robot) {
    return std::find(changed_.begin(), changed_.end(), robot) != changed_.end();
  };
  if (!attempt.is_better || std::any_of(attempt.robots.begin(), attempt.robots.end(), is_changed) ||
      !take_over(round(), attempt, changed_, plan_, cost_)) {
    return false;
  }
  changed_.insert(changed_.end(), attempt.robots.begin(), attempt.robots.end());
  changed_by_.resize(changed_.size(), settled_);
  return true;
}

void Replica::forget(std::uint64_t seen) {
  const auto count = std::upper_bound(changed_by_.begin(), changed_by_.end(), seen) - changed_by_.begin();
  changed_.erase(changed_.begin(), changed_.begin() + count);
  changed_by_.erase(changed_by_.begin(), changed_by_.begin() + count);
}

}  // namespace sipplab
