// sipplab compare: two runs, commits or branches of the history, instance by instance.
#include <limits>
#include <memory>
#include <optional>
#include <string>

#include "bench/cli/commands.hpp"
#include "bench/cli/console.hpp"
#include "bench/cli/history.hpp"
#include "bench/cli/planner_flags.hpp"
#include "bench/judge/compare.hpp"
#include "bench/judge/report.hpp"
#include "db/comparisons.hpp"
#include "planner/io/text_file.hpp"

namespace sipplab::cli {
namespace {

struct CompareArguments {
  std::optional<std::string> database;
  std::string base;
  std::string head;
  std::string format = "text";
  bool json = false;
  bool list = false;
  std::optional<std::string> junit;
  bench::CompareOptions options;
};

int exit_code(bench::CompareVerdict verdict) {
  switch (verdict) {
    case bench::CompareVerdict::kSame:
    case bench::CompareVerdict::kChanged:
      return kSuccess;
    case bench::CompareVerdict::kInconclusive:
      return kInconclusive;
    case bench::CompareVerdict::kRegressed:
      return kNegativeVerdict;
  }
  return kInternalError;
}

int run_compare(const CompareArguments& arguments) {
  auto database = db::Database::open_read_only(db::database_path(arguments.database));
  if (!database) return fail(database.error());
  const auto base = db::resolve_side(*database, arguments.base);
  if (!base) return fail(base.error());
  const auto head = db::resolve_side(*database, arguments.head);
  if (!head) return fail(head.error());
  const auto cells = db::paired_cells(*database, *base, *head);
  if (!cells) return fail(cells.error());
  const bench::CompareResult result = bench::compare(*cells, arguments.options);
  if (result.compared == 0) {
    return fail(kNothingComparable, "sipplab: " + base->title + " and " + head->title +
                                        " share no case and instance, expected runs of one suite");
  }
  bench::CompareReport report{*base, *head, result};
  if (arguments.list) report.listed = std::numeric_limits<std::size_t>::max();
  if (arguments.json || arguments.format == "json") {
    print(bench::compare_json(report));
  } else if (arguments.format == "markdown") {
    print(bench::compare_markdown(report));
  } else {
    print(bench::compare_text(report));
  }
  if (arguments.junit) {
    const auto error = write_file(*arguments.junit, bench::compare_junit(report));
    if (error) return fail(kBadUsage, error->message());
  }
  return exit_code(result.verdict);
}

}  // namespace

Command add_compare_command(CLI::App& program) {
  auto arguments = std::make_shared<CompareArguments>();
  CLI::App* command =
      program.add_subcommand("compare", "compare two runs, commits or branches, instance by instance");
  command->footer(
      "A and B are `latest`, a run's UUID or a commit's hash (four digits or more of either), or a branch;\n"
      "`run:`, `commit:` or `branch:` before it says which. Of a commit, the newest result of each case\n"
      "counts. Exit codes: 0 same, or changed and nothing worse; 1 regressed (fewer solved, invalid plans,\n"
      "longer flowtimes); 3 inconclusive (fewer solved, which may be chance); 4 nothing comparable.");
  command->add_option("A", arguments->base, "base: a run, a commit or a branch")->required();
  command->add_option("B", arguments->head, "head: what is judged")->required();
  add_database_flag(*command, arguments->database);
  command->add_flag("--exact", arguments->options.exact, "any difference is a regression");
  command->add_flag("--list", arguments->list, "list every flip and difference, not just the first ten");
  command->add_option("--format", arguments->format, "text, markdown (for a pull request) or json")
      ->check(CLI::IsMember({"text", "markdown", "json"}))
      ->capture_default_str();
  command->add_flag("--json", arguments->json, "the same as --format json");
  command->add_option("--junit", arguments->junit, "write JUnit's XML as well")->type_name("FILE");
  return {command, [arguments] { return run_compare(*arguments); }};
}

}  // namespace sipplab::cli
