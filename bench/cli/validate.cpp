// sipplab validate: a second opinion on any solution file, the published planner's
// logs included.
#include <fmt/format.h>

#include <cmath>
#include <memory>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>

#include "bench/cli/commands.hpp"
#include "bench/cli/console.hpp"
#include "bench/cli/planner_flags.hpp"
#include "db/json_text.hpp"
#include "planner/io/text_file.hpp"
#include "sipplab/solution_io.hpp"
#include "sipplab/svg.hpp"
#include "sipplab/validator.hpp"

namespace sipplab::cli {
namespace {

struct ValidateArguments {
  InstanceFlags instance;
  std::string solution;
  std::optional<std::string> format;
  std::optional<std::string> ssi;
  OptionFlags motion;
  PictureFlags picture;
  bool certify = false;
  bool json = false;
};

/// The validator's opinion and, if it was asked for, what is proven.
struct Verdict {
  ValidationReport report;
  std::optional<Certification> certification;
};

nlohmann::ordered_json number_or_null(double value) {
  return std::isfinite(value) ? nlohmann::ordered_json(value) : nlohmann::ordered_json(nullptr);
}

std::string to_json(const Instance& instance, const SolutionDocument& document,
                    const ValidationOptions& options, const Verdict& verdict) {
  const ValidationReport& report = verdict.report;
  nlohmann::ordered_json violations = nlohmann::ordered_json::array();
  for (const Violation& violation : report.violations) {
    nlohmann::ordered_json entry;
    entry["kind"] = std::string(name(violation.kind));
    entry["agent"] = violation.agent;
    entry["other"] =
        violation.other ? nlohmann::ordered_json(*violation.other) : nlohmann::ordered_json(nullptr);
    entry["time"] = number_or_null(violation.time_s);
    entry["depth"] = number_or_null(violation.depth_cells);
    entry["message"] = violation.message;
    violations.push_back(std::move(entry));
  }
  nlohmann::ordered_json json;
  json["valid"] = report.valid();
  json["robots"] = instance.agents.size();
  json["makespan"] = number_or_null(makespan_s(document.solution));
  json["flowtime"] = number_or_null(flowtime_s(document.solution));
  json["min_clearance"] = number_or_null(report.min_clearance_cells);
  json["ssi_checked"] = options.order.empty() ? "none" : format_ssi(options.ssi_s);
  if (const auto& certification = verdict.certification) {
    json["certified"] = {{"pairs", certification->pairs()},
                         {"safe", certification->safe},
                         {"collision", certification->collisions},
                         {"undecided", certification->undecided}};
  }
  json["violations"] = std::move(violations);
  return db::json_text(json);
}

std::string summary(const SolutionDocument& document, const ValidationOptions& options,
                    const ValidationReport& report) {
  std::string text;
  for (const Violation& violation : report.violations) text += violation.message + "\n";
  if (!report.valid()) {
    const bool more = report.violations.size() >= options.max_violations;
    return text +
           fmt::format("invalid: {}{} violations\n", more ? "at least " : "", report.violations.size());
  }
  text += fmt::format("valid: makespan {:.3f} s, flowtime {:.3f} s", makespan_s(document.solution),
                      flowtime_s(document.solution));
  if (std::isfinite(report.min_clearance_cells)) {
    text += fmt::format(", least clearance {:.2g} cells", report.min_clearance_cells);
  }
  if (!options.order.empty()) text += fmt::format(", start-safe interval {} kept", format_ssi(options.ssi_s));
  return text + "\n";
}

std::string summary(const Certification& certification) {
  return fmt::format("certified: {} pairs safe, {} in collision, {} undecided\n", certification.safe,
                     certification.collisions, certification.undecided);
}

int exit_code(const Verdict& verdict) {
  const std::optional<Certification>& certification = verdict.certification;
  if (!verdict.report.valid() || (certification && certification->collisions > 0)) return kNegativeVerdict;
  return certification && certification->undecided > 0 ? kInconclusive : kSuccess;
}

int run_validate(const ValidateArguments& arguments) {
  if (const auto error = arguments.picture.find_error()) return bad_usage(*error);
  const auto loaded = SIPPLAB_TRY_OR(fail, arguments.instance.load());
  const auto solution =
      SIPPLAB_TRY_OR(fail, load_solution(arguments.solution, loaded.instance, arguments.format.value_or("")));
  const SolutionDocument& document = solution;
  if (document.status != "solved") {
    return fail(arguments.solution + ": no solution in it (status " + document.status +
                "), expected a solved instance");
  }

  ValidationOptions options;
  PlannerOptions planned_with = loaded.options.applied_to({});
  planned_with.ssi_s = options.ssi_s;
  planned_with = arguments.motion.stated().applied_to(document.options.value_or(planned_with));
  options.ssi_s = planned_with.ssi_s;
  options.rules = planned_with.rules;
  if (document.ssi_kept_s) options.ssi_s = *document.ssi_kept_s;  // all that it guarantees
  if (arguments.ssi) options.ssi_s = parse_ssi(*arguments.ssi).value_or(0);
  if (options.ssi_s > 0) options.order = document.order;
  if (arguments.ssi && options.ssi_s > 0 && options.order.empty() && !loaded.instance.agents.empty()) {
    return fail(arguments.solution + ": no priority order in it, expected one to check --ssi against");
  }

  Verdict verdict;
  verdict.report = validate(loaded.instance, document.solution, options);
  if (arguments.certify) verdict.certification = certify(loaded.instance, document.solution);
  const ValidationReport& report = verdict.report;
  if (arguments.picture.file) {
    SvgOptions picture;
    picture.subtitle = report.valid() ? "valid" : "invalid: " + report.violations.front().message;
    picture.animation_speed = arguments.picture.animation_speed();
    const std::string text = draw_svg(loaded.instance, document.solution, report, picture);
    if (const auto error = write_file(*arguments.picture.file, text)) return fail(error->message());
  }
  if (arguments.json) {
    print(to_json(loaded.instance, document, options, verdict));
  } else {
    print(summary(document, options, report) +
          (verdict.certification ? summary(*verdict.certification) : std::string()));
  }
  return exit_code(verdict);
}

}  // namespace

Command add_validate_command(CLI::App& program) {
  auto arguments = std::make_shared<ValidateArguments>();
  CLI::App* command = program.add_subcommand("validate", "check a solution; exit code 1 if it is invalid");
  arguments->instance.add_to(*command);
  command
      ->add_option("--solution", arguments->solution,
                   "solution, ours or another program's; `sipplab planners` lists formats")
      ->required()
      ->type_name("FILE");
  add_solution_format(*command, arguments->format);
  command->add_option("--ssi", arguments->ssi, "start-safe interval to check; default: the solution's")
      ->check(check_ssi)
      ->type_name("K");
  arguments->motion.add_to(*command, {OptionGroup::kMotion});
  arguments->picture.add_to(*command, "draw the solution and its violations there, as .svg");
  command->add_flag("--certify", arguments->certify,
                    "prove for each pair that it is safe or collides; exit code 3 if neither is proven");
  command->add_flag("--json", arguments->json, "print one JSON document");
  return {command, [arguments] { return run_validate(*arguments); }};
}

}  // namespace sipplab::cli
