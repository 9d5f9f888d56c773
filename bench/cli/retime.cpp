// sipplab retime: anyone's plan with the earliest times that are right for disks.
#include <fmt/format.h>

#include <memory>
#include <optional>
#include <string>

#include "bench/cli/commands.hpp"
#include "bench/cli/console.hpp"
#include "bench/cli/planner_flags.hpp"
#include "planner/core/clock.hpp"
#include "planner/io/text_file.hpp"
#include "planner/retime/retime.hpp"
#include "sipplab/solution_io.hpp"
#include "sipplab/validator.hpp"

namespace sipplab::cli {
namespace {

struct RetimeArguments {
  InstanceFlags instance;
  std::string solution;
  std::optional<std::string> solution_format;
  OptionFlags motion;
  SolutionOutput output;
  bool json = false;
};

std::string cost_text(const Solution& solution) {
  return fmt::format("makespan {:.3f} s, flowtime {:.3f} s", makespan_s(solution), flowtime_s(solution));
}

int run_retime(const RetimeArguments& arguments) {
  const auto loaded = SIPPLAB_TRY_OR(fail, arguments.instance.load());
  const Instance& instance = loaded.instance;
  SolutionDocument document = SIPPLAB_TRY_OR(
      fail, load_solution(arguments.solution, instance, arguments.solution_format.value_or("")));
  if (document.status != "solved") {
    return fail(arguments.solution + ": no solution in it (status " + document.status +
                "), expected a solved instance");
  }
  const MotionRules rules =
      arguments.motion.stated().applied_to(document.options.value_or(loaded.options.applied_to({}))).rules;
  const ValidationReport given = validate(instance, document.solution, {0, {}, rules});
  const Clock::time_point begin = Clock::now();
  auto result = retime(instance, document.solution, rules);
  const double seconds = seconds_since(begin);
  if (!result) return fail(arguments.solution + ": " + result.error());
  const std::string given_text =
      fmt::format("given       {}, {}\n", given.valid() ? "valid" : "invalid", cost_text(document.solution));
  if (!result->is_executable()) {
    print(given_text + fmt::format("retimed     not_executable in {:.3f} s\nring        {}\n", seconds,
                                   ring_text(instance, result->ring)));
    return kNegativeVerdict;
  }
  const ValidationReport report = validate(instance, result->solution, {0, {}, rules});
  document.solution = std::move(result->solution);
  document.valid = report.valid();
  document.order.clear();
  document.ssi_kept_s = std::nullopt;
  document.makespan_s = makespan_s(document.solution);
  document.flowtime_s = flowtime_s(document.solution);
  document.plan_hash = plan_hash(document.solution);
  document.robots_file = arguments.instance.robots_file();
  std::string written;
  if (arguments.output.wanted()) {
    written = SIPPLAB_TRY_OR(fail, arguments.output.write(instance, document));
  }
  if (arguments.json) {
    print(solution_to_json(instance, document));
  } else if (arguments.output.format && !arguments.output.file) {
    print(written);
  } else {
    print(given_text + fmt::format("retimed     {}, {} in {:.3f} s\n", report.valid() ? "valid" : "invalid",
                                   cost_text(document.solution), seconds));
    if (!report.valid()) print(report.violations.front().message + "\n");
  }
  return report.valid() ? kSuccess : kNegativeVerdict;
}

}  // namespace

Command add_retime_command(CLI::App& program) {
  auto arguments = std::make_shared<RetimeArguments>();
  CLI::App* command = program.add_subcommand(
      "retime", "give a plan the earliest times for its paths and orders; exit code 1 if there are none");
  arguments->instance.add_to(*command);
  command->add_option("--solution", arguments->solution, "solution, ours or another program's")
      ->required()
      ->type_name("FILE");
  add_solution_format(*command, arguments->solution_format);
  arguments->motion.add_to(*command, {OptionGroup::kMotion});
  arguments->output.add_to(*command);
  command->add_flag("--json", arguments->json, "print it as one JSON document");
  command->footer("Robots keep their paths. Where two paths meet, the same robot goes first.");
  return {command, [arguments] { return run_retime(*arguments); }};
}

}  // namespace sipplab::cli
