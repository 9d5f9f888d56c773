// sipplab report: a run as one HTML page, and its density curves as pictures.
#include <filesystem>
#include <memory>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <system_error>
#include <utility>
#include <vector>

#include "bench/cli/commands.hpp"
#include "bench/cli/console.hpp"
#include "bench/cli/history.hpp"
#include "bench/cli/planner_flags.hpp"
#include "bench/present/page.hpp"
#include "db/database.hpp"
#include "planner/io/text_file.hpp"

namespace sipplab::cli {
namespace {

struct ReportArguments {
  std::string run = "latest";
  std::optional<std::string> base;
  std::string folder;
  std::optional<std::string> database;
  bool json = false;
};

int run_report(const ReportArguments& arguments) {
  const auto data = SIPPLAB_TRY_OR(
      fail, bench::read_report(db::database_path(arguments.database), arguments.run, arguments.base));
  const bool comparable = !data.against_base.cells.empty();
  const std::vector<bench::DensityChart> charts =
      bench::density_charts(data.run, comparable ? data.base : std::nullopt);
  std::vector<bench::Chart> drawn;
  for (const bench::DensityChart& density : charts) drawn.push_back(density.chart);
  const auto pictures = SIPPLAB_TRY_OR(fail, bench::pictures_of(drawn, bench::PictureFormat::kSvg));
  std::vector<std::pair<std::string, std::string>> files;
  files.emplace_back("index.html", SIPPLAB_TRY_OR(fail, bench::report_page(data, charts)));
  for (std::size_t i = 0; i < charts.size(); ++i) files.emplace_back(charts[i].name + ".svg", pictures[i]);
  std::error_code error;
  std::filesystem::create_directories(arguments.folder, error);
  if (error) return fail(arguments.folder + ": " + error.message() + ", expected a folder to write to");
  nlohmann::ordered_json names = nlohmann::ordered_json::array();
  for (const auto& [name, text] : files) {
    const std::string path = (std::filesystem::path(arguments.folder) / name).string();
    if (const auto failure = write_file(path, text)) return fail(failure->message());
    names.push_back(path);
    if (!arguments.json) print(path + "\n");
  }
  if (arguments.json) {
    nlohmann::ordered_json document;
    document["run"] = data.run.run.uuid;
    document["base"] =
        data.base ? nlohmann::ordered_json(data.base->run.uuid) : nlohmann::ordered_json(nullptr);
    document["files"] = names;
    print_json(document);
  }
  return kSuccess;
}

}  // namespace

Command add_report_command(CLI::App& program) {
  auto arguments = std::make_shared<ReportArguments>();
  CLI::App* command =
      program.add_subcommand("report", "write a run as one HTML page, with pictures beside it");
  command->add_option("run", arguments->run, "UUID, its first four or more digits, or latest")
      ->capture_default_str();
  command
      ->add_option("--base", arguments->base, "run to compare with; default: the previous run of its suite")
      ->type_name("RUN");
  command->add_option("-o,--output", arguments->folder, "folder to write, created if missing")
      ->required()
      ->type_name("DIR");
  add_database_flag(*command, arguments->database);
  command->add_flag("--json", arguments->json, "print the written files as one JSON document");
  return {command, [arguments] { return run_report(*arguments); }};
}

}  // namespace sipplab::cli
