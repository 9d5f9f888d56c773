// sipplab gate: is a build slower than another, or does it plan otherwise?
#include <fmt/format.h>

#include <algorithm>
#include <cstdlib>
#include <iostream>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "bench/cli/commands.hpp"
#include "bench/cli/console.hpp"
#include "bench/cli/history.hpp"
#include "bench/cli/planner_flags.hpp"
#include "bench/cli/report_flags.hpp"
#include "bench/gate/comparison.hpp"
#include "bench/gate/error_rates.hpp"
#include "bench/gate/report.hpp"
#include "bench/gate/slowdown.hpp"
#include "bench/gate/worker.hpp"
#include "bench/interrupt.hpp"
#include "bench/sweep/suites.hpp"
#include "db/comparisons.hpp"
#include "db/gate_runs.hpp"
#include "planner/io/text.hpp"

namespace sipplab::cli {
namespace {

constexpr const char* kThisProgram = "/proc/self/exe";

/// The instances of a comparison are the same always, so that its noise can be compared too.
constexpr std::uint64_t kInstanceSeed = 1;
/// Instances of each cell, for tests of what the gate says and not of how well it measures.
constexpr std::uint64_t kShortCellInstances = 2;

struct GateArguments {
  bool serve = false;
  bool timed_only = false;
  bool quick = false;
  std::string base;
  std::string head;
  bool calibrate = false;
  std::vector<std::string> sweeps;
  std::size_t comparisons = 5;
  std::optional<std::string> database;
  ReportFlags report;
  bench::GateRequest request;
};

/// A line that is written over on a terminal; nothing elsewhere.
class LiveLine {
 public:
  void show(const std::string& text) {
    if (!stderr_is_terminal()) return;
    std::fputs(("\r\033[K" + text).c_str(), stderr);
    shown_ = true;
  }
  ~LiveLine() {
    if (shown_) std::fputs("\r\033[K", stderr);
  }

