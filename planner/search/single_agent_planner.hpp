// What prioritized planning needs from a planner for one robot. Start-safe intervals and re-scheduling use
// only this interface, so they work with any planner that can respect a ReservationTable.
#pragma once

#include <algorithm>
#include <atomic>
#include <chrono>
#include <cstdint>
#include <optional>

#include "planner/core/expected.hpp"
#include "planner/instance/instance.hpp"
#include "planner/instance/motion_rules.hpp"
#include "planner/reservation/reservation_table.hpp"
#include "planner/solution/trajectory.hpp"

namespace sipplab {

/// Why there is no trajectory.
enum class PlanFailure {
  kNoPath,          ///< the search space is exhausted
  kExpansionLimit,  ///< the budget of expansions is used up
  kTimeLimit,       ///< the deadline has passed
};

/// Work done, in counts that are the same on every machine.
struct SearchStatistics {
  std::uint64_t expansions = 0;   ///< nodes popped and expanded
  std::uint64_t generations = 0;  ///< nodes created or improved

  SearchStatistics& operator+=(const SearchStatistics& other) {
    expansions += other.expansions;
    generations += other.generations;
    return *this;
  }
};

/// What one search may spend.
struct SearchLimits {
  std::uint64_t max_expansions = UINT64_MAX;
  std::optional<std::chrono::steady_clock::time_point> deadline;
  /// Set from outside, for example by a signal: ends the search like a deadline.
  const std::atomic<bool>* stop = nullptr;
  /// Later arrivals are of no use: a search may end with kNoPath as soon as its heuristic rules out an
  /// arrival by this time.
  double latest_arrival_s = kForever;

  /// Whether the deadline has passed or `stop` is set.
  bool is_over() const {
    return (stop != nullptr && stop->load(std::memory_order_relaxed)) ||
           (deadline && std::chrono::steady_clock::now() >= *deadline);
  }
};

/// What a ReservationTable must know about an instance's robots.
inline Askers askers_of(const Instance& instance, const MotionRules& rules = {}) {
  Askers askers{largest_radius_cells(instance) + rules.inflate_distance_cells, 0, rules.inflate_time_s};
  for (const Agent& agent : instance.agents) {
    askers.max_speed_cells_per_s = std::max(askers.max_speed_cells_per_s, agent.speed_cells_per_s);
  }
  if (instance.agents.empty()) askers.max_speed_cells_per_s = 1;
  return askers;
}

class SingleAgentPlanner {
 public:
  virtual ~SingleAgentPlanner() = default;

  /// A trajectory for `agent` of the instance given at construction that collides with nothing in
  /// `reservations`, or the reason why none was found. Adds its work to `statistics` in every case.
  virtual Expected<Trajectory, PlanFailure> plan(AgentIndex agent, ReservationTable& reservations,
                                                 const SearchLimits& limits,
                                                 SearchStatistics& statistics) = 0;

  /// A lower bound on the travel time of `agent`, in seconds, for initial orders.
  virtual double lower_bound_s(AgentIndex agent) const = 0;
};

}  // namespace sipplab
