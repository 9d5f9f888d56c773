// sipplab runs: what the history holds, newest first; and leaving a run out of
// comparisons, with a reason.
#include <memory>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>

#include "bench/cli/commands.hpp"
#include "bench/cli/console.hpp"
#include "bench/cli/history.hpp"
#include "db/database.hpp"
#include "db/queries.hpp"

namespace sipplab::cli {
namespace {

struct RunsArguments {
  HistoryFlags history;
  std::optional<std::string> kind;
  std::optional<std::string> suite;
  std::size_t limit = 20;
  bool all = false;
  std::optional<std::string> exclude;
  std::optional<std::string> reason;
  std::optional<std::string> include;
};

int change_exclusion(const RunsArguments& arguments) {
  const auto path = db::database_path(arguments.history.database);
  // Opened for writing, a missing file would become an empty history.
  if (const auto existing = db::Database::open_read_only(path); !existing) return fail(existing.error());
  auto database = SIPPLAB_TRY_OR(fail, db::Database::open(path));
  SIPPLAB_TRY_OR(fail, arguments.exclude ? db::exclude_run(database, *arguments.exclude, *arguments.reason)
                                         : db::include_run(database, *arguments.include));
  if (arguments.history.output_format() == db::OutputFormat::kJson) {
    nlohmann::ordered_json json;
    json["run"] = arguments.exclude ? *arguments.exclude : *arguments.include;
    json["excluded"] = arguments.exclude.has_value();
    print_json(json);
  }
  return kSuccess;
}

int run_runs(const RunsArguments& arguments) {
  if (arguments.exclude || arguments.include) return change_exclusion(arguments);
  auto database = SIPPLAB_TRY_OR(fail, read_history(arguments.history.database));
  db::RunFilter filter;
  filter.kind = arguments.kind;
  filter.suite = arguments.suite;
  filter.limit = arguments.all ? 0 : arguments.limit;
  filter.include_excluded = arguments.all;
  const auto runs = SIPPLAB_TRY_OR(fail, db::list_runs(database, filter));
  print(db::format_runs(runs, arguments.history.output_format()));
  return kSuccess;
}

}  // namespace

Command add_runs_command(CLI::App& program) {
  auto arguments = std::make_shared<RunsArguments>();
  CLI::App* command = program.add_subcommand("runs", "list the runs of the history, newest first");
  arguments->history.add_to(*command);
  command->add_option("--kind", arguments->kind, "runs of this kind; default: sweeps and imported reports")
      ->check(CLI::IsMember({"sweep", "report", "property", "fuzz", "gate", "all"}));
  command->add_option("--suite", arguments->suite,
                      "only runs of this suite, room of properties or fuzz target");
  command->add_option("--limit", arguments->limit, "number of newest runs to show")->capture_default_str();
  command->add_flag("--all", arguments->all, "show all runs, including excluded ones");
  CLI::Option* exclude =
      command->add_option("--exclude", arguments->exclude, "leave RUN out of comparisons")->type_name("RUN");
  CLI::Option* reason =
      command->add_option("--reason", arguments->reason, "why it is excluded")->needs(exclude);
  exclude->needs(reason);
  command->add_option("--include", arguments->include, "include an excluded run again")
      ->type_name("RUN")
      ->excludes(exclude);
  return {command, [arguments] { return run_runs(*arguments); }};
}

}  // namespace sipplab::cli