 private:
  bool shown_ = false;
};

int failed_comparison(const std::string& line) {
  if (bench::interrupted_by() != 0) {
    return fail(kSignalExitBase + bench::interrupted_by(), "sipplab: stopped before a verdict");
  }
  return bad_usage(line);
}

void warn_of_unfit_builds(const bench::GateResult& result) {
  for (const auto* greeting : {&result.base, &result.head}) {
    if (greeting->unfit.empty()) continue;
    diagnose(fmt::format("WARNING: {} in the {} build: its times are not worth comparing", greeting->unfit,
                         greeting == &result.base ? "base" : "head"));
  }
}

int run_calibration(const GateArguments& arguments, const bench::GateCases& cases, db::Database& database) {
  bench::GateRequest request = arguments.request;
  request.treat_as_different = true;
  std::optional<bench::GateResult> last;
  std::vector<db::GateNoise> noise;
  LiveLine live;
  for (std::size_t number = 0; number < arguments.comparisons; ++number) {
    const auto progress = [&](const std::string& what) {
      live.show(fmt::format("comparison {} of {}: {}", number + 1, arguments.comparisons, what));
    };
    request.seed = arguments.request.seed + number;
    last = SIPPLAB_TRY_OR(failed_comparison, bench::compare_builds(request, cases, noise, progress));
    SIPPLAB_TRY_OR(fail, db::record_gate_run(database, bench::gate_record(request, cases, *last, true)));
    noise = SIPPLAB_TRY_OR(fail, db::gate_noise(database, bench::gate_kind(request)));
  }
  live.show("");
  bench::update_noise(request, cases, noise, *last);
  last->error_rates = bench::error_rates(request, cases, noise, *last);
  warn_of_unfit_builds(*last);
  print(arguments.report.wants_json() ? bench::noise_json(request, *last)
                                      : bench::noise_text(request, *last));
  return kSuccess;
}

int run_comparison(const GateArguments& arguments, const bench::GateCases& cases, db::Database& database) {
  bench::GateRequest request = arguments.request;
  request.floors = floors_of(arguments.report);
  request.expects_changes = arguments.report.expects_changes;
  if (!arguments.sweeps.empty()) {
    const auto base = SIPPLAB_TRY_OR(fail, db::resolve_side(database, arguments.sweeps.front()));
    const auto head = SIPPLAB_TRY_OR(fail, db::resolve_side(database, arguments.sweeps.back()));
    request.sweeps = SIPPLAB_TRY_OR(fail, db::paired_cells(database, base, head));
    if (request.sweeps.empty()) {
      return fail(kNothingComparable, "sipplab: " + base.title + " and " + head.title +
                                          " share no case and instance, expected runs of one suite");
    }
  }
  const auto noise = SIPPLAB_TRY_OR(fail, db::gate_noise(database, bench::gate_kind(request)));
  Expected<bench::GateResult, std::string> result = Unexpected{std::string()};
  {
    LiveLine live;
    result =
        bench::compare_builds(request, cases, noise, [&live](const std::string& what) { live.show(what); });
  }
  if (!result) return failed_comparison(result.error());
  // The result took long to measure: it is printed even if it cannot be recorded.
  const auto recorded = db::record_gate_run(database, bench::gate_record(request, cases, *result, false));
  warn_of_unfit_builds(*result);
  const int code = print_report(bench::gate_report(request, *result, recorded ? *recorded : std::string()),
                                arguments.report);
  return recorded ? code : fail(recorded.error());
}

int run_gate(const GateArguments& given) {
  if (given.serve) {
    bench::serve_gate(std::cin, std::cout);
    return kSuccess;
  }
  GateArguments arguments = given;
  if (arguments.calibrate) {
    if (arguments.base.empty()) arguments.base = kThisProgram;
    if (!arguments.head.empty()) {
      return bad_usage("--calibrate runs one build against itself, expected no --head");
    }
    if (arguments.report.junit || arguments.report.format == "markdown") {
      return bad_usage("--calibrate has no verdict, expected --format text or json and no --junit");
    }
    arguments.head = arguments.base;
  }
  if (arguments.base.empty() || arguments.head.empty()) {
    return bad_usage("expected --base BUILD and --head BUILD, or --calibrate");
  }
  for (std::string* build : {&arguments.base, &arguments.head}) {
    *build = SIPPLAB_TRY_OR(bad_usage, bench::find_program(*build));
  }
  arguments.request.builds = {arguments.base, arguments.head, {}};
  for (const char* variable : {bench::kSlowdownVariable, bench::kIntoVariable, bench::kChangeVariable}) {
    const char* value = std::getenv(variable);
    if (value == nullptr || arguments.calibrate) continue;
    arguments.request.builds.head_extras.push_back(fmt::format("{}={}", variable, value));
  }
  bench::GateCases::Extent extent;
  extent.exact = !arguments.timed_only;
  extent.crowded = extent.laboratory = !arguments.quick;
  if (arguments.quick) extent.instances = kShortCellInstances;
  for (const auto& [program, title] : {std::pair(arguments.base, "base"), {arguments.head, "head"}}) {
    const auto worker =
        SIPPLAB_TRY_OR(bad_usage, bench::WorkerProcess::start({program, title, std::nullopt, {}}));
    if (worker.greeting().protocol >= bench::kGateProtocol) continue;
    diagnose(
        fmt::format("the {} build is older: crowded cells and what is not the planner are left out", title));
    extent.crowded = extent.laboratory = false;
  }
  const auto cases =
      SIPPLAB_TRY_OR(bad_usage, bench::GateCases::make(arguments.request.suite, kInstanceSeed, extent));
  auto database = SIPPLAB_TRY_OR(fail, open_history(arguments.database));
  bench::catch_interrupts();
  return arguments.calibrate ? run_calibration(arguments, cases, database)
                             : run_comparison(arguments, cases, database);
}

/// Empty for a suite that can be timed, else what was expected.
std::string check_suite(const std::string& text) {
  const bench::Suite* suite = bench::find_suite(text);
  const bool timeable = suite != nullptr && suite->max_restarts < UINT64_MAX;
  return timeable ? std::string() : in_quotes(text) + ", expected gate, smoke or density";
}

void add_flags(CLI::App& command, GateArguments& arguments) {
  bench::GateRequest& request = arguments.request;
  command.add_option("--base", arguments.base, "build to compare with: a sipplab binary or its folder")
      ->type_name("BUILD");
  command.add_option("--head", arguments.head, "build to judge")->type_name("BUILD");
  CLI::Option* calibrate = command.add_flag("--calibrate", arguments.calibrate,
                                            "compare a build (--base, else this one) with itself to measure "
                                            "this machine's noise");
  command.add_option("--comparisons", arguments.comparisons, "number of comparisons of a calibration")
      ->check(CLI::Range(std::size_t{1}, std::size_t{1000}))
      ->needs(calibrate)
      ->capture_default_str();
  command.add_option("--suite", request.suite, "suite to time: gate, smoke or density")
      ->check(check_suite)
      ->capture_default_str();
  command.add_flag("--expect-changes,--allow-changes", arguments.report.expects_changes,
                   "plans are meant to differ: exit code 0 if nothing is worse");
  command.add_option("--sweeps", arguments.sweeps, "judge these two recorded runs of the builds as well")
      ->type_name("BASE HEAD")
      ->expected(2);
  command
      .add_option("--tolerance", request.tolerance, "slowdown to rule out before two builds are equivalent")
      ->check(real_between(0.001, 10))
      ->capture_default_str();
  command.add_option("--pairs", request.pairs, "number of pairs of processes")
      ->check(CLI::Range(std::size_t{6}, std::size_t{1000}))
      ->capture_default_str();
  command.add_option("--pair-seconds", request.budget.seconds, "seconds that each pair plans")
      ->check(real_between(0.01, 600))
      ->capture_default_str();
  command.add_option("--seed", request.seed, "seed of the order of plannings")
      ->check(CLI::Range(std::uint64_t{0}, kMaxSeed))
      ->capture_default_str();
  add_database_flag(command, arguments.database);
  add_report_flags(command, arguments.report);
  // For scripts and tests: what a judged build is started with; a short exact tier; no
  // crowded cells and nothing that is not the planner; short pairs;
  // the same program as if it were two.
  command.add_flag("--serve", arguments.serve)->group("");
  command.add_flag("--timed-only", arguments.timed_only)->group("");
  command.add_flag("--short-cells", arguments.quick)->group("");
  command.add_option("--fewest-rounds", request.budget.fewest_rounds)->group("")->check(CLI::Range(1, 1000));
  command.add_flag("--treat-as-different", request.treat_as_different)->group("");
}

}  // namespace

Command add_gate_command(CLI::App& program) {
  auto arguments = std::make_shared<GateArguments>();
  CLI::App* command =
      program.add_subcommand("gate", "compare two builds on this machine: same plans, same speed?");
  command->footer(
      "Exit codes: 0 equivalent, improved, or the same plans with other work; 1 regressed; 3 inconclusive;\n"
      "5 other plans and none worse for certain; then --expect-changes gives 0, or 3 if fewer are found.\n"
      "The noise of a machine is kept under its host name, or under the name in SIPPLAB_MACHINE.");
  add_flags(*command, *arguments);
  return {command, [arguments] { return run_gate(*arguments); }};
}

}  // namespace sipplab::cli
