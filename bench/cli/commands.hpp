// The commands of `sipplab`, one file each. Every function adds one subcommand to the
// program and returns what runs it once the arguments are parsed.
#pragma once

#include <CLI/CLI.hpp>
#include <functional>
#include <string>
#include <string_view>
#include <vector>

namespace sipplab::cli {

struct Command {
  CLI::App* arguments = nullptr;
  std::function<int()> run;  ///< returns the exit code
};

/// How the program was called.
struct Invocation {
  std::string program;       ///< as a user would type it from here
  std::string command_line;  ///< "sipplab bench --suite smoke"
  std::vector<std::string> arguments = {};
};

/// What adds a command to the program.
using AddCommand = Command (*)(CLI::App& program, const Invocation& invocation);

/// A command by its name on the command line.
struct NamedCommand {
  std::string_view name;
  AddCommand add;
};

/// Of a command that does not ask how it was called.
template <Command (*Add)(CLI::App& program)>
Command add_plainly(CLI::App& program, const Invocation&) {
  return Add(program);
}

Command add_plan_command(CLI::App& program);
Command add_validate_command(CLI::App& program);
Command add_retime_command(CLI::App& program);
Command add_planners_command(CLI::App& program);
Command add_generate_command(CLI::App& program);
Command add_bench_command(CLI::App& program, const Invocation& invocation);
Command add_reproduce_command(CLI::App& program, const Invocation& invocation);
Command add_runs_command(CLI::App& program);
Command add_show_command(CLI::App& program);
Command add_sql_command(CLI::App& program);
Command add_trend_command(CLI::App& program);
Command add_report_command(CLI::App& program);
Command add_plot_command(CLI::App& program);
Command add_merge_command(CLI::App& program);
Command add_task_command(CLI::App& program);
Command add_import_command(CLI::App& program);
Command add_documentation_command(CLI::App& program);
Command add_doctor_command(CLI::App& program);
Command add_compare_command(CLI::App& program);
Command add_gate_command(CLI::App& program);
Command add_property_command(CLI::App& program, const Invocation& invocation);
Command add_fuzz_command(CLI::App& program);
Command add_findings_command(CLI::App& program, const Invocation& invocation);

}  // namespace sipplab::cli
