// sipplab: the command line. Parses arguments, runs one command, and turns whatever
// happens into an exit code and at most one line on stderr.
#include "bench/cli/program.hpp"

#include <algorithm>
#include <csignal>
#include <exception>
#include <filesystem>
#include <new>
#include <sstream>
#include <stdexcept>
#include <string>
#include <string_view>
#include <system_error>
#include <vector>

#include "bench/cli/commands.hpp"
#include "bench/cli/console.hpp"
#include "bench/cli/usage_checks.hpp"
#include "sipplab/error.hpp"

namespace sipplab::cli {
namespace {

constexpr std::string_view kDocumentation = "documentation";

constexpr const char* kDescription =
    "Plans paths for many disk-shaped robots on a grid, and keeps a history of how well it does.\n"
    "Exit codes: 0 success, 1 negative verdict, 2 bad usage or input, 3 inconclusive,\n"
    "4 nothing comparable, 70 internal error.";

/// The command named on the line, for "see sipplab plan --help".
std::string help_command(const CLI::App& program) {
  const std::vector<CLI::App*> named = program.get_subcommands();
  return "sipplab " + (named.empty() ? "" : named.front()->get_name() + " ") + "--help";
}

/// argv[0], relative to the working directory if it lies below it.
std::string typed_program(const std::string& path) {
  std::error_code error;
  const std::filesystem::path here = std::filesystem::current_path(error);
  if (error || path.find('/') == std::string::npos) return path;
  const std::string relative = std::filesystem::path(path).lexically_proximate(here).string();
  if (relative.rfind("..", 0) == 0) return path;
  return relative.find('/') == std::string::npos ? "./" + relative : relative;
}

Invocation invocation_of(int argc, char** argv) {
  Invocation invocation{argc > 0 ? typed_program(argv[0]) : "sipplab", "sipplab"};
  for (int i = 1; i < argc; ++i) {
    invocation.command_line += " " + std::string(argv[i]);
    invocation.arguments.emplace_back(argv[i]);
  }
  return invocation;
}

constexpr NamedCommand kPlanningCommands[] = {
    {"plan", add_plainly<add_plan_command>},
    {"validate", add_plainly<add_validate_command>},
    {"retime", add_plainly<add_retime_command>},
    {"generate", add_plainly<add_generate_command>},
    {kDocumentation, add_plainly<add_documentation_command>},
};

/// The command that is named first; all of them if none is, or if it is the one that tells of all. The
/// options of all commands take most of the time of a start.
std::vector<Command> add_commands(CLI::App& program, const Invocation& invocation,
                                  const Laboratory& laboratory) {
  std::vector<NamedCommand> all(std::begin(kPlanningCommands), std::end(kPlanningCommands));
  all.insert(all.end(), laboratory.commands.begin(), laboratory.commands.end());
  const std::string first = invocation.arguments.empty() ? "" : invocation.arguments.front();
  const auto named = std::ranges::find(all, std::string_view(first), &NamedCommand::name);
  if (named != all.end() && named->name != kDocumentation) return {named->add(program, invocation)};
  std::vector<Command> commands;
  for (const NamedCommand& command : all) {
    commands.push_back(command.add(program, invocation));
    PLANNER_ASSERT(commands.back().arguments->get_name() == command.name);
  }
  return commands;
}

int parse_and_run(int argc, char** argv, const Laboratory& laboratory) {
  CLI::App program(kDescription, "sipplab");
  program.require_subcommand(1);
  program.set_version_flag("--version", std::string("sipplab ") + SIPPLAB_VERSION);

  const std::vector<Command> commands = add_commands(program, invocation_of(argc, argv), laboratory);
  refuse_false_counts(program);
  if (const std::string error = empty_element_error(program, argc, argv); !error.empty()) {
    return bad_usage(error + "; see " + help_command(program));
  }
  try {
    program.parse(argc, argv);
  } catch (const CLI::Success& help) {
    std::ostringstream text;
    program.exit(help, text, text);
    print(text.str());
    return kSuccess;
  } catch (const CLI::RequiredError& error) {
    const bool unknown = program.get_subcommands().empty() && argc > 1 && argv[1][0] != '-';
    const std::string what = unknown ? "no command is called " + std::string(argv[1]) : error.what();
    return bad_usage(what + "; see " + help_command(program));
  } catch (const CLI::ParseError& error) {
    return bad_usage(std::string(error.what()) + "; see " + help_command(program));
  } catch (const std::logic_error&) {
    // Thrown by the library if a flag is given a value, --any-angle=foo.
    return bad_usage("a flag has a value that is neither true nor false; see " + help_command(program));
  }
  for (const std::string& error :
       {empty_value_error(program), idle_flag_error(program), overwrite_error(program, laboratory.history)}) {
    if (!error.empty()) return bad_usage(error + "; see " + help_command(program));
  }
  for (const Command& command : commands) {
    if (command.arguments->parsed()) return command.run();
  }
  return fail(kInternalError, "sipplab: no command ran");
}

}  // namespace

int run_program(int argc, char** argv, const Laboratory& laboratory) {
  // A reader that goes away ends the output, not a sweep.
  std::signal(SIGPIPE, SIG_IGN);
  try {
    return close_stdout(parse_and_run(argc, argv, laboratory));
  } catch (const std::bad_alloc&) {
    return fail(kInternalError, "sipplab: out of memory");
  } catch (const std::exception& error) {
    return fail(kInternalError, "sipplab: internal error: " + std::string(error.what()));
  }
}

}  // namespace sipplab::cli
