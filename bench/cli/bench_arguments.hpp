// A sweep as the command line asks for it, for every command that starts one.
#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "bench/cli/commands.hpp"
#include "bench/cli/planner_flags.hpp"
#include "bench/sweep/command_planner.hpp"

namespace sipplab::cli {

/// Long enough for the time that a scheduler takes to start a task, short enough for a queue to fill gaps
/// with.
inline constexpr double kSecondsPerTask = 600;

/// Texts are as the user wrote them, checked when the command line was read. What is empty
/// leaves the suite's own.
struct BenchArguments {
  std::string suite = "density";
  std::vector<std::string> folders;
  std::optional<std::string> archive;  ///< as SweepRequest::archive
  std::optional<std::uint64_t> random_seeds;
  bool strict = false;  ///< as SweepRequest::strict
  std::vector<std::string> radii;
  std::vector<std::string> speeds;
  std::optional<std::string> map;
  std::vector<std::size_t> robots;
  OptionFlags options;  ///< each may have several values
  std::optional<std::uint64_t> count;
  std::uint64_t seed = 1;
  std::int64_t repetitions = 1;
  std::optional<std::string> planner;
  std::string planner_name;
  std::uint64_t memory_limit_mib = bench::kDefaultMemoryLimitMib;
  std::optional<std::string> rounding;
  std::optional<std::string> solution_format;
  bool retime = false;
  std::optional<std::string> shard;
  std::string sweep;                ///< id of the run, or a word that tells repetitions of a sweep apart
  std::optional<std::string> task;  ///< folder of the plan by which a shard is dealt out
  const CLI::Option* resume =
      nullptr;              ///< whether it was given tells more than its value, which may be empty
  std::string resumed_run;  ///< empty: the last run of this command
  std::optional<std::string> plan_tasks;
  std::optional<std::size_t> tasks;
  double seconds_per_task = kSecondsPerTask;
  std::optional<std::string> database;
  bool json = false;
  bool quiet = false;  ///< no table of the cases
  Invocation invocation;
  /// Called with the run once all of it is in the history; returns the exit code.
  std::function<int(const std::filesystem::path& database, const std::string& run)> when_finished;
};

/// Runs the sweep, records it, and reports. Returns the exit code.
int run_bench(const BenchArguments& arguments, std::vector<std::string> benchmark_flags);

/// The flags of parts of a sweep: --shard, --sweep, --resume, --plan-tasks and what belongs to it.
std::vector<CLI::Option*> add_part_flags(CLI::App& command, BenchArguments& arguments);

}  // namespace sipplab::cli
