// sipplab plan: reads an instance, plans it, has the validator check the plan, and
// only then writes anything.
#include <fmt/format.h>

#include <algorithm>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <thread>
#include <utility>
#include <vector>

#include "bench/cli/commands.hpp"
#include "bench/cli/console.hpp"
#include "bench/cli/planner_flags.hpp"
#include "bench/interrupt.hpp"
#include "planner/core/clock.hpp"
#include "planner/io/text_file.hpp"
#include "planner/retime/retime.hpp"
#include "planner/solve/improve_stages.hpp"
#include "sipplab/instance_io.hpp"
#include "sipplab/solution_io.hpp"
#include "sipplab/solve.hpp"
#include "sipplab/svg.hpp"

namespace sipplab::cli {
namespace {

struct PlanArguments {
  InstanceFlags instance;
  OptionFlags options;
  SolutionOutput output;
  std::optional<std::string> solution;  ///< to begin with
  std::optional<std::string> solution_format;
  bool retime = false;
  PictureFlags picture;
  bool json = false;
};

/// Seconds that --best takes unless --time-limit says otherwise.
constexpr double kBestTimeLimitS = 30;

/// Lines of the curve that the summary prints at most; JSON has all of them.
constexpr std::size_t kCurveLines = 12;
/// Ejections that are printed one by one; a run that fails may have thousands. --json has all.
constexpr std::size_t kEjectionLines = 20;

SolutionDocument document_of(const SolveResult& outcome, const PlannerOptions& options) {
  const PlanResult& result = outcome.plan;
  SolutionDocument document;
  document.status = std::string(name(result.status));
  if (!result.trace.empty()) document.order = outcome.order();
  document.tries = result.tries();
  document.expansions = outcome.statistics().expansions;
  document.generations = outcome.statistics().generations;
  document.planning_seconds = outcome.seconds();
  document.options = options;
  document.made_by = std::string(name(result.made_by));
  document.options->ssi_s = result.ssi_s;
  document.options->longer_ssi_s.clear();
  for (const Try& pass : result.trace) {
    if (!pass.ejected.empty()) document.ejections.push_back({*pass.failed, pass.ejected});
  }
  document.steps = outcome.steps;
  if (result.status != PlanStatus::kSolved) return document;
  if (outcome.improvement) document.improvement = outcome.improvement->log;
  document.valid = true;
  document.solution = outcome.solution();
  document.makespan_s = makespan_s(document.solution);
  document.flowtime_s = flowtime_s(document.solution);
  document.plan_hash = plan_hash(document.solution);
  document.ssi_kept_s = outcome.ssi_kept_s();
  return document;
}

std::string steps_text(const std::vector<BestStep>& steps) {
  std::string text;
  for (const BestStep& step : steps) {
    text += fmt::format("step        {}, ssi {}: {} after {} {}, {:.3f} s", name(step.kind),
                        format_ssi(step.ssi_s), name(step.status), step.tries,
                        step.tries == 1 ? "try" : "tries", step.seconds);
    if (step.cost) {
      text += fmt::format("; flowtime {:.3f}, makespan {:.3f}", step.cost->flowtime_s, step.cost->makespan_s);
    }
    text += '\n';
  }
  return text;
}

std::string ejections_text(const std::vector<EjectionRecord>& ejections, const Instance& instance) {
  std::string text;
  for (std::size_t i = 0; i < ejections.size(); ++i) {
    if (i == kEjectionLines) return text + fmt::format("ejected     {} times more\n", ejections.size() - i);
    const EjectionRecord& record = ejections[i];
    text += fmt::format("ejected     by {}:", instance.agents[record.failed].id);
    for (const AgentIndex robot : record.ejected) text += " " + instance.agents[robot].id;
    text += "\n";
  }
  return text;
}

std::string gap_text(std::string_view what, double cost_s, double bound_s) {
  constexpr double kPercent = 100;
  return fmt::format("lower bound {:.3f} s {}, gap {:.1f} %\n", bound_s, what,
                     kPercent * gap(cost_s, bound_s));
}

std::string improvement_text(const ImprovementLog& log, double ssi_kept_s) {
  constexpr double kPercent = 100;
  const std::vector<ProgressPoint>& curve = log.curve;
  std::string text = fmt::format("improved    {} times in {} iterations, for {}\n", log.improvements,
                                 log.iterations, format_objective(log.objective));
  text += gap_text("flowtime", curve.back().cost.flowtime_s, log.bound.flowtime_s);
  text += gap_text("makespan", curve.back().cost.makespan_s, log.bound.makespan_s);
  text += log.keeps_guarantee ? fmt::format("guarantee   start-safe interval {} s, in the final order\n",
                                            format_ssi(ssi_kept_s))
                              : "guarantee   no collisions; start-safe intervals in no order\n";
  text += "curve       seconds  iteration    flowtime    makespan    gap %\n";
  const std::size_t stride = (curve.size() + kCurveLines - 2) / (kCurveLines - 1);
  for (std::size_t i = 0; i < curve.size(); ++i) {
    if (i % stride != 0 && i + 1 < curve.size()) continue;
    const ProgressPoint& point = curve[i];
    text += fmt::format("            {:7.3f} {:10} {:11.3f} {:11.3f} {:8.1f}\n", point.seconds,
                        point.iteration, point.cost.flowtime_s, point.cost.makespan_s,
                        kPercent * gap(point.cost.flowtime_s, log.bound.flowtime_s));
  }
  return text;
}

std::string summary(const SolutionDocument& document, const SolveResult& outcome, const Instance& instance) {
  std::string text = fmt::format("status      {}{}\nrobots      {}\n", document.status,
                                 document.valid ? ", valid" : "", instance.agents.size());
  if (document.makespan_s) text += fmt::format("makespan    {:.3f} s\n", *document.makespan_s);
  if (document.flowtime_s) text += fmt::format("flowtime    {:.3f} s\n", *document.flowtime_s);
  if (document.status == "solved" && document.made_by == name(Method::kComplete)) {
    text += "made by     LaCAM\n";
    if (document.ssi_kept_s) {
      text += fmt::format("ssi kept    {} of {} s\n", format_ssi(*document.ssi_kept_s),
                          format_ssi(document.options->ssi_s));
    }
  }
  text += fmt::format("tries       {}\nexpansions  {}\nplanning    {:.3f} s\n", document.tries,
                      document.expansions, document.planning_seconds);
  text += steps_text(outcome.steps) + ejections_text(document.ejections, instance);
  if (document.improvement) text += improvement_text(*document.improvement, outcome.ssi_kept_s());
  return text;
}

std::optional<std::string> draw(const PlanArguments& arguments, const Instance& instance,
                                const Solution& solution, const ValidationReport& report,
                                const std::string& subtitle) {
  if (!arguments.picture.file) return std::nullopt;
  SvgOptions options;
  options.subtitle = subtitle;
  options.animation_speed = arguments.picture.animation_speed();
  const auto error = write_file(*arguments.picture.file, draw_svg(instance, solution, report, options));
  if (!error) return std::nullopt;
  return error->message();
}

/// The plan in a file, with the earliest times for its paths where it was asked for or needed.
Expected<SolveResult, std::string> given_plan(const PlanArguments& arguments, const Instance& instance,
                                              const PlannerOptions& options) {
  const Input<SolutionDocument> document =
      load_solution(*arguments.solution, instance, arguments.solution_format.value_or(""));
  if (!document) return Unexpected{document.error().message()};
  if (document->status != "solved") {
    return Unexpected{*arguments.solution + ": no solution in it (status " + document->status +
                      "), expected a solved instance"};
  }
  const Clock::time_point begin = Clock::now();
  SolveResult outcome;
  outcome.plan.status = PlanStatus::kSolved;
  outcome.plan.solution = document->solution;
  Try given;
  for (AgentIndex i = 0; i < instance.agents.size(); ++i) given.order.push_back(i);
  outcome.plan.trace.push_back(std::move(given));
  const ValidationOptions wanted{0, {}, options.rules};
  if (arguments.retime || !validate(instance, outcome.plan.solution, wanted).valid()) {
    auto retimed = retime(instance, document->solution, options.rules);
    if (!retimed) return Unexpected{*arguments.solution + ": " + retimed.error()};
    if (!retimed->is_executable()) {
      return Unexpected{*arguments.solution + ": not executable, " + ring_text(instance, retimed->ring)};
    }
    outcome.plan.solution = std::move(retimed->solution);
    const ValidationReport report = validate(instance, outcome.plan.solution, wanted);
    if (!report.valid()) {
      return Unexpected{*arguments.solution +
                        ": invalid also with other times: " + report.violations.front().message};
    }
  }
  outcome.plan.planning_seconds = seconds_since(begin);
  // It guarantees nothing of starts.
  if (options.improve) outcome.improvement = improve_in_stages(instance, outcome.plan, options);
  return outcome;
}

/// A plan that breaks a guarantee is an error of ours: it is drawn where a picture was
/// asked for, and written nowhere.
int report_invalid(const PlanArguments& arguments, const Instance& instance, const SolveResult& outcome,
                   const ValidationReport& report, const PlannerOptions& options) {
  draw(arguments, instance, outcome.solution(), report, "invalid plan");
  if (arguments.json) {
    SolveResult rejected = outcome;
    rejected.plan.status = PlanStatus::kFailed;
    print(solution_to_json(instance, document_of(rejected, options)));
  }
  return fail(kInternalError,
              "sipplab: internal error: the plan is invalid: " + report.violations.front().message);
}

int run_plan(const PlanArguments& arguments) {
  if (const auto error = arguments.picture.find_error()) return bad_usage(*error);
  const auto loaded = SIPPLAB_TRY_OR(fail, arguments.instance.load());
  const Instance& instance = loaded.instance;
  PlannerOptions options;
  options.threads = std::clamp(std::thread::hardware_concurrency(), 1U, kMostThreads);
  const StatedOptions stated = arguments.options.stated();
  options = stated.applied_to(loaded.options.applied_to(options));
  if (const auto line = find_beyond(instance, options)) return bad_usage(*line);
  if (options.best || options.improve) {
    bench::catch_interrupts("\nsipplab: ending with the best plan so far; once more to end at once\n");
    options.stop = &bench::interrupt_flag();
  }
  if (options.best && !stated.states("time-limit")) options.time_limit_s = kBestTimeLimitS;
  const SolveResult outcome = arguments.solution
                                  ? SIPPLAB_TRY_OR(fail, given_plan(arguments, instance, options))
                                  : solve(instance, options);
  if (outcome.is_solved()) {
    const ValidationReport report = validate(instance, outcome.solution(), outcome.guarantees(options.rules));
    if (!report.valid()) return report_invalid(arguments, instance, outcome, report, options);
  }

  SolutionDocument document = document_of(outcome, options);
  if (arguments.solution) document.made_by.clear();
  document.robots_file = arguments.instance.robots_file();
  std::string written;
  if (arguments.output.wanted()) {
    written = SIPPLAB_TRY_OR(fail, arguments.output.write(instance, document));
  }
  const std::string subtitle =
      document.makespan_s ? fmt::format("{} robots, makespan {:.2f} s, flowtime {:.2f} s",
                                        instance.agents.size(), *document.makespan_s, *document.flowtime_s)
                          : document.status;
  if (const auto error = draw(arguments, instance, document.solution, {}, subtitle)) {
    return fail(*error);
  }
  if (arguments.json) {
    print(solution_to_json(instance, document));
  } else if (arguments.output.format && !arguments.output.file) {
    print(written);
  } else {
    print(summary(document, outcome, instance));
  }
  return outcome.is_solved() ? kSuccess : kNegativeVerdict;
}

}  // namespace

Command add_plan_command(CLI::App& program) {
  auto arguments = std::make_shared<PlanArguments>();
  CLI::App* command = program.add_subcommand("plan", "plan one instance; exit code 1 if it is not solved");
  arguments->instance.add_to(*command);
  arguments->options.add_to(*command, {OptionGroup::kPlanner, OptionGroup::kMotion, OptionGroup::kLimits,
                                       OptionGroup::kImprovement});
  command->option_defaults()->group("Begin with another plan");
  CLI::Option* solution =
      command->add_option("--solution", arguments->solution, "plan of another program, for --improve")
          ->type_name("FILE");
  add_solution_format(*command, arguments->solution_format)->needs(solution);
  command->add_flag("--retime", arguments->retime, "give it the earliest times even if it is valid")
      ->needs(solution);
  command->option_defaults()->group("Output");
  arguments->output.add_to(*command);
  arguments->picture.add_to(*command, "draw the solution there, as .svg");
  command->add_flag("--json", arguments->json, "print one JSON document");
  return {command, [arguments] { return run_plan(*arguments); }};
}

}  // namespace sipplab::cli
