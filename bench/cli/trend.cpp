// sipplab trend: the history of a metric, with its changes of level.
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "bench/cli/case_filter.hpp"
#include "bench/cli/commands.hpp"
#include "bench/cli/console.hpp"
#include "bench/cli/history.hpp"
#include "bench/cli/planner_flags.hpp"
#include "bench/present/trend_text.hpp"
#include "db/database.hpp"
#include "db/json_text.hpp"
#include "db/trends.hpp"
#include "planner/io/text.hpp"
#include "planner/io/text_file.hpp"

namespace sipplab::cli {
namespace {

/// Largest --min-effect: a metric that is a thousand times as much again.
constexpr double kGreatestEffect = 1000;

struct TrendArguments {
  std::string metric;
  std::vector<std::string> cases;
  std::optional<std::string> suite;
  std::optional<std::string> branch;
  std::optional<std::string> machine;
  std::size_t rows = 20;
  db::ChangeRules rules;
  std::optional<std::string> svg;
  std::optional<std::string> database;
  bool json = false;
};

int run_trend(const TrendArguments& arguments) {
  db::TrendQuery query;
  query.metric = db::find_trend_metric(arguments.metric);
  auto format = bench::PictureFormat::kSvg;
  if (arguments.svg) format = SIPPLAB_TRY_OR(bad_usage, bench::picture_format(*arguments.svg));
  const auto filter = SIPPLAB_TRY_OR(bad_usage, parse_case_filter(arguments.cases));
  if (!query.metric->of_case &&
      (!arguments.cases.empty() || arguments.suite || arguments.branch || arguments.machine)) {
    return bad_usage(arguments.metric +
                     " is not of a case: expected no --case, --suite, --branch or --machine");
  }
  query.cases = filter;
  query.suite = arguments.suite;
  query.branch = arguments.branch;
  query.machine = arguments.machine;
  auto database = SIPPLAB_TRY_OR(fail, read_history(arguments.database));
  auto series = SIPPLAB_TRY_OR(fail, db::read_trend(database, query));
  if (series.empty()) {
    const char* expected = query.metric->of_case
                               ? " of such a case, suite, branch and machine; `sipplab sql 'SELECT DISTINCT "
                                 "case_id, environment, robots, ssi_s FROM v_run_cells'` lists cases"
                               : " of any commit, expected runs that were recorded in a git checkout";
    return fail(kNothingComparable, database.path().string() + ": no " + arguments.metric + expected);
  }
  db::mark_changes(series, *query.metric, arguments.rules);
  if (arguments.svg) {
    const auto picture =
        SIPPLAB_TRY_OR(fail, bench::pictures_of({bench::trend_chart(*query.metric, series)}, format));
    if (const auto error = write_file(*arguments.svg, picture.front())) return fail(error->message());
  }
  print(arguments.json ? db::json_text(bench::trend_json(*query.metric, series))
                       : bench::trend_text(*query.metric, series, arguments.rows));
  return kSuccess;
}

std::string metric_names() {
  std::string names;
  for (const db::TrendMetric& metric : db::trend_metrics()) {
    names += (names.empty() ? "" : ", ") + std::string(metric.name);
  }
  return names;
}

}  // namespace

Command add_trend_command(CLI::App& program) {
  auto arguments = std::make_shared<TrendArguments>();
  CLI::App* command = program.add_subcommand("trend", "the history of a metric, and where its level changed");
  command->add_option("metric", arguments->metric, metric_names())
      ->required()
      ->check([](const std::string& text) {
        return db::find_trend_metric(text) != nullptr
                   ? std::string()
                   : in_quotes(text) + ", expected one of " + metric_names();
      });
  add_case_flag(*command, arguments->cases);
  command->add_option("--suite", arguments->suite, "only runs of this suite");
  command->add_option("--branch", arguments->branch, "only runs of a checkout of this branch");
  command->add_option(
      "--machine", arguments->machine,
      "only this host (or $SIPPLAB_MACHINE of its runs), or this beginning of a machine fingerprint");
  command->add_option("--rows", arguments->rows, "number of newest versions to show of a single case")
      ->capture_default_str();
  command
      ->add_option("--min-segment", arguments->rules.search.min_segment,
                   "least number of versions between two changes")
      ->check(CLI::Range(2, 1'000))
      ->capture_default_str();
  command
      ->add_option("--min-effect", arguments->rules.min_effect,
                   "smallest change marked, 0.05 is 5 % (of a rate: 5 points); default by metric")
      ->check(real_between(0, kGreatestEffect));
  command->add_option("--seed", arguments->rules.search.seed, "seed of the permutation tests")
      ->capture_default_str();
  command->add_option("--svg", arguments->svg, "write a picture, .svg or .pdf")->type_name("FILE");
  add_database_flag(*command, arguments->database);
  command->add_flag("--json", arguments->json, "print one JSON document");
  command->footer(
      "One point for each commit: the median of its runs; builds with uncommitted changes are points of\n"
      "their own. Times are compared on one machine and kind of build only, results on one set of\n"
      "instances: a case that was planned on several sets has a series for each. Flowtime, makespan and\n"
      "mean-runtime are means over the plannings that all versions shown solved, with the share that each\n"
      "solved beside; where there are none no change is marked. Runs that solved less than half as much as\n"
      "the best one are left out. A change is marked when it is significant over all series shown and not\n"
      "too small; it informs, `sipplab gate` decides.");
  return {command, [arguments] { return run_trend(*arguments); }};
}

}  // namespace sipplab::cli
