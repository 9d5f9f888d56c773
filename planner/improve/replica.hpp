// One thread's copy of the plan that is improved, and of what is learned meanwhile.
#pragma once

#include <cstdint>
#include <vector>

#include "planner/improve/attempt.hpp"

namespace sipplab {

/// What all replicas share and no iteration changes.
struct Givens {
  const Instance& instance;
  const Objective& objective;
  const std::vector<double>& fastest_s;          ///< by robot: arrivals on fastest_paths
  const std::vector<Trajectory>& fastest_paths;  ///< by robot, alone on the map
  const SearchLimits& limits;
};

/// Replicas that begin with the same plan and settle the same attempts are the same.
class Replica {
 public:
  /// Without robots yet. All must outlive this.
  Replica(const Givens& givens, double ssi_s, SingleAgentPlanner& planner)
      : givens_(givens), plan_(givens.instance, ssi_s, planner) {}

  PartialPlan& plan() { return plan_; }
  const PartialPlan& plan() const { return plan_; }
  const PlanCost& cost() const { return cost_; }
  /// After the plan was changed from outside.
  void set_cost(const PlanCost& cost) { cost_ = cost; }

  Attempt attempt(Random random);
  /// Takes over an attempt if it still fits and makes the plan better. Returns whether it was. What a limit
  /// cut short does not count, nor what comes after it: the plan depends on the number of attempts alone.
  bool settle(const Attempt& attempt);

 private:
  Round round() const;
  /// Forgets changes that an attempt has seen.
  void forget(std::uint64_t seen);

  const Givens& givens_;
  PartialPlan plan_;
  PlanCost cost_;
  RuleRoulette roulette_;
  std::uint64_t settled_ = 0;              ///< attempts
  std::vector<AgentIndex> changed_;        ///< robots that attempts still to be settled may not have seen so
  std::vector<std::uint64_t> changed_by_;  ///< the number of the attempt, ascending
  bool saw_limit_ = false;                 ///< it makes no more attempts
  bool is_over_ = false;                   ///< it settles no more
};

}  // namespace sipplab
