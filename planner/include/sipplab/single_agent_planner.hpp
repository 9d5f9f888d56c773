// What prioritized planning needs from a planner for one robot, and what it tells it. Start-safe intervals
// and re-scheduling use only this interface, so they work with any planner that can respect Reservations.
#pragma once

#include <atomic>
#include <chrono>
#include <cstdint>
#include <optional>
#include <span>

#include "sipplab/error.hpp"
#include "sipplab/instance.hpp"
#include "sipplab/solution.hpp"

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

/// Until when work may go on.
struct TimeLimits {
  std::optional<std::chrono::steady_clock::time_point> deadline;
  /// Set from outside, for example by a signal: ends the work like a deadline.
  const std::atomic<bool>* stop = nullptr;

  /// Whether the deadline has passed or `stop` is set.
  bool is_over() const {
    return (stop != nullptr && stop->load(std::memory_order_relaxed)) ||
           (deadline && std::chrono::steady_clock::now() >= *deadline);
  }
};

/// What one search may spend.
struct SearchLimits : TimeLimits {
  std::uint64_t max_expansions = UINT64_MAX;
  /// Later arrivals are of no use: a search may end with kNoPath as soon as its heuristic rules out an
  /// arrival by this time.
  double latest_arrival_s = kForever;
};

/// The space-time that planned robots, dynamic obstacles and protected starts occupy.
class Reservations {
 public:
  virtual ~Reservations() = default;

  /// Maximal closed spans in which a disk of this radius may stay at the cell, in order. Valid until
  /// another radius is asked for, and during one search.
  virtual std::span<const SafeInterval> safe_intervals(Cell cell, double radius_cells) = 0;

  /// The least departure t >= from_s, in seconds, for which the straight move overlaps nothing. Gives up as
  /// soon as every departure up to until_s is known to be unsafe and then returns some lower bound on the
  /// least safe departure that is greater than until_s; kForever if no departure from from_s on is safe.
  /// REQUIRES: two different cells of the map.
  virtual double earliest_departure(Cell from, Cell to, double speed_cells_per_s, double radius_cells,
                                    double from_s, double until_s) const = 0;
};

/// For one thread at a time, const functions, too: they may remember what they find out.
class SingleAgentPlanner {
 public:
  virtual ~SingleAgentPlanner() = default;

  /// A trajectory for `agent` of the instance given at construction that collides with nothing in
  /// `reservations`, or the reason why none was found. Adds its work to `statistics` in every case.
  virtual Expected<Trajectory, PlanFailure> plan(AgentIndex agent, Reservations& reservations,
                                                 const SearchLimits& limits,
                                                 SearchStatistics& statistics) = 0;

  /// A trajectory that follows the given one, or cuts its corners, and arrives no later. None if this planner
  /// cannot do that, or if the given one collides with something in `reservations`.
  virtual std::optional<Trajectory> tighten(AgentIndex /*agent*/, const Trajectory& /*given*/,
                                            Reservations& /*reservations*/) {
    return std::nullopt;
  }

  /// A lower bound on the travel time of `agent`, in seconds, for initial orders.
  virtual double lower_bound_s(AgentIndex agent) const = 0;
};

}  // namespace sipplab
