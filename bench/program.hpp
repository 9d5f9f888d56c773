// Other programs, run with limits: fuzz targets, their replay programs, other planners.
#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <limits>
#include <string>
#include <vector>

namespace sipplab::bench {

/// A program that signal n stopped ends with this plus n, as shells tell it.
inline constexpr int kSignalExitBase = 128;

struct ProgramOptions {
  std::vector<std::string> environment = {};  ///< "NAME=value", replacing or added
  std::filesystem::path log = {};             ///< stderr goes to its end; empty: to this process's stderr
  double limit_s = std::numeric_limits<double>::infinity();  ///< wall clock; killed then
  std::filesystem::path folder = {};                         ///< to run in; empty: this process's own
  bool all_to_log = false;                                   ///< stdout goes where stderr goes
  /// The program leads a process group of its own, all of which is killed when the program
  /// ends or its time is up. Asked while it runs: whether to give up on it.
  bool own_group = false;
  std::function<bool()> give_up = {};
  /// Bytes that it and all that it started may hold in memory together; killed beyond, as soon as it is
  /// seen. 0: no limit. Looks through /proc, a program that grows faster than 8 GiB/s is seen late.
  std::uint64_t memory_limit_bytes = 0;
};

struct ProgramRun {
  bool started = false;
  bool timed_out = false;
  bool given_up = false;
  std::uint64_t memory_seen_bytes = 0;  ///< beyond the limit, where that is why it was killed; else 0
  int exit_code = -1;                   ///< -1 after a signal
  int signal = 0;                       ///< that ended it
  double wall_time_s = 0;
  double cpu_time_s = 0;
  /// Of the largest among it and the processes that it waited for, but no less than what
  /// this process holds when it starts the program.
  std::int64_t peak_memory_bytes = 0;
  std::string output;  ///< what it wrote to stdout
};

/// Runs the program until it ends; children that it leaves behind are not waited for.
ProgramRun run_program(const std::vector<std::string>& command, const ProgramOptions& options);

}  // namespace sipplab::bench
