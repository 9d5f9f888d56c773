// sipplab plan: reads an instance, plans it, has the validator check the plan, and
// only then writes anything.
#include <fmt/format.h>

#include <memory>
#include <optional>
#include <string>
#include <string_view>

#include "bench/cli/commands.hpp"
#include "bench/cli/console.hpp"
#include "bench/cli/planner_flags.hpp"
#include "planner/io/load_instance.hpp"
#include "planner/io/solution_io.hpp"
#include "planner/io/svg.hpp"
#include "planner/io/text_file.hpp"
#include "planner/prioritized/prioritized_planner.hpp"
#include "planner/validator/validator.hpp"

namespace sipplab::cli {
namespace {

struct PlanArguments {
  InstanceFlags instance;
  PlannerFlags planner;
  std::optional<std::string> format;
  std::optional<std::string> output;
  PictureFlags picture;
  bool json = false;
};

/// What -o means without --format: the file's extension, else XML.
SolutionFormat output_format(const PlanArguments& arguments) {
  if (arguments.format) return parse_solution_format(*arguments.format).value_or(SolutionFormat::kXml);
  const std::string_view path = arguments.output ? *arguments.output : std::string_view{};
  return parse_solution_format(path.substr(path.find_last_of('.') + 1)).value_or(SolutionFormat::kXml);
}

SolutionDocument document_of(const PlanResult& result, const PlannerOptions& options) {
  SolutionDocument document;
  document.status = std::string(name(result.status));
  if (!result.trace.empty()) document.order = result.order();
  document.tries = result.tries();
  document.expansions = result.statistics.expansions;
  document.generations = result.statistics.generations;
  document.planning_seconds = result.planning_seconds;
  document.options = options;
  document.made_by = std::string(name(result.made_by));
  if (result.status != PlanStatus::kSolved) return document;
  document.valid = true;
  document.solution = result.solution;
  document.makespan_s = makespan_s(result.solution);
  document.flowtime_s = flowtime_s(result.solution);
  document.plan_hash = plan_hash(result.solution);
  document.ssi_kept_s = result.ssi_kept_s;
  return document;
}

std::string summary(const SolutionDocument& document, std::size_t robots) {
  std::string text = fmt::format("status      {}{}\nrobots      {}\n", document.status,
                                 document.valid ? ", valid" : "", robots);
  if (document.makespan_s) text += fmt::format("makespan    {:.3f} s\n", *document.makespan_s);
  if (document.flowtime_s) text += fmt::format("flowtime    {:.3f} s\n", *document.flowtime_s);
  if (document.made_by == name(Method::kComplete)) {
    text += "made by     the complete planner\n";
    if (document.ssi_kept_s) {
      text += fmt::format("ssi kept    {} of {} s\n", format_ssi(*document.ssi_kept_s),
                          format_ssi(document.options->ssi_s));
    }
  }
  return text + fmt::format("tries       {}\nexpansions  {}\nplanning    {:.3f} s\n", document.tries,
                            document.expansions, document.planning_seconds);
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

/// A plan that breaks a promise is an error of ours: it is drawn where a picture was
/// asked for, and written nowhere.
int report_invalid(const PlanArguments& arguments, const Instance& instance, const PlanResult& result,
                   const ValidationReport& report, const PlannerOptions& options) {
  draw(arguments, instance, result.solution, report, "invalid plan");
  if (arguments.json) {
    PlanResult rejected = result;
    rejected.status = PlanStatus::kFailed;
    print(solution_to_json(instance, document_of(rejected, options)));
  }
  return fail(kInternalError,
              "sipplab: internal error: the plan is invalid: " + report.violations.front().message);
}

int run_plan(const PlanArguments& arguments) {
  const Expected<LoadedInstance, std::string> loaded = arguments.instance.load();
  if (!loaded) return fail(kBadUsage, loaded.error());
  const Instance& instance = loaded->instance;
  PlannerOptions options;
  apply(loaded->options, options);
  arguments.planner.apply_to(options);
  if (const auto line = beyond_complete(instance, options)) return fail(kBadUsage, "sipplab: " + *line);

  const PlanResult result = plan(instance, options);
  if (result.status == PlanStatus::kSolved) {
    const ValidationReport report =
        validate(instance, result.solution, {result.ssi_kept_s, result.order(), options.rules});
    if (!report.valid()) return report_invalid(arguments, instance, result, report, options);
  }

  const SolutionDocument document = document_of(result, options);
  if (arguments.output) {
    const std::string text = write_solution(output_format(arguments), instance, document);
    if (const auto error = write_file(*arguments.output, text)) return fail(kBadUsage, error->message());
  }
  const std::string subtitle =
      document.makespan_s ? fmt::format("{} robots, makespan {:.2f} s, flowtime {:.2f} s",
                                        instance.agents.size(), *document.makespan_s, *document.flowtime_s)
                          : document.status;
  if (const auto error = draw(arguments, instance, document.solution, {}, subtitle)) {
    return fail(kBadUsage, *error);
  }
  if (arguments.json) {
    print(solution_to_json(instance, document));
  } else if (arguments.format && !arguments.output) {
    print(write_solution(output_format(arguments), instance, document));
  } else {
    print(summary(document, instance.agents.size()));
  }
  return result.status == PlanStatus::kSolved ? kSuccess : kNegativeVerdict;
}

}  // namespace

Command add_plan_command(CLI::App& program) {
  auto arguments = std::make_shared<PlanArguments>();
  CLI::App* command = program.add_subcommand("plan", "plan one instance; exit code 1 where it is not solved");
  arguments->instance.add_to(*command);
  arguments->planner.add_to(*command);
  command->add_option("--format", arguments->format, "of the solution; default by the name of -o, else xml")
      ->check(CLI::IsMember({"xml", "json", "csv"}));
  command->add_option("-o,--output", arguments->output, "write the solution there")->type_name("FILE");
  arguments->picture.add_to(*command, "draw the solution there");
  command->add_flag("--json", arguments->json, "print one JSON document");
  return {command, [arguments] { return run_plan(*arguments); }};
}

}  // namespace sipplab::cli
