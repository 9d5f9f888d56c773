// Which orders of the robots keep the guarantee of start-safe intervals: a robot that comes near another
// robot's protected start must come after that robot. [AY18], section 3, for plans that were not made in one
// pass over an order.
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "planner/prioritized/priority_order.hpp"
#include "sipplab/instance.hpp"
#include "sipplab/solution.hpp"

namespace sipplab {

/// A graph over the robots: an edge from `owner` to each robot that crosses the start of `owner` during
/// [0, ssi_s]. While it has no cycle, any order in which edges lead from higher to lower priority keeps the
/// guarantee for all its trajectories. A new trajectory closes no cycle if it keeps off the starts of the
/// robot's followers().
class StartPrecedence {
 public:
  /// The instance must outlive it. REQUIRES: ssi_s >= 0.
  StartPrecedence(const Instance& instance, double ssi_s);

  /// The robot follows this trajectory from now on. O(motions during [0, ssi_s] * robots).
  void set(AgentIndex agent, const Trajectory& trajectory);
  /// The robot has no trajectory from now on.
  void reset(AgentIndex agent);

  /// Robots that must come after this one, in the order of a walk through the graph; never itself. O(edges).
  const std::vector<AgentIndex>& followers(AgentIndex agent);

  /// Whether the graph would have a cycle with this trajectory. O(edges + motions during [0, ssi_s] *
  /// followers). REQUIRES: it has none now, and the robot has no trajectory.
  bool closes_cycle(AgentIndex agent, const Trajectory& trajectory);

  /// An order of all robots that keeps the guarantee: of those that may come next, always the first in
  /// `preferred`. None if the graph has a cycle. O((robots + edges) log robots).
  /// REQUIRES: `preferred` is a permutation of the robots.
  std::optional<PriorityOrder> order(const PriorityOrder& preferred) const;

 private:
  bool crosses(const Agent& agent, const TimedMotion& motion, const Agent& owner) const;

  const Instance& instance_;
  double ssi_s_;
  std::vector<std::vector<AgentIndex>> crossers_;  ///< by owner of the start
  std::vector<std::vector<AgentIndex>> crossed_;   ///< by robot: owners of the starts
  std::vector<AgentIndex> found_;                  ///< of the last walk
  std::vector<std::uint64_t> seen_;                ///< by robot: the last walk that reached it
  std::uint64_t walk_ = 0;
};

}  // namespace sipplab
