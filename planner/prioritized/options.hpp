// Options of a run of prioritized planning, and their names as users write them.
#pragma once

#include <atomic>
#include <cstdint>
#include <limits>
#include <optional>
#include <string>
#include <string_view>

#include "planner/instance/motion_rules.hpp"

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

/// Who plans.
enum class Method {
  kPrioritized,  ///< one robot after the other, in priority order
  kComplete,     ///< all robots at once on the grid of four neighbours: planner/complete/
};

/// What happens where prioritized planning ends without a plan, or at its limit.
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
std::optional<InitialOrder> parse_initial_order(std::string_view text);
std::optional<Rescheduling> parse_rescheduling(std::string_view text);
std::optional<Method> parse_method(std::string_view text);
std::optional<Fallback> parse_fallback(std::string_view text);

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

/// "5", "2.5", "inf", "infinity": a real number >= 0, or infinity.
std::optional<double> parse_ssi(std::string_view text);
/// Shortest text that parse_ssi reads back as the same value; "inf" for infinity.
std::string format_ssi(double ssi);

/// Largest weight of the heuristic: nobody asks for a hundred times the way.
inline constexpr double kMaxWeight = 100;

struct PlannerOptions {
  InitialOrder order = InitialOrder::kShortestFirst;
  Rescheduling rescheduling = Rescheduling::kDeterministic;
  double ssi_s = kDefaultSsi;  ///< start-safe interval; 0 turns it off
  bool any_angle = true;
  int connectedness = 2;  ///< 2^k neighbours, k = 2..5
  double weight = 1;      ///< of the heuristic, 1 to kMaxWeight: see SippOptions
  std::uint64_t seed = 1;
  MotionRules rules;  ///< turns, delays, inflation; none by default

  double time_limit_s = kDefaultTimeLimitS;   ///< wall clock; infinity for none
  std::uint64_t max_expansions = UINT64_MAX;  ///< over all tries
  std::uint64_t max_restarts = UINT64_MAX;    ///< tries after the first; ejections count as tries
  /// Set from outside, by a signal for one: ends planning as the time limit does.
  const std::atomic<bool>* stop = nullptr;

  Method method = Method::kPrioritized;
  /// The limits hold for it anew: it begins where they have struck.
  Fallback fallback = Fallback::kNone;
};

}  // namespace sipplab
