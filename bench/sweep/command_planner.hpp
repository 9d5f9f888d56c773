// Any other planner in the sweep: a program that is given an instance as files and leaves
// a solution. Nothing that it says of itself is believed: its plan is validated, its time
// and memory are measured from outside, and whatever becomes of it costs one row.
#pragma once

#include <cstdint>
#include <string>

#include "bench/temporary_folder.hpp"
#include "db/records.hpp"
#include "sipplab/error.hpp"
#include "sipplab/instance.hpp"
#include "sipplab/options.hpp"

namespace sipplab::bench {

/// Resident memory of another planner with all that it starts, MiB: four times what the published
/// planner takes for the largest instances of its archive, and half of a small machine's memory.
inline constexpr std::uint64_t kDefaultMemoryLimitMib = 4096;
/// Wall-clock seconds if a case sets no limit: that of [AY18], section 5.
inline constexpr double kDefaultCommandLimitS = 300;

/// Overlap in cells, or error of a duration in seconds, that is laid to the rounding of a
/// solution's numbers: the published planner writes 8 digits, sums of some ten durations of
/// up to 100 s are off by up to 1e-5 s, and a robot moves a cell a second.
inline constexpr double kDefaultRounding = 1e-5;

/// Files of so few digits say nothing of collisions: a tenth of a small robot.
inline constexpr double kMaxRounding = 0.05;

struct CommandPlannerSpec {
  std::string command;      ///< as the shell takes it, with placeholders
  std::string name;         ///< in the history: "cmd:NAME"
  std::string format = {};  ///< of its solution, as sipplab::solution_formats() has it; empty: guessed
  std::uint64_t memory_limit_mib = kDefaultMemoryLimitMib;
  double rounding = kDefaultRounding;  ///< cells, and seconds of a duration
  std::string no_plan = {};  ///< what it prints if the file that it leaves is no plan; empty: nothing
  bool retime = false;       ///< judge its plan with the earliest times for its paths and orders
};

/// From "cmd:COMMAND", or "NAME:PATH" for a program of known_planners(). Named after its program, or the
/// script that its program runs, unless `name` says otherwise. Words of it that name files become absolute
/// paths, since it will run elsewhere. Errors: one line.
Expected<CommandPlannerSpec, std::string> parse_command_planner(const std::string& text,
                                                                const std::string& name);

class CommandPlanner {
 public:
  /// Errors: one line if there is no place for its files.
  static Expected<CommandPlanner, std::string> make(CommandPlannerSpec spec);

  const std::string& name() const { return spec_.name; }

  /// Runs the command on an instance and judges what it left: `solved` is a plan that the
  /// validator accepts, `invalid` one that it rejects or that cannot be read, `limit` a program
  /// that was ended for its time or memory, `failed` everything else, an empty solution among it. Wall-clock
  /// time is that of the program from its start to its end. Tries and expansions are what the solution
  /// states; what else the program says of its run is kept apart. With `retime` the re-timed plan is judged,
  /// see judge_retimed(). Plans are not checked for start-safe intervals. Errors: one line, where nothing was
  /// run at all.
  Expected<db::ResultRow, std::string> run(const Instance& instance, const PlannerOptions& options) const;

 private:
  CommandPlanner(CommandPlannerSpec spec, TemporaryFolder folder)
      : spec_(std::move(spec)), folder_(std::move(folder)) {}

  CommandPlannerSpec spec_;
  TemporaryFolder folder_;
};

}  // namespace sipplab::bench
