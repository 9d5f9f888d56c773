// sipplab reproduce solvers: every planner that is here, on the same instances, within the same time.
#include "bench/cli/reproduce_solvers.hpp"

#include <fmt/format.h>
#include <unistd.h>

#include <cstdlib>
#include <filesystem>
#include <sstream>
#include <system_error>

#include "bench/cli/console.hpp"
#include "bench/cli/history.hpp"
#include "bench/present/plots.hpp"
#include "bench/present/solvers_report.hpp"
#include "bench/sweep/known_planners.hpp"
#include "db/database.hpp"
#include "planner/io/text_file.hpp"

namespace sipplab::cli {
namespace {

namespace fs = std::filesystem;

/// Programs on PATH that are called as the table calls them.
std::vector<std::string> planners_on_path() {
  std::vector<std::string> found;
  const char* const path = std::getenv("PATH");
  for (const bench::KnownPlanner& planner : bench::known_planners()) {
    std::istringstream folders(path ? path : "");
    for (std::string folder; std::getline(folders, folder, ':');) {
      const fs::path program = fs::path(folder) / planner.name;
      std::error_code ignored;
      if (!fs::is_regular_file(program, ignored) || access(program.c_str(), X_OK) != 0) continue;
      found.push_back(fmt::format("{}:{}", planner.name, program.string()));
      break;
    }
  }
  return found;
}

int present(const SolversArguments& arguments, const fs::path& database,
            const std::vector<std::string>& runs) {
  const auto rows = SIPPLAB_TRY_OR(fail, bench::solver_rows(database, runs));
  print(arguments.sweep.json ? db::format_json(rows) : db::format_aligned(rows));
  if (!arguments.folder) return kSuccess;
  std::error_code ignored;
  fs::create_directories(*arguments.folder, ignored);
  const fs::path folder = *arguments.folder;
  std::string source = "runs";
  for (const std::string& run : runs) source += " " + run.substr(0, bench::kRunDigits);
  const std::string page = SIPPLAB_TRY_OR(fail, bench::solvers_page(rows, source));
  if (const auto error = write_file((folder / "index.html").string(), page)) return fail(error->message());
  std::vector<std::string> names;
  std::vector<bench::Chart> charts;
  for (auto& [name, chart] : bench::solver_charts(rows, source)) {
    names.push_back(name);
    charts.push_back(std::move(chart));
  }
  const auto pictures = SIPPLAB_TRY_OR(fail, bench::pictures_of(charts, bench::PictureFormat::kSvg));
  for (std::size_t i = 0; i < names.size(); ++i) {
    if (const auto error = write_file((folder / (names[i] + ".svg")).string(), pictures[i])) {
      return fail(error->message());
    }
  }
  diagnose("written: " + (folder / "index.html").string());
  return kSuccess;
}

}  // namespace

int run_reproduce_solvers(const SolversArguments& arguments) {
  std::vector<std::string> planners = arguments.planners;
  if (planners.empty()) planners = planners_on_path();
  for (const std::string& planner : planners) {
    if (const auto spec = bench::parse_command_planner(planner, ""); !spec) return bad_usage(spec.error());
  }
  planners.insert(planners.begin(), "");  // this one
  fs::path database;
  std::vector<std::string> runs;
  for (const std::string& planner : planners) {
    for (const bool in_folders : {false, true}) {
      if (in_folders ? arguments.folders.empty() : arguments.no_suite) continue;
      BenchArguments sweep = arguments.sweep;
      sweep.suite = "solvers";
      if (in_folders) sweep.folders = arguments.folders;
      if (!planner.empty()) sweep.planner = planner;
      sweep.retime = true;
      sweep.quiet = true;
      sweep.json = false;
      sweep.when_finished = [&](const fs::path& path, const std::string& run) {
        database = path;
        runs.push_back(run);
        return kSuccess;
      };
      if (const int code = run_bench(sweep, {}); code != kSuccess) return code;
    }
  }
  return present(arguments, database, runs);
}

}  // namespace sipplab::cli
