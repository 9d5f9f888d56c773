// Flags that several commands share: which instance, which planner options, and
// where the history is.
#pragma once

#include <CLI/CLI.hpp>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "bench/sweep/refined_plan.hpp"
#include "planner/io/load_instance.hpp"
#include "planner/prioritized/options.hpp"

namespace sipplab::cli {

/// --instance, --map, --task, --config, --obstacles, --agents, --allow-unreachable.
class InstanceFlags {
 public:
  void add_to(CLI::App& command);

  /// Reads the files, warnings to stderr. Errors are one line.
  Expected<LoadedInstance, std::string> load() const;

 private:
  InstanceFiles files_;
};

/// --turns, --wait-before-move, --inflate-distance, --inflate-time: each empty unless the user gave it.
class MotionFlags {
 public:
  void add_to(CLI::App& command);

  /// Overwrites the rules that the user gave.
  void apply_to(MotionRules& rules) const;

 private:
  std::optional<bool> turns_;
  std::optional<double> wait_before_move_s_;
  std::optional<double> inflate_distance_cells_;
  std::optional<double> inflate_time_s_;
};

/// --ssi (a list), --reschedule, --order, --connectedness, --any-angle, --weight, --seed, --time-limit,
/// --max-expansions, --max-restarts, --method, --fallback, and those of MotionFlags: each empty
/// unless the user gave it.
class PlannerFlags {
 public:
  void add_to(CLI::App& command);

  /// Overwrites the options that the user gave; of several start-safe intervals the first.
  void apply_to(PlannerOptions& options) const;
  /// The intervals after the first: those to try in turn where it fails.
  std::vector<double> longer_ssi_s() const;
  bool has_time_limit() const { return time_limit_.has_value(); }

 private:
  std::vector<std::string> ssi_;
  std::optional<std::string> reschedule_;
  std::optional<std::string> order_;
  std::optional<int> connectedness_;
  std::optional<bool> any_angle_;
  std::optional<double> weight_;
  std::optional<std::uint64_t> seed_;
  std::optional<std::string> time_limit_;
  std::optional<std::uint64_t> max_expansions_;
  std::optional<std::uint64_t> max_restarts_;
  std::optional<std::string> method_;
  std::optional<std::string> fallback_;
  MotionFlags motion_;
};

/// Why the complete planner, which the options name, cannot plan this instance, in one line;
/// none where they do not name it or it can.
std::optional<std::string> beyond_complete(const Instance& instance, const PlannerOptions& options);

/// What --weight is for.
inline constexpr const char* kWeightWords =
    "of the heuristic: with 1.05 far fewer nodes are expanded on large maps, and robots arrive a little "
    "later (at most so many times as late as by steps alone)";

/// Largest seed: the history keeps seeds as signed 64-bit integers.
inline constexpr std::uint64_t kMaxSeed = INT64_MAX;
/// Most robots that can be asked for: beyond, nobody waits for a plan, and memory ends first.
inline constexpr std::size_t kMostRobots = 1'000'000;
/// Most threads of an improvement: each holds a copy of the plan.
inline constexpr unsigned kMostThreads = 64;

/// Checks for CLI11: empty when the text is right, else what was expected.
std::string check_ssi(const std::string& text);
std::string check_reschedule(const std::string& text);
std::string check_order(const std::string& text);
/// A number of seconds > 0, or "inf".
std::string check_time_limit(const std::string& text);
std::string check_positive_real(const std::string& text);
/// A number in [low, high]. CLI::Range lets "nan" through, which is below and above nothing.
CLI::Validator real_between(double low, double high);
std::string check_objective(const std::string& text);
/// "30", "30s": seconds > 0; "500i": iterations > 0.
std::string check_improve(const std::string& text);

/// REQUIRES: check_time_limit(text) is empty.
double parse_time_limit_s(std::string_view text);

/// --improve, --objective and --threads.
struct ImproveFlags {
  std::optional<std::string> budget;
  std::string objective = "flowtime";
  unsigned threads = 1;

  void add_to(CLI::App& command);
  bench::Refinement refinement(bool best) const;
};

/// --any-angle and --no-any-angle; empty unless the user gave one of them.
void add_any_angle_flag(CLI::App& command, std::optional<bool>& any_angle);
/// --method and --fallback; empty unless the user gave them.
void add_method_flags(CLI::App& command, std::optional<std::string>& method,
                      std::optional<std::string>& fallback);

/// --svg, with `words` for help, and --animate.
struct PictureFlags {
  std::optional<std::string> file;

  void add_to(CLI::App& command, const std::string& words);
  /// As SvgOptions::animation_speed.
  double animation_speed() const;

 private:
  std::optional<std::string> animate_;
};

/// --db, with its help text.
void add_database_flag(CLI::App& command, std::optional<std::string>& path);

}  // namespace sipplab::cli
