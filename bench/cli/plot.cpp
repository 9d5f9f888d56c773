// sipplab plot: one picture from the history.
#include <algorithm>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "bench/cli/case_filter.hpp"
#include "bench/cli/commands.hpp"
#include "bench/cli/console.hpp"
#include "bench/cli/history.hpp"
#include "bench/cli/planner_flags.hpp"
#include "bench/present/paper_report.hpp"
#include "bench/present/runtime_chart.hpp"
#include "db/database.hpp"
#include "db/queries.hpp"
#include "planner/io/text_file.hpp"

namespace sipplab::cli {
namespace {

constexpr const char* kRuntime = "runtime";

struct PlotArguments {
  std::string kind;
  std::vector<std::string> runs;
  std::vector<std::string> cases;
  std::optional<std::string> file;
  std::optional<std::string> database;
};

/// What a picture is drawn from.
struct PlottedRuns {
  std::vector<db::RunReport> reports;
  std::vector<bench::MeasuredCell> paper_cells;
};

db::Result<PlottedRuns> read_runs(const PlotArguments& arguments) {
  const std::filesystem::path path = db::database_path(arguments.database);
  auto database = SIPPLAB_TRY(db::Database::open_read_only(path));
  PlottedRuns runs;
  for (const std::string& run : arguments.runs) {
    const auto uuid = SIPPLAB_TRY(db::resolve_run(database, run));
    runs.reports.push_back(SIPPLAB_TRY(db::show_run(database, uuid)));
    if (arguments.kind == kRuntime) continue;
    auto cells = SIPPLAB_TRY(bench::measured_cells(path, uuid));
    runs.paper_cells.insert(runs.paper_cells.end(), cells.begin(), cells.end());
  }
  return runs;
}

int run_plot(const PlotArguments& arguments) {
  const bool of_paper = arguments.kind != kRuntime;
  if (of_paper && arguments.runs.size() > 1) {
    return bad_usage(arguments.kind + " shows one run, expected not " +
                     std::to_string(arguments.runs.size()));
  }
  if (of_paper && !arguments.cases.empty()) {
    return bad_usage(arguments.kind + " has cells of its own, expected no --case");
  }
  const auto filter = SIPPLAB_TRY_OR(bad_usage, parse_case_filter(arguments.cases));
  if (filter.id)
    return bad_usage("--case with a case's number, expected values of columns such as robots=64");
  const auto runs = SIPPLAB_TRY_OR(fail, read_runs(arguments));
  const bench::Chart chart = arguments.kind == "figure1"  ? bench::figure_chart(runs.paper_cells)
                             : arguments.kind == "table1" ? bench::table_chart(runs.paper_cells)
                                                          : bench::runtime_chart(runs.reports, filter);
  const bool empty = std::all_of(chart.lines.begin(), chart.lines.end(),
                                 [](const bench::ChartLine& line) { return line.points.empty(); });
  if (empty) {
    return fail(kNothingComparable, "sipplab: nothing to draw, expected " +
                                        (of_paper ? "a run with cells of the paper: `sipplab reproduce`"
                                                  : std::string("results of such cases in the run")));
  }
  const std::string picture = bench::svg(chart, bench::SvgUse::kFile);
  if (!arguments.file) {
    print(picture);
    return kSuccess;
  }
  if (const auto error = write_file(*arguments.file, picture)) return fail(error->message());
  return kSuccess;
}

}  // namespace

Command add_plot_command(CLI::App& program) {
  auto arguments = std::make_shared<PlotArguments>();
  arguments->runs = {"latest"};
  CLI::App* command = program.add_subcommand("plot", "one picture from the history, as SVG");
  command
      ->add_option("picture", arguments->kind,
                   "figure1: share solved over robots, a line for each start-safe interval; table1: seconds "
                   "in the warehouse beside the paper's; runtime: median planning time of any runs")
      ->required()
      ->check(CLI::IsMember({"figure1", "table1", kRuntime}));
  command
      ->add_option("run", arguments->runs,
                   "UUID, its first four or more digits, or latest; several for runtime")
      ->capture_default_str();
  add_case_flag(*command, arguments->cases);
  command->add_option("-o,--output", arguments->file, "file to write; default: standard output")
      ->type_name("FILE");
  add_database_flag(*command, arguments->database);
  return {command, [arguments] { return run_plot(*arguments); }};
}

}  // namespace sipplab::cli
