// Other programs, run with a limit of time: fuzz targets and their replay programs.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace sipplab::bench {

struct ProgramRun {
  bool started = false;
  bool timed_out = false;
  int exit_code = -1;  ///< -1 after a signal
  double cpu_time_s = 0;
  std::string output;  ///< what it wrote to stdout
};

/// Runs the program; its stderr goes to the end of `log`. Killed after `limit_s` seconds.
ProgramRun run_program(const std::vector<std::string>& command, const std::vector<std::string>& environment,
                       const std::filesystem::path& log, double limit_s);

}  // namespace sipplab::bench
