// sipplab plot: one picture from the history.
#include <fmt/core.h>

#include <algorithm>
#include <filesystem>
#include <iterator>
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
#include "bench/present/plots.hpp"
#include "db/database.hpp"
#include "db/queries.hpp"
#include "planner/io/text_file.hpp"

namespace sipplab::cli {
namespace {

struct PlotArguments {
  std::string kind;
  std::vector<std::string> runs;
  std::vector<std::string> cases;
  std::vector<std::string> sides;
  std::optional<std::string> file;
  std::optional<std::string> database;
};

using Drawn = Expected<bench::Chart, std::string>;

/// A picture of any runs, and what it needs of them beside the summaries of their cases.
struct Picture {
  const char* name;
  const char* shows;
  bool results;
  bool steps;
  Drawn (*draw)(const bench::PlotRequest&);
};

using bench::Measure;
constexpr Picture kPictures[] = {
    {"success", "share solved over robots, with 95 % intervals", false, false,
     [](const bench::PlotRequest& of) -> Drawn { return bench::success_chart(of); }},
    {"runtime", "median planning time of solved results over robots", false, false,
     [](const bench::PlotRequest& of) -> Drawn { return bench::runtime_chart(of); }},
    {"cactus", "results solved within a time", true, false,
     [](const bench::PlotRequest& of) -> Drawn { return bench::cactus_chart(of); }},
    {"box-runtime", "box plots of planning time over robots", true, false,
     [](const bench::PlotRequest& of) -> Drawn { return bench::box_chart(of, Measure::kRuntimes); }},
    {"box-flowtime", "box plots of flowtime over robots", true, false,
     [](const bench::PlotRequest& of) -> Drawn { return bench::box_chart(of, Measure::kFlowtimes); }},
    {"box-makespan", "box plots of makespan over robots", true, false,
     [](const bench::PlotRequest& of) -> Drawn { return bench::box_chart(of, Measure::kMakespans); }},
    {"improvement", "mean gap of flowtime over time", false, true,
     [](const bench::PlotRequest& of) -> Drawn { return bench::improvement_chart(of); }},
    {"scatter", "planning times of two sides, instance by instance", true, false,
     [](const bench::PlotRequest& of) -> Drawn { return bench::scatter_chart(of, Measure::kRuntimes); }},
    {"scatter-flowtime", "flowtimes of two sides", true, false,
     [](const bench::PlotRequest& of) -> Drawn { return bench::scatter_chart(of, Measure::kFlowtimes); }},
};
constexpr const char* kFigure = "figure1";
constexpr const char* kTable = "table1";

int save(const PlotArguments& arguments, bench::PictureFormat format, const bench::Chart& chart,
         const std::string& nothing) {
  if (bench::is_empty(chart))
    return fail(kNothingComparable, "sipplab: nothing to draw, expected " + nothing);
  const auto picture = SIPPLAB_TRY_OR(fail, bench::pictures_of({chart}, format));
  if (!arguments.file) {
    print(picture.front());
    return kSuccess;
  }
  if (const auto error = write_file(*arguments.file, picture.front())) return fail(error->message());
  return kSuccess;
}

/// A picture of the paper is of one run, and of cells of its own.
int plot_paper(const PlotArguments& arguments, bench::PictureFormat format) {
  if (arguments.runs.size() > 1) {
    return bad_usage(arguments.kind + " shows one run, expected not " +
                     std::to_string(arguments.runs.size()));
  }
  if (!arguments.cases.empty())
    return bad_usage(arguments.kind + " has cells of its own, expected no --case");
  const std::filesystem::path path = db::database_path(arguments.database);
  auto database = SIPPLAB_TRY_OR(fail, db::Database::open_read_only(path));
  const auto uuid = SIPPLAB_TRY_OR(fail, db::resolve_run(database, arguments.runs.front()));
  const auto cells = SIPPLAB_TRY_OR(fail, bench::measured_cells(path, uuid));
  const auto report = SIPPLAB_TRY_OR(fail, db::show_run(database, uuid));
  const std::string words = bench::run_words(report.run);
  return save(
      arguments, format,
      arguments.kind == kFigure ? bench::figure_chart(cells, words) : bench::table_chart(cells, words),
      "a run with cells of the paper: `sipplab reproduce`");
}

int run_plot(const PlotArguments& arguments) {
  auto format = bench::PictureFormat::kSvg;
  if (arguments.file) format = SIPPLAB_TRY_OR(bad_usage, bench::picture_format(*arguments.file));
  const bool scattered = arguments.kind.starts_with("scatter");
  if (!arguments.sides.empty() && (!scattered || arguments.sides.size() != 2)) {
    return bad_usage("--side, expected two of them, and a scatter plot");
  }
  if (arguments.kind == kFigure || arguments.kind == kTable) return plot_paper(arguments, format);
  bench::PlotRequest request;
  request.filter = SIPPLAB_TRY_OR(bad_usage, parse_case_filter(arguments.cases));
  if (request.filter.id)
    return bad_usage("--case with a case's number, expected values of columns such as robots=64");
  request.side_names = arguments.sides;
  for (const std::string& side : arguments.sides) {
    request.sides.push_back(SIPPLAB_TRY_OR(bad_usage, parse_case_filter({side})));
  }
  const Picture& picture = *std::find_if(std::begin(kPictures), std::end(kPictures),
                                         [&](const Picture& known) { return known.name == arguments.kind; });
  const std::filesystem::path path = db::database_path(arguments.database);
  for (const std::string& run : arguments.runs) {
    request.runs.push_back(
        SIPPLAB_TRY_OR(fail, bench::read_plotted_run(path, run, picture.results, picture.steps)));
  }
  const auto chart = picture.draw(request);
  if (!chart) return fail(kNothingComparable, chart.error());
  return save(
      arguments, format, *chart,
      picture.steps ? "improved results of such cases in the runs" : "results of such cases in the runs");
}

}  // namespace

Command add_plot_command(CLI::App& program) {
  auto arguments = std::make_shared<PlotArguments>();
  arguments->runs = {"latest"};
  CLI::App* command =
      program.add_subcommand("plot", "one picture from the history, as SVG or PDF, by gnuplot");
  std::vector<std::string> names{kFigure, kTable};
  std::string footer = "Pictures:\n";
  const auto list = [&footer](const std::string& name, const std::string& shows) {
    footer += fmt::format("  {:<18}{}\n", name, shows);
  };
  for (const Picture& picture : kPictures) {
    names.emplace_back(picture.name);
    list(picture.name, picture.shows);
  }
  list(kFigure, "Figure 1 of the paper: share solved over robots, a line for each start-safe interval");
  list(kTable, "Table 1 of the paper: seconds in the warehouse, beside the published ones");
  command->footer(
      footer +
      "Times, flowtimes and makespans are of solved results. Hollow symbols: fewer than half are solved.");
  command->add_option("picture", arguments->kind, "what to draw")->required()->check(CLI::IsMember(names));
  command
      ->add_option("run,--run", arguments->runs,
                   "UUID, its first four or more digits, or latest; several are drawn side by side")
      ->capture_default_str();
  add_case_flag(*command, arguments->cases);
  command
      ->add_option(
          "--side", arguments->sides,
          "for scatter, given twice: values of the cases on each side, such as reschedule=none; default: "
          "two runs, or whatever has two values")
      ->type_name("CASE");
  command
      ->add_option("-o,--output", arguments->file,
                   "file to write, .svg or .pdf; default: SVG to standard output")
      ->type_name("FILE");
  add_database_flag(*command, arguments->database);
  return {command, [arguments] { return run_plot(*arguments); }};
}

}  // namespace sipplab::cli
