// sipplab import: results of other programs into the history.
#include <fmt/format.h>

#include <memory>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <vector>

#include "bench/cli/commands.hpp"
#include "bench/cli/console.hpp"
#include "bench/cli/history.hpp"
#include "bench/cli/planner_flags.hpp"
#include "bench/import/google_benchmark.hpp"
#include "db/best_known.hpp"
#include "db/database.hpp"
#include "db/measurements.hpp"
#include "planner/io/text.hpp"
#include "planner/io/text_file.hpp"
#include "planner/io/tracker.hpp"

namespace sipplab::cli {
namespace {

struct ImportArguments {
  std::string format;
  std::vector<std::string> files;
  bench::ImportContext context;
  std::optional<std::string> database;
  bool json = false;
};

/// Best known costs of MAPF-tracker.
int import_tracker(const ImportArguments& arguments) {
  std::vector<db::BestKnownRow> rows;
  nlohmann::ordered_json imported = nlohmann::ordered_json::array();
  std::string text;
  for (const std::string& file : arguments.files) {
    const auto content = SIPPLAB_TRY_OR(fail, read_file(file));
    const auto read = SIPPLAB_TRY_OR(fail, parse_tracker_rows(content, file));
    for (const TrackerRow& row : read) {
      rows.push_back(
          {row.map_name, row.scen_type, row.type_id, row.agents, row.lower_cost, row.solution_cost});
    }
    imported.push_back({{"file", file}, {"costs", read.size()}});
    text += fmt::format("{}: {} best known costs\n", file, read.size());
  }
  auto database = SIPPLAB_TRY_OR(fail, open_history(arguments.database));
  SIPPLAB_TRY_OR(fail, db::record_best_known(database, rows));
  if (arguments.json) {
    print_json({{"imported", imported}});
  } else {
    print(text);
  }
  return kSuccess;
}

int run_import(const ImportArguments& arguments) {
  if (arguments.format == "tracker") return import_tracker(arguments);
  std::vector<db::MeasurementRun> runs;  // all are read before the first is written
  for (const std::string& file : arguments.files) {
    runs.push_back(SIPPLAB_TRY_OR(fail, bench::read_google_benchmark(file, arguments.context)));
  }
  auto database = SIPPLAB_TRY_OR(fail, open_history(arguments.database));
  nlohmann::ordered_json imported = nlohmann::ordered_json::array();
  for (std::size_t i = 0; i < runs.size(); ++i) {
    const auto recorded = SIPPLAB_TRY_OR(fail, db::record_measurements(database, runs[i]));
    imported.push_back({{"file", arguments.files[i]},
                        {"run", runs[i].uuid},
                        {"suite", runs[i].info.suite},
                        {"measurements", runs[i].measurements.size()},
                        {"known", recorded.known}});
    if (!arguments.json) {
      print(fmt::format("{}: run {}, suite {}, {} measurements{}\n", arguments.files[i], runs[i].uuid,
                        runs[i].info.suite, runs[i].measurements.size(),
                        recorded.known ? ", known already" : ""));
    }
  }
  if (arguments.json) print_json({{"imported", imported}});
  return kSuccess;
}

}  // namespace

Command add_import_command(CLI::App& program) {
  auto arguments = std::make_shared<ImportArguments>();
  CLI::App* command = program.add_subcommand("import", "add reports of other benchmark programs");
  command
      ->add_option("format", arguments->format,
                   "google-benchmark: what --benchmark_format=json writes; tracker: best known "
                   "costs as MAPF-tracker has them")
      ->required()
      ->check(CLI::IsMember({"google-benchmark", "tracker"}));
  command->add_option("files", arguments->files, "reports")->required()->type_name("FILE");
  command->add_option("--suite", arguments->context.suite, "suite name; default: the program that ran");
  command->add_option("--commit", arguments->context.commit, "hash of the commit that was measured")
      ->check([](const std::string& text) {
        return bench::is_commit_hash(text) ? std::string()
                                           : in_quotes(text) + ", expected 7 or more hexadecimal digits";
      });
  command->add_option("--subject", arguments->context.subject, "first line of that commit's message");
  command->add_option("--branch", arguments->context.branch, "branch that was measured");
  add_database_flag(*command, arguments->database);
  command->add_flag("--json", arguments->json, "print one JSON document");
  command->footer(
      "The views v_measurements and v_best_known show them. A report that is imported twice is stored once.");
  return {command, [arguments] { return run_import(*arguments); }};
}

}  // namespace sipplab::cli
