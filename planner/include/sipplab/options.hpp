// What a user may choose of a plan: values, bounds and defaults. option_table.hpp has a row for each, from
// which come flags, files and columns.
#pragma once

#include <atomic>
#include <cstdint>
#include <limits>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "sipplab/instance.hpp"

namespace sipplab {

/// Priority order of the first try. Ties by input position.
enum class InitialOrder { kFifo, kShortestFirst, kLongestFirst, kRandom };

/// What happens to the order after a robot fails.
enum class Rescheduling {
  kNone,           ///< report the failure
  kDeterministic,  ///< the failed robot to the front, until success or until an order repeats
  kRandom,         ///< seeded shuffles, none tried twice
  kEjection,       ///< the failed robot is planned and those in its way are planned again
};

/// The planner.
enum class Method {
  kPrioritized,  ///< one robot after the other, in priority order
  kComplete,     ///< all robots at once on the grid of four neighbours: planner/complete/
};

/// What to do if prioritized planning ends without a plan or reaches a limit.
enum class Fallback {
  kNone,      ///< report it
  kComplete,  ///< Method::kComplete plans
};

/// "fifo", "shortest", "longest", "random"; "none", "deterministic", "random", "ejection";
/// "prioritized", "complete"; "none", "complete".
std::string_view name(InitialOrder order);
std::string_view name(Rescheduling rescheduling);
std::string_view name(Method method);
std::string_view name(Fallback fallback);

inline constexpr double kInfiniteSsi = std::numeric_limits<double>::infinity();
/// Longest finite start-safe interval, in seconds, on the command line and in files: at 1e7 s a double tells
/// times apart to 2e-9 s; plans that begin later lose the slack with which contacts are told from overlaps.
inline constexpr double kMaxSsiS = 1e7;
/// Whether a start-safe interval may be asked for: 0 to kMaxSsiS, or infinity.
inline bool is_ssi(double ssi_s) { return (ssi_s >= 0 && ssi_s <= kMaxSsiS) || ssi_s == kInfiniteSsi; }
/// The time span of the paper's Table 1, in seconds.
inline constexpr double kDefaultSsi = 5;
/// Wall-clock seconds; the paper used five minutes.
inline constexpr double kDefaultTimeLimitS = 300;
/// Largest weight of the heuristic: no use needs a path a hundred times as long.
inline constexpr double kMaxWeight = 100;
/// Most threads of an improvement: each holds a copy of the plan.
inline constexpr unsigned kMostThreads = 64;

/// "5", "2.5", "inf", "infinity": a real number >= 0, or infinity.
std::optional<double> parse_ssi(std::string_view text);
/// Shortest text that parse_ssi reads back as the same value; "inf" for infinity.
std::string format_ssi(double ssi);

/// What improvement minimises: a weighted sum of flowtime and makespan; of two plans with the same sum the
/// one with the lesser flowtime is better, then the one with the lesser makespan.
struct Objective {
  double flowtime_weight = 1;  ///< >= 0; not both are 0
  double makespan_weight = 0;  ///< >= 0

  double of(double flowtime_s, double makespan_s) const {
    return flowtime_weight * flowtime_s + makespan_weight * makespan_s;
  }
  friend bool operator==(const Objective&, const Objective&) = default;
};

/// "flowtime", "makespan", or weights of both: "1:20" is flowtime + 20 makespan.
std::optional<Objective> parse_objective(std::string_view text);
/// Shortest text that parse_objective reads back as the same value.
std::string format_objective(const Objective& objective);

/// How long to improve. At most one of the two is a limit.
struct ImproveBudget {
  double seconds = std::numeric_limits<double>::infinity();  ///< wall clock
  std::uint64_t iterations = UINT64_MAX;

  friend bool operator==(const ImproveBudget&, const ImproveBudget&) = default;
};

/// "30", "30s": seconds > 0; "500i": iterations > 0.
std::optional<ImproveBudget> parse_improve_budget(std::string_view text);
/// "30s" or "500i"; parse_improve_budget reads it back as the same value.
/// REQUIRES: one of the two is a limit.
std::string format_improve_budget(const ImproveBudget& budget);

struct PlannerOptions {
  double ssi_s = kDefaultSsi;  ///< start-safe interval; 0 turns it off
  /// Escalation: longer start-safe intervals, tried in turn, each if the one before it fails.
  std::vector<double> longer_ssi_s;
  InitialOrder order = InitialOrder::kShortestFirst;
  Rescheduling rescheduling = Rescheduling::kDeterministic;
  bool any_angle = true;
  int connectedness = 2;  ///< 2^k neighbours, k = 2..5
  double weight = 1;      ///< of the heuristic, 1 to kMaxWeight: see SippOptions
  MotionRules rules;      ///< turns, delays, inflation; none by default
  std::uint64_t seed = 1;

  std::uint64_t max_expansions = UINT64_MAX;  ///< over all tries
  std::uint64_t max_restarts = UINT64_MAX;    ///< tries after the first; ejections count as tries
  double time_limit_s = kDefaultTimeLimitS;   ///< wall clock; infinity for none
  /// Set from outside, by a signal for one: ends planning as the time limit does.
  const std::atomic<bool>* stop = nullptr;

  Method method = Method::kPrioritized;
  /// The limits apply to it separately: it begins after they were reached.
  Fallback fallback = Fallback::kNone;

  /// All methods in turn, then improvement for what is left of the time limit.
  bool best = false;
  /// Improvement of the plan; none: no improvement, or with `best` until the time limit.
  std::optional<ImproveBudget> improve;
  Objective objective;
  unsigned threads = 1;  ///< of improvement; the result does not depend on how many

  friend bool operator==(const PlannerOptions&, const PlannerOptions&) = default;
};

struct Option;  // planner/options/option_table.hpp

/// The options that a command line or a file states; all others are left open.
class StatedOptions {
 public:
  /// False, and nothing is stated, if the text is no value of the option.
  bool state(const Option& option, std::string_view text);
  bool states(std::string_view name) const;
  bool empty() const { return stated_.empty(); }
  /// The options with what was stated.
  PlannerOptions applied_to(PlannerOptions options) const;

  friend bool operator==(const StatedOptions&, const StatedOptions&) = default;

 private:
  std::vector<std::pair<const Option*, std::string>> stated_;
};

}  // namespace sipplab
