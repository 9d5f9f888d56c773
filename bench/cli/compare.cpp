// sipplab compare: two runs, commits or branches of the history, instance by instance.
#include <limits>
#include <memory>
#include <optional>
#include <string>
#include <utility>

#include "bench/cli/commands.hpp"
#include "bench/cli/console.hpp"
#include "bench/cli/history.hpp"
#include "bench/cli/planner_flags.hpp"
#include "bench/cli/report_flags.hpp"
#include "bench/judge/report.hpp"
#include "db/comparisons.hpp"

namespace sipplab::cli {
namespace {

struct CompareArguments {
  std::optional<std::string> database;
  std::string base;
  std::string head;
  bool list = false;
  bool exact = false;
  ReportFlags report;
};

int run_compare(const CompareArguments& arguments) {
  auto database = SIPPLAB_TRY_OR(fail, read_history(arguments.database));
  const auto base = SIPPLAB_TRY_OR(fail, db::resolve_side(database, arguments.base));
  const auto head = SIPPLAB_TRY_OR(fail, db::resolve_side(database, arguments.head));
  auto cells = SIPPLAB_TRY_OR(fail, db::paired_cells(database, base, head));
  bench::Judgement judgement = bench::measured(std::move(cells));
  if (judgement.all.compared == 0) {
    return fail(kNothingComparable, "sipplab: " + base.title + " and " + head.title +
                                        " share no case and instance, expected runs of one suite");
  }
  bench::JudgeOptions options;
  options.floors = floors_of(arguments.report);
  bench::judge(judgement, options);
  const auto side = [](const db::ComparisonSide& named) -> nlohmann::ordered_json {
    return {{"title", named.title},
            {"commit", named.commit_hash ? nlohmann::ordered_json(*named.commit_hash) : nullptr}};
  };
  bench::Report report{judgement, "sipplab compare", base.title, head.title};
  report.details = {{"base", side(base)}, {"head", side(head)}};
  report.all_findings = "--list";
  if (arguments.list) report.listed = std::numeric_limits<std::size_t>::max();
  ReportFlags flags = arguments.report;
  flags.expects_changes = !arguments.exact;
  return print_report(report, flags);
}

}  // namespace

Command add_compare_command(CLI::App& program) {
  auto arguments = std::make_shared<CompareArguments>();
  CLI::App* command =
      program.add_subcommand("compare", "compare two runs, commits or branches, instance by instance");
  command->footer(
      "A and B are `latest`, a run's UUID or a commit's hash (four digits or more of either), or a branch;\n"
      "`run:`, `commit:` or `branch:` before it says which. For a commit, the newest result of each case\n"
      "counts. Judged over all cells together: success, flowtime, makespan, expansions, generations, tries,\n"
      "instructions; then in each: success, flowtime, expansions. Times and peak memory of two sweeps "
      "inform\n"
      "alone. Exit codes: 0 nothing is worse for certain; 1 regressed; 3 inconclusive (it may be worse by\n"
      "more than the floor); 4 nothing comparable; with --exact 5 other plans.");
  command->add_option("A", arguments->base, "base: a run, a commit or a branch")->required();
  command->add_option("B", arguments->head, "head: what is judged")->required();
  add_database_flag(*command, arguments->database);
  command->add_flag("--exact", arguments->exact, "exit code 5 if plans differ");
  command->add_flag("--list", arguments->list, "list every flip and difference, not just the first ten");
  add_report_flags(*command, arguments->report);
  return {command, [arguments] { return run_compare(*arguments); }};
}

}  // namespace sipplab::cli
