// sipplab bench: a density sweep into the history.
#include <benchmark/benchmark.h>
#include <fmt/format.h>
#include <sys/prctl.h>

#include <algorithm>
#include <csignal>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "bench/cli/bench_arguments.hpp"
#include "bench/cli/bench_parts.hpp"
#include "bench/cli/commands.hpp"
#include "bench/cli/console.hpp"
#include "bench/cli/history.hpp"
#include "bench/cli/planner_flags.hpp"
#include "bench/interrupt.hpp"
#include "bench/sweep/attempt.hpp"
#include "bench/sweep/benchmark_flags.hpp"
#include "bench/sweep/command_planner.hpp"
#include "bench/sweep/expand.hpp"
#include "bench/sweep/reporters.hpp"
#include "bench/sweep/run_info.hpp"
#include "bench/sweep/shard.hpp"
#include "bench/sweep/shell_command.hpp"
#include "bench/sweep/suites.hpp"
#include "bench/sweep/sweep.hpp"
#include "bench/sweep/task_plan.hpp"
#include "db/database.hpp"
#include "db/recorder.hpp"
#include "planner/io/text.hpp"

namespace sipplab::cli {
namespace {

constexpr std::size_t kShortUuid = 8;

/// The program that plans instead, where the user names one.
std::optional<bench::CommandPlannerSpec> command_of(const BenchArguments& arguments) {
  if (!arguments.planner) return std::nullopt;
  auto spec = bench::parse_command_planner(*arguments.planner, arguments.planner_name);
  if (!spec) return std::nullopt;  // checked when the command line was read
  spec->memory_limit_mib = arguments.memory_limit_mib;
  spec->retime = arguments.retime;
  if (arguments.solution_format) spec->format = *arguments.solution_format;
  if (arguments.rounding) spec->rounding = parse_real(*arguments.rounding).value_or(bench::kDefaultRounding);
  return *spec;
}

bench::SweepRequest request_of(const BenchArguments& arguments) {
  bench::SweepRequest request;
  request.suite = arguments.folders.empty() ? bench::find_suite(arguments.suite) : nullptr;
  request.folders = arguments.folders;
  request.archive = arguments.archive;
  request.random_seeds = arguments.random_seeds;
  request.strict = arguments.strict;
  request.radii_cells = numbers_of(arguments.radii);
  request.speeds_cells_per_s = numbers_of(arguments.speeds);
  request.map = arguments.map;
  request.robots = arguments.robots;
  request.values = arguments.options.values();
  request.count = arguments.count;
  request.seed = arguments.seed;
  if (const auto command = command_of(arguments)) request.command = command->name;
  return request;
}

/// Name of the benchmark as Google Benchmark completes it.
std::string full_name(const bench::NamedCase& named, std::size_t iterations) {
  return fmt::format("{}/iterations:{}/manual_time", named.name, iterations);
}

bool is_uuid(const std::string& text) {
  constexpr std::size_t kLength = 36;
  return text.size() == kLength && text.find_first_not_of("0123456789abcdef-") == std::string::npos;
}

/// What must agree for a run to be taken up again: every case by name, and what its
/// name leaves out.
db::RunInfo run_info(const BenchArguments& arguments, const bench::ExpandedSweep& sweep) {
  db::RunInfo info;
  info.suite = arguments.folders.empty() ? arguments.suite : "instances";
  info.shard = arguments.shard.value_or("");
  info.command_line = arguments.invocation.command_line;
  if (arguments.task) {  // as the sweep was planned
    info.command_line = "sipplab";
    for (const std::string& argument : bench::arguments_without(
             arguments.invocation.arguments, {"--shard", "--sweep", "--task-of", "--db", "--resume"})) {
      info.command_line += " " + argument;
    }
  }
  std::string cases;
  for (const bench::NamedCase& named : sweep.cases) {
    cases += fmt::format("{} {} {}\n", named.name, named.parameters.radius_cells,
                         named.parameters.speed_cells_per_s);
    for (const auto& prepared : sweep.sets[named.parameters.set].instances) {
      cases += prepared.row.content_hash + prepared.broken;
    }
  }
  const PlannerOptions& options = sweep.cases.front().parameters.options;
  const auto same_limit = [&options](const bench::NamedCase& named) {
    return named.parameters.options.time_limit_s == options.time_limit_s;
  };
  info.time_limit_s = std::all_of(sweep.cases.begin(), sweep.cases.end(), same_limit) ? options.time_limit_s
                                                                                      : db::kNoTimeLimit;
  info.options = fmt::format(
      "seed={} repetitions={} time_limit={} max_expansions={} max_restarts={} cases={}:{}", arguments.seed,
      arguments.repetitions, format_ssi(options.time_limit_s), options.max_expansions, options.max_restarts,
      sweep.cases.size(), bench::text_digest(cases));
  if (const auto command = command_of(arguments)) {
    info.options +=
        fmt::format(" planner={} memory_limit={} rounding={}", bench::text_digest(command->command),
                    command->memory_limit_mib, command->rounding);
  }
  if (arguments.retime) info.options += " retime";
  info.seed = arguments.seed;
  info.planned = static_cast<std::int64_t>(bench::planning_count(sweep, arguments.repetitions));
  static_cast<db::RunOrigin&>(info) = bench::run_origin();
  info.attempt = bench::attempt_info();
  // Parts on many machines agree on the id without having met.
  if (is_uuid(arguments.sweep)) {
    info.uuid = arguments.sweep;
  } else if (arguments.shard || !arguments.sweep.empty()) {
    info.uuid = bench::text_uuid(
        fmt::format("{}\n{}\n{}\n{}", info.suite, info.options, info.build.binary_hash, arguments.sweep));
  }
  return info;
}

/// "sipplab show 1a2b3c4d": what to type next, for this program and history.
std::string next_commands(const BenchArguments& arguments, const std::string& run) {
  const std::string database = arguments.database ? " --db " + bench::shell_word(*arguments.database) : "";
  return fmt::format("next: {0} show{1} {2}, or {0} runs{1}", bench::shell_word(arguments.invocation.program),
                     database, run.substr(0, kShortUuid));
}

int report(const BenchArguments& arguments, const bench::BenchmarkFlags& flags, bench::Sweep& sweep,
           const std::string& suite, const std::string& database, const std::string& run) {
  const auto& entries = sweep.entries();
  const bool finished =
      std::all_of(entries.begin(), entries.end(), [](const auto& entry) { return entry.finished(); });
  if (arguments.json) {
    print(bench::result_json(entries, suite, run, database, finished));
  } else if (flags.format.empty() && !arguments.quiet) {
    print(bench::result_table(entries));
  }
  if (sweep.error()) return fail(*sweep.error());
  diagnose(fmt::format("recorded in {} as run {}", database, run));
  if (!sweep.first_invalid().empty()) {
    return fail(kInternalError, "sipplab: internal error: invalid plan: " + sweep.first_invalid());
  }
  if (!finished) {
    return fail(kSignalExitBase + bench::interrupted_by(),
                "stopped before its end; the same command with --resume does the rest");
  }
  // What becomes of a whole is no question to a part.
  if (arguments.when_finished && !arguments.shard) return arguments.when_finished(database, run);
  if (!arguments.task) diagnose(next_commands(arguments, run));
  return kSuccess;
}

/// An error where the name of the program that plans stands for another command in the history.
std::optional<std::string> find_taken_name(db::Database& database, const BenchArguments& arguments) {
  const auto command = command_of(arguments);
  if (!command) return std::nullopt;
  const std::string name = "cmd:" + command->name;
  const auto other = db::find_other_command(database, name, bench::text_digest(command->command));
  if (!other) return other.error().message;
  if (!*other) return std::nullopt;
  return fmt::format(
      "{}: {} is another command in run {} (`sipplab show` tells which), expected "
      "--planner-name with a name for this one",
      database.path().string(), name, (*other)->substr(0, kShortUuid));
}

/// What files were left out, and the like.
void say_notes(const std::vector<std::string>& notes) {
  constexpr std::size_t kMostNotes = 20;
  for (std::size_t i = 0; i < std::min(notes.size(), kMostNotes); ++i) diagnose(notes[i]);
  if (notes.size() > kMostNotes) diagnose(fmt::format("and {} more like these", notes.size() - kMostNotes));
}

/// Opens the history, runs the cases that are to be run, and reports.
int run_sweep(const BenchArguments& arguments, const bench::BenchmarkFlags& flags, const db::RunInfo& info,
              bench::ExpandedSweep cases) {
  const std::filesystem::path path = db::database_path(arguments.database);
  // A part is written by one process, and carried about.
  const auto journal = arguments.shard ? db::Journal::kRollback : db::Journal::kWriteAhead;
  auto database = SIPPLAB_TRY_OR(fail, db::Database::open(path, journal));
  if (const auto line = find_taken_name(database, arguments)) return fail(kBadUsage, "sipplab: " + *line);
  const auto earlier = SIPPLAB_TRY_OR(fail, take_up(arguments, database, info, cases));
  say_notes(cases.notes);
  const std::string reason = bench::unfit_for_timing();
  if (!reason.empty()) diagnose("WARNING: " + reason + " in this build: its times are not worth comparing");

  std::optional<bench::CommandPlanner> command;
  if (const auto spec = command_of(arguments)) {
    command = SIPPLAB_TRY_OR(bad_usage, bench::CommandPlanner::make(*spec));
  }
  const bool nothing_left = bench::count_left(cases) == 0;
  const std::optional<std::string> run = earlier ? std::optional(earlier->uuid) : std::nullopt;
  bench::Sweep sweep(std::move(cases), bench::Recording(std::move(database), info, run),
                     arguments.repetitions, stderr_is_terminal(), std::move(command), arguments.retime);
  sweep.register_benchmarks(flags.format == "csv");
  if (nothing_left) {
    if (earlier->status != db::RunStatus::kFinished) sweep.begin();  // killed after its last planning
  } else {
    bench::catch_warnings();
    benchmark::BenchmarkReporter* shown =
        flags.format.empty() ? nullptr : benchmark::CreateDefaultDisplayReporter();
    bench::RecordingReporter reporter(sweep, shown);
    benchmark::RunSpecifiedBenchmarks(&reporter, std::string("."));
    benchmark::ClearRegisteredBenchmarks();  // they refer to this sweep, and another may follow
  }
  sweep.end();
  return report(arguments, flags, sweep, info.suite, path.string(),
                sweep.run_uuid().empty() ? run.value_or("") : sweep.run_uuid());
}

}  // namespace

int run_bench(const BenchArguments& given, std::vector<std::string> benchmark_flags) {
  BenchArguments arguments = given;
  // Where the process that keeps its exit code is killed, a task does not stay behind.
  if (arguments.task) prctl(PR_SET_PDEATHSIG, SIGTERM);
  if (arguments.repetitions > 1) {
    benchmark_flags.push_back(fmt::format("--benchmark_repetitions={}", arguments.repetitions));
  }
  for (const std::string& flag : benchmark_flags) {
    const bool is_of_results =
        flag.rfind("--benchmark_list_tests", 0) == 0 || flag.rfind("--benchmark_out", 0) == 0;
    if (arguments.plan_tasks && is_of_results) {
      return bad_usage("--plan-tasks runs no case, and all tasks would write to one place: expected no " +
                       flag.substr(0, flag.find('=')));
    }
  }
  const bench::BenchmarkFlags flags = SIPPLAB_TRY_OR(bad_usage, bench::initialize_benchmark(benchmark_flags));
  arguments.repetitions = flags.repetitions;
  if (arguments.json && !flags.format.empty()) {
    return bad_usage("--json and --benchmark_format both claim stdout, expected one of them");
  }

  bench::ExpandedSweep cases = SIPPLAB_TRY_OR(bad_usage, bench::expand(request_of(arguments)));
  const auto iterations = [&cases](const bench::NamedCase& named) {
    return cases.sets[named.parameters.set].instances.size();
  };
  std::vector<std::string> names;
  for (const bench::NamedCase& named : cases.cases) names.push_back(full_name(named, iterations(named)));
  const std::vector<bool> matches = SIPPLAB_TRY_OR(bad_usage, bench::filter_matches(flags.filter, names));
  std::size_t position = 0;
  std::erase_if(cases.cases, [&](const bench::NamedCase&) { return !matches[position++]; });
  if (cases.cases.empty()) {
    return bad_usage("--benchmark_filter: no case matches " + in_quotes(flags.filter));
  }
  const db::RunInfo info = run_info(arguments, cases);
  if (arguments.plan_tasks) return plan_tasks(arguments, info, cases);
  SIPPLAB_TRY_OR(bad_usage, deal_out(arguments, info, cases));
  if (flags.list_tests) {
    for (const bench::NamedCase& named : cases.cases) {
      print(full_name(named, arguments.shard ? named.plannings.size() : iterations(named)) + "\n");
    }
    return kSuccess;
  }
  return run_sweep(arguments, flags, info, std::move(cases));
}

namespace {

/// A line for each suite.
std::string list_of_suites() {
  std::string text = "Suites:\n";
  for (const bench::Suite& suite : bench::suites()) {
    text += fmt::format("  {:<14}{}\n", suite.name, suite.purpose);
  }
  return text;
}

void add_flags(CLI::App& command, BenchArguments& arguments) {
  CLI::Option* suite =
      command.add_option("--suite", arguments.suite, "suite to run; all suites are listed below")
          ->check([](const std::string& text) {
            std::string names;
            for (const bench::Suite& known : bench::suites()) {
              if (known.name == text) return std::string();
              names += (names.empty() ? ", expected one of " : ", ") + std::string(known.name);
            }
            return in_quotes(text) + names;
          })
          ->capture_default_str();
  CLI::Option* folders =
      command.add_option("--instances", arguments.folders, "sweep the instances of a folder instead")
          ->excludes(suite)
          ->type_name("DIR");
  command
      .add_flag("--strict", arguments.strict,
                "refuse a folder with files that are no instances or equal others")
      ->needs(folders);
  add_values(command, "--radius", arguments.radii,
             "radius in cells of robots in MovingAI files and the suite");
  add_values(command, "--speed", arguments.speeds, "speed in cells per second, likewise");
  command
      .add_option("--map", arguments.map, "map to use instead of the suite's; as `sipplab generate` takes it")
      ->excludes(folders);
  command.add_option("--robots", arguments.robots, "numbers of robots instead of the suite's: 16,32,64")
      ->delimiter(',')
      ->check(CLI::Range(std::size_t{0}, kMostRobots));
  command.add_option("--count", arguments.count, "instances per case")
      ->check(CLI::Range(std::uint64_t{1}, std::uint64_t{100'000}));
  CLI::Option* planner =
      command
          .add_option("--planner", arguments.planner,
                      "plan with another program: NAME:PATH, as `sipplab planners` lists them, or "
                      "'cmd:PROGRAM {task} {map} {config} {out}'")
          ->check([](const std::string& text) {
            const auto spec = bench::parse_command_planner(text, "");
            return spec ? std::string() : spec.error();
          })
          ->type_name("CMD");
  command
      .add_option("--planner-name", arguments.planner_name,
                  "its name in the history; default: that of its program")
      ->needs(planner)
      ->type_name("NAME");
  command
      .add_option("--memory-limit", arguments.memory_limit_mib,
                  "memory limit in MiB for the program and all that it starts")
      ->needs(planner)
      ->check(CLI::Range(std::uint64_t{16}, std::uint64_t{1} << 30))
      ->capture_default_str();
  command
      .add_option(
          "--rounding", arguments.rounding,
          fmt::format(
              "rounding error of its files to tolerate, in cells of overlap and seconds of a duration; "
              "default {}",
              bench::kDefaultRounding))
      ->needs(planner)
      ->check(check_positive_real)
      ->check(real_between(0, bench::kMaxRounding))
      ->type_name("X");
  add_solution_format(command, arguments.solution_format)->needs(planner);
  command.add_flag("--retime", arguments.retime,
                   "judge plans with the earliest times for their paths and orders; keeps both");
  command.add_option("--seed", arguments.seed, "seed of instances and random orders")
      ->check(CLI::Range(std::uint64_t{0}, kMaxSeed))
      ->capture_default_str();
  arguments.options.add_to(
      command, {OptionGroup::kPlanner, OptionGroup::kMotion, OptionGroup::kLimits, OptionGroup::kImprovement},
      true);
  command.add_option("--repetitions", arguments.repetitions, "the same as --benchmark_repetitions")
      ->check(CLI::Range(std::int64_t{1}, std::int64_t{1'000'000}));
  add_part_flags(command, arguments);
  add_database_flag(command, arguments.database);
  command.add_flag("--json", arguments.json, "print one JSON document");
}

}  // namespace

Command add_bench_command(CLI::App& program, const Invocation& invocation) {
  auto arguments = std::make_shared<BenchArguments>();
  arguments->invocation = invocation;
  CLI::App* command = program.add_subcommand("bench", "run a suite of cases and record it in the history");
  command->allow_extras();
  command->footer(list_of_suites() +
                  "All --benchmark_* flags of Google Benchmark work as well: --benchmark_filter=REGEX,\n"
                  "--benchmark_list_tests, --benchmark_format=json, --benchmark_out=FILE, ...");
  add_flags(*command, *arguments);
  return {command, [arguments, command] { return run_bench(*arguments, command->remaining()); }};
}

}  // namespace sipplab::cli
