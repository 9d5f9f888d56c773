// The command line, with the commands that the build has.
#pragma once

#include <CLI/CLI.hpp>
#include <filesystem>
#include <span>

#include "bench/cli/commands.hpp"

namespace sipplab::cli {

/// What stands beside planning, validating and generating, which need the planner alone.
struct Laboratory {
  /// The commands that need the history or Google Benchmark.
  std::span<const NamedCommand> commands = {};
  /// The history's file if no flag names it.
  std::filesystem::path (*history)() = nullptr;
};

/// Parses the arguments and runs one command; gives the exit code.
int run_program(int argc, char** argv, const Laboratory& laboratory = {});

}  // namespace sipplab::cli
