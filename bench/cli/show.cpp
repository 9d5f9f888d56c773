// sipplab show: one run, a line for each case.
#include <memory>
#include <string>

#include "bench/cli/commands.hpp"
#include "bench/cli/console.hpp"
#include "bench/cli/history.hpp"
#include "db/database.hpp"
#include "db/queries.hpp"

namespace sipplab::cli {
namespace {

struct ShowArguments {
  HistoryFlags history;
  std::string run = "latest";
};

int run_show(const ShowArguments& arguments) {
  auto database = SIPPLAB_TRY_OR(fail, read_history(arguments.history.database));
  const auto report = SIPPLAB_TRY_OR(fail, db::show_run(database, arguments.run));
  print(db::format_run_report(report, arguments.history.output_format()));
  return kSuccess;
}

}  // namespace

Command add_show_command(CLI::App& program) {
  auto arguments = std::make_shared<ShowArguments>();
  CLI::App* command = program.add_subcommand("show", "show one run, case by case");
  arguments->history.add_to(*command);
  command->add_option("run", arguments->run, "UUID, its first four or more digits, or latest")
      ->capture_default_str();
  return {command, [arguments] { return run_show(*arguments); }};
}

}  // namespace sipplab::cli
