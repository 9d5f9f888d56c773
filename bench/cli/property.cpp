// sipplab property: what the properties of property_tests/ gave, in the history; and a
// counterexample again.
#include <fmt/format.h>

#include <filesystem>
#include <memory>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <vector>

#include "bench/campaigns/property_log.hpp"
#include "bench/campaigns/replay.hpp"
#include "bench/cli/commands.hpp"
#include "bench/cli/console.hpp"
#include "bench/cli/history.hpp"
#include "bench/cli/planner_flags.hpp"
#include "bench/present/picture_format.hpp"
#include "bench/sweep/run_info.hpp"
#include "db/json_text.hpp"
#include "db/property_runs.hpp"
#include "planner/io/case_codec.hpp"
#include "planner/io/text_file.hpp"
#include "sipplab/instance_io.hpp"
#include "sipplab/svg.hpp"

namespace sipplab::cli {
namespace {

namespace fs = std::filesystem;

struct PropertyArguments {
  HistoryFlags history;
  std::string program;  ///< how sipplab was called: the program of the properties lies below its folder

  // record, totals
  std::string log;
  std::string mutant;

  // list
  std::optional<std::string> room;
  bool all = false;
  bool failed = false;
  std::size_t limit = 0;

  // show, replay
  std::string run = "latest";
  std::optional<std::string> instance_file;
  std::optional<std::string> svg;
};

std::string totals_text(const bench::PropertyTotals& totals) {
  return fmt::format(
      "{} property runs, {} cases, {} discarded, {} failed, {} gave up, {} crashed, {:.1f} s\n", totals.runs,
      totals.cases, totals.discards, totals.failed, totals.gave_up, totals.crashed, totals.wall_time_s);
}

nlohmann::ordered_json totals_json(const bench::PropertyTotals& totals) {
  nlohmann::ordered_json json;
  json["runs"] = totals.runs;
  json["cases"] = totals.cases;
  json["discards"] = totals.discards;
  json["failed"] = totals.failed;
  json["gave_up"] = totals.gave_up;
  json["crashed"] = totals.crashed;
  json["wall_time_s"] = totals.wall_time_s;
  return json;
}

Expected<std::vector<db::PropertyRun>, std::string> read_log(const std::string& path) {
  const auto text = read_file(path);
  if (!text) return Unexpected{text.error().message()};
  return bench::parse_property_log(*text, path);
}

/// Sums up a log. With failures in it, the exit code is that of a negative verdict.
int run_totals(const PropertyArguments& arguments) {
  const auto runs = SIPPLAB_TRY_OR(fail, read_log(arguments.log));
  const bench::PropertyTotals totals = bench::totals_of(runs);
  print(arguments.history.json ? db::json_text(totals_json(totals)) : totals_text(totals));
  return totals.failed + totals.gave_up + totals.crashed == 0 ? kSuccess : kNegativeVerdict;
}

int run_record(const PropertyArguments& arguments) {
  const auto runs = SIPPLAB_TRY_OR(fail, read_log(arguments.log));
  auto database = SIPPLAB_TRY_OR(fail, open_history(arguments.history.database));
  const auto recorded =
      SIPPLAB_TRY_OR(fail, db::record_property_runs(database, bench::run_origin(), runs, arguments.mutant));
  const bench::PropertyTotals totals = bench::totals_of(runs);
  if (arguments.history.json) {
    nlohmann::ordered_json json = totals_json(totals);
    json["added"] = recorded.added;
    json["known"] = recorded.known;
    print_json(json);
  } else {
    print(totals_text(totals) + fmt::format("{} recorded in {}, {} there already\n", recorded.added,
                                            database.path().string(), recorded.known));
  }
  return kSuccess;
}

int run_list(const PropertyArguments& arguments) {
  auto database = SIPPLAB_TRY_OR(fail, read_history(arguments.history.database));
  db::PropertyFilter filter;
  filter.room = arguments.room;
  filter.failed = arguments.failed;
  filter.every_run = arguments.all;
  filter.limit = arguments.limit;
  const auto table = SIPPLAB_TRY_OR(fail, db::list_property_runs(database, filter));
  arguments.history.show(table);
  return kSuccess;
}

db::Result<db::PropertyReport> find_report(const PropertyArguments& arguments) {
  auto database = SIPPLAB_TRY(read_history(arguments.history.database));
  if (arguments.run != "latest") return db::show_property_run(database, std::stoll(arguments.run));
  const auto id = SIPPLAB_TRY(db::latest_property_failure(database));
  return db::show_property_run(database, id);
}

int run_show(const PropertyArguments& arguments) {
  const auto report = SIPPLAB_TRY_OR(fail, find_report(arguments));
  print(db::format_property_report(report, arguments.history.output_format()));
  return kSuccess;
}

/// The program of the properties, below the folder of sipplab in the same build.
fs::path program_of(const PropertyArguments& arguments) {
  return fs::path(arguments.program).parent_path() / "property_tests" / "properties";
}

/// Writes what was asked for beside the verdict; an error is one line.
std::optional<std::string> write_pictures(const PropertyArguments& arguments, const PlanCase& plan_case,
                                          const bench::CaseVerdict& verdict) {
  if (arguments.instance_file) {
    if (const auto error = write_file(*arguments.instance_file, write_instance_xml(plan_case.instance))) {
      return error->message();
    }
  }
  if (!arguments.svg) return std::nullopt;
  SvgOptions options;
  options.subtitle = verdict.text;
  const auto picture = draw_svg(plan_case.instance, verdict.result.solution, verdict.report, options);
  if (const auto error = write_file(*arguments.svg, picture)) return error->message();
  return std::nullopt;
}

const char* text_of(bench::ProgramVerdict verdict) {
  constexpr const char* kNames[] = {"holds now", "still fails", "not run: no such program, room or property"};
  return kNames[static_cast<std::size_t>(verdict)];
}

int run_replay(const PropertyArguments& arguments) {
  if (arguments.svg) {
    if (const auto error = bench::find_plan_picture_error(*arguments.svg)) return bad_usage(*error);
  }
  const auto report = SIPPLAB_TRY_OR(fail, find_report(arguments));
  const db::PropertyRun& run = report.run;
  if (run.status != "failed") {
    return fail(fmt::format("property run {} {}, expected one that failed", report.id, run.status));
  }
  const fs::path program = program_of(arguments);
  const std::string command = bench::replay_command(program, run.room, run.reproduce);
  const std::string& minimal = run.plan_case.empty() ? run.counterexample : run.plan_case;
  std::optional<bench::CaseVerdict> planned;
  if (const auto plan_case = decode_case(run.plan_case); plan_case && !run.plan_case.empty()) {
    planned = bench::replay_case(*plan_case, [](const Instance& instance, const PlannerOptions& options) {
      return plan(instance, options);
    });
    if (const auto error = write_pictures(arguments, *plan_case, *planned)) return fail(*error);
  } else if (arguments.instance_file || arguments.svg) {
    return fail(fmt::format("property run {} planned no case, expected one to write or draw", report.id));
  }
  const bench::ProgramVerdict property = bench::replay_program(program, run.room, run.reproduce);

  if (arguments.history.json) {
    nlohmann::ordered_json json;
    json["id"] = report.id;
    json["title"] = run.title;
    json["counterexample"] = minimal;
    json["command"] = command;
    json["plan"] = planned ? nlohmann::ordered_json(planned->text) : nlohmann::ordered_json();
    json["property"] = text_of(property);
    print_json(json);
  } else {
    print(fmt::format("{}\n\n{}\ncommand   {}\n", run.title, minimal, command));
    if (planned) print(fmt::format("plan      {}\n", planned->text));
    print(fmt::format("property  {}\n", text_of(property)));
  }
  if ((planned && !planned->holds) || property == bench::ProgramVerdict::kFails) return kNegativeVerdict;
  return property == bench::ProgramVerdict::kHolds ? kSuccess : kInconclusive;
}

void add_run_argument(CLI::App& command, PropertyArguments& arguments) {
  command
      .add_option("id", arguments.run, "as `sipplab property list` shows it, or latest: the newest failure")
      ->capture_default_str()
      ->check([](const std::string& text) {
        const bool is_id = text == "latest" || (!text.empty() && text.size() <= 18 &&
                                                text.find_first_not_of("0123456789") == std::string::npos);
        return is_id ? "" : "'" + text + "', expected the id of a property run, or latest";
      });
}

}  // namespace

Command add_property_command(CLI::App& program, const Invocation& invocation) {
  auto arguments = std::make_shared<PropertyArguments>();
  arguments->program = invocation.program;
  CLI::App* property = program.add_subcommand("property", "record, list and replay property runs");
  property->require_subcommand(1);

  CLI::App* record =
      arguments->history.add_command(*property, "record", "record a log of property runs in the history");
  record->add_option("log", arguments->log, "file that SIPPLAB_PROPERTY_LOG named")->required();
  record->add_option("--mutant", arguments->mutant, "name of the bug that was planted in the planner");
  CLI::App* totals =
      arguments->history.add_command(*property, "totals", "sum up a log; exit code 1 if it has failures");
  totals->add_option("log", arguments->log, "file that SIPPLAB_PROPERTY_LOG named")->required();

  CLI::App* list = arguments->history.add_command(*property, "list", "the newest run of each property");
  list->add_option("--room", arguments->room, "only properties of this room");
  list->add_flag("--failed", arguments->failed, "only failures and crashes");
  list->add_flag("--all", arguments->all, "every run, newest first, including those with planted bugs");
  list->add_option("--limit", arguments->limit, "most rows to show; 0: all")->capture_default_str();
  CLI::App* show =
      arguments->history.add_command(*property, "show", "one run, with its classes and counterexample");
  add_run_argument(*show, *arguments);
  CLI::App* replay =
      arguments->history.add_command(*property, "replay",
                                     "try a counterexample again; exit code 1 if it still fails, 0 if "
                                     "it holds, 3 if it cannot be run");
  add_run_argument(*replay, *arguments);
  replay->add_option("-o,--output", arguments->instance_file, "write the planned instance there, as XML")
      ->type_name("FILE");
  replay->add_option("--svg", arguments->svg, "draw the case and its plan there, as .svg")->type_name("FILE");

  return {property, [=] {
            if (record->parsed()) return run_record(*arguments);
            if (totals->parsed()) return run_totals(*arguments);
            if (list->parsed()) return run_list(*arguments);
            if (show->parsed()) return run_show(*arguments);
            return run_replay(*arguments);
          }};
}

}  // namespace sipplab::cli
