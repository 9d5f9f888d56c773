// sipplab planners: programs that --planner knows, and formats of solutions.
#include <fmt/format.h>

#include <memory>
#include <nlohmann/json.hpp>

#include "bench/cli/commands.hpp"
#include "bench/cli/console.hpp"
#include "bench/sweep/known_planners.hpp"
#include "sipplab/solution_io.hpp"

namespace sipplab::cli {
namespace {

int run_planners(bool json) {
  nlohmann::ordered_json planners = nlohmann::ordered_json::array();
  nlohmann::ordered_json formats = nlohmann::ordered_json::array();
  std::string text = "planners: sipplab bench --planner NAME:PATH\n";
  for (const bench::KnownPlanner& planner : bench::known_planners()) {
    planners.push_back({{"name", planner.name},
                        {"words", planner.words},
                        {"command", planner.command},
                        {"format", planner.format},
                        {"needs", planner.needs}});
    text += fmt::format("  {:<12} {}\n  {:<12}   needs: {}\n  {:<12}   {}\n", planner.name, planner.words, "",
                        planner.needs, "", planner.command);
  }
  text += "solutions: --solution-format NAME where guessing fails\n";
  for (const SolutionFormat& format : solution_formats()) {
    formats.push_back({{"name", format.name}, {"words", format.words}, {"written", format.write != nullptr}});
    text += fmt::format("  {:<12} {}\n", format.name, format.words);
  }
  if (json) {
    print_json({{"planners", planners}, {"solution_formats", formats}});
  } else {
    print(text);
  }
  return kSuccess;
}

}  // namespace

Command add_planners_command(CLI::App& program) {
  auto json = std::make_shared<bool>(false);
  CLI::App* command = program.add_subcommand(
      "planners", "list other planners that a sweep can run, and formats of solutions");
  command->add_flag("--json", *json, "print one JSON document");
  return {command, [json] { return run_planners(*json); }};
}

}  // namespace sipplab::cli
