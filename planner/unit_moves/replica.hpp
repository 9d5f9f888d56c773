// One thread's copy of the plan that is improved by unit moves, and of what is learned meanwhile.
#pragma once

#include <memory>
#include <vector>

#include "planner/unit_moves/attempt.hpp"

namespace sipplab {

/// Replicas that begin with the same plan, settle the same attempts and wander at the same time are the same.
class UnitReplica {
 public:
  /// All must outlive this.
  UnitReplica(const UnitMoves& moves, SharedDistances& distances, const Objective& objective,
              const SearchLimits& limits);

  /// Begins again, with a plan that is the best one from then on; keeps what was learned. REQUIRES: robots.
  void begin(const std::vector<Route>& plan);

  const Timetable& plan() const { return worker_->plan(); }
  const UnitCost& cost() const { return cost_; }
  /// Of the best plan since it began, or stayed, here.
  const UnitCost& best() const { return best_; }
  /// Of the best plan of all.
  const UnitCost& least() const { return least_; }
  /// Whether the plan is the best one since it came here.
  bool is_at_best() const { return journal_.empty(); }
  /// How often a plan was better than all before.
  std::uint64_t improvements() const { return improvements_; }

  UnitAttempt attempt(Random random);
  /// Takes over an attempt if it still fits and makes the plan better, or not much worse than the best one.
  void settle(const UnitAttempt& attempt);
  /// Back to the best plan.
  void roll_back();
  /// From then on takes over plans that are worse than the best one by up to a share of its value.
  void wander(double share);
  /// Ends that: the plan is the best one from then on.
  void stay();

 private:
  /// The routes of some robots before a change.
  struct Change {
    std::vector<RobotId> robots;
    std::vector<Route> routes;
  };

  UnitRound round() const;

  const UnitMoves& moves_;
  SharedDistances& distances_;
  const Objective& objective_;
  const SearchLimits& limits_;
  std::unique_ptr<UnitWorker> worker_;
  Roulette<kUnitWays> paths_;
  UnitCost cost_;
  UnitCost best_;
  UnitCost least_;
  double slack_ = 0;  ///< by which a plan may be worse than the best one, in ticks
  bool is_wandering_ = false;
  std::vector<Change> journal_;  ///< from the best plan to this one
  std::uint64_t improvements_ = 0;
  bool saw_limit_ = false;  ///< it makes no more attempts
  bool is_over_ = false;    ///< it settles no more
};

}  // namespace sipplab
