// sipplab fuzz: runs the fuzz targets, and what the history knows about their runs.
#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <memory>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <vector>

#include "bench/campaigns/campaign.hpp"
#include "bench/campaigns/coverage.hpp"
#include "bench/campaigns/hardest.hpp"
#include "bench/cli/commands.hpp"
#include "bench/cli/console.hpp"
#include "bench/cli/history.hpp"
#include "bench/cli/planner_flags.hpp"
#include "bench/interrupt.hpp"
#include "bench/sweep/run_info.hpp"
#include "db/fuzz_runs.hpp"
#include "planner/io/case_codec.hpp"
#include "planner/io/text_file.hpp"

namespace sipplab::cli {
namespace {

namespace fs = std::filesystem;

struct FuzzArguments {
  HistoryFlags history;
  bench::CampaignOptions campaign;
  std::string programs = "build/fuzz/fuzz";
  std::string sources = "fuzz";
  std::string work = "build/fuzz/runs";

  // list
  std::optional<std::string> target;
  std::size_t limit = 20;

  // coverage
  std::string summary;

  // hardest
  std::vector<std::string> folders;
  std::size_t keep = 12;
  std::optional<std::string> output;
};

std::optional<std::string> problem_of(const bench::CampaignOptions& campaign) {
  const auto targets = bench::targets_of(campaign);
  if (targets.empty()) {
    return fmt::format("{}: no fuzz target there, expected programs built with the preset fuzz",
                       campaign.programs.string());
  }
  for (const std::string& wanted : campaign.targets) {
    if (std::find(targets.begin(), targets.end(), wanted) == targets.end()) {
      return fmt::format("no target '{}', expected one of: {}", wanted, fmt::join(targets, ", "));
    }
  }
  if (!campaign.seconds && !campaign.executions) return "no budget, expected --seconds or --executions";
  return std::nullopt;
}

int run_campaign(FuzzArguments& arguments) {
  bench::CampaignOptions& campaign = arguments.campaign;
  campaign.programs = fs::absolute(arguments.programs);
  campaign.sources = fs::absolute(arguments.sources);
  campaign.work = fs::absolute(arguments.work);
  if (const auto problem = problem_of(campaign)) return fail("sipplab fuzz: " + *problem);
  auto database = SIPPLAB_TRY_OR(fail, open_history(arguments.history.database));
  bench::catch_interrupts("\nsipplab: ending with what was found so far; once more to end at once\n");
  const auto result =
      SIPPLAB_TRY_OR(fail, bench::run_campaign(database, bench::run_origin(), campaign, diagnose));
  for (const std::string& skipped : result.skipped) {
    diagnose(skipped + ": skipped, this very program was fuzzed before and nothing was found");
  }
  db::FuzzRunFilter filter;
  filter.campaign = result.campaign;
  const auto table = SIPPLAB_TRY_OR(fail, db::list_fuzz_runs(database, filter));
  arguments.history.show(table);
  if (bench::interrupted_by() != 0) return kSignalExitBase + bench::interrupted_by();
  if (!result.findings.empty()) return kNegativeVerdict;
  return result.broken ? kInconclusive : kSuccess;
}

int run_list(const FuzzArguments& arguments) {
  auto database = SIPPLAB_TRY_OR(fail, read_history(arguments.history.database));
  db::FuzzRunFilter filter;
  filter.target = arguments.target;
  filter.limit = arguments.limit;
  const auto table = SIPPLAB_TRY_OR(fail, db::list_fuzz_runs(database, filter));
  arguments.history.show(table);
  return kSuccess;
}

int run_coverage(const FuzzArguments& arguments) {
  const auto text = SIPPLAB_TRY_OR(fail, read_file(arguments.summary));
  const auto files = SIPPLAB_TRY_OR(fail, bench::parse_coverage(text, arguments.summary));
  auto database = SIPPLAB_TRY_OR(fail, open_history(arguments.history.database));
  const auto campaign = SIPPLAB_TRY_OR(fail, db::latest_fuzz_campaign(database));
  SIPPLAB_TRY_OR(fail, db::record_fuzz_coverage(database, campaign, files));
  const auto table = SIPPLAB_TRY_OR(fail, db::list_fuzz_coverage(database, campaign));
  arguments.history.show(table);
  return kSuccess;
}

int run_hardest(const FuzzArguments& arguments) {
  const auto cases = bench::distinct_cases(bench::hardest_cases(arguments.folders), arguments.keep);
  if (cases.empty()) return fail("sipplab fuzz: no case with robots in these folders, expected one");
  db::Table table{
      {"file", "robots", "cells", "reschedule", "status", "tries", "expansions", "expansions_per_robot"}, {}};
  for (const bench::HardCase& hard : cases) {
    const auto count = [](auto number) { return db::Value{static_cast<std::int64_t>(number)}; };
    table.rows.push_back({hard.file.filename().string(), count(hard.plan_case.instance.agents.size()),
                          count(hard.plan_case.instance.map.cell_count()),
                          std::string(name(hard.plan_case.options.rescheduling)),
                          std::string(name(hard.status)), count(hard.tries), count(hard.expansions),
                          hard.expansions_per_robot()});
    if (!arguments.output) continue;
    std::error_code ignored;
    fs::create_directories(*arguments.output, ignored);
    const fs::path file = fs::path(*arguments.output) / fmt::format("{:02}.case", table.rows.size());
    if (const auto error = write_file(file.string(), encode_case(hard.plan_case))) {
      return fail(error->message());
    }
  }
  arguments.history.show(table);
  return kSuccess;
}

CLI::App* add_run(CLI::App& fuzz, FuzzArguments& arguments) {
  CLI::App* run = arguments.history.add_command(
      fuzz, "run", "run fuzz targets; exit code 1 with findings, 3 if a target did not run");
  bench::CampaignOptions& campaign = arguments.campaign;
  run->add_option("--programs", arguments.programs, "folder of the targets' programs")->capture_default_str();
  run->add_option("--sources", arguments.sources, "folder with corpus/, regressions/ and dictionaries/")
      ->capture_default_str();
  run->add_option("--work", arguments.work, "folder where corpora grow, with logs and pictures of findings")
      ->capture_default_str();
  run->add_option(
         "--mode", campaign.mode,
         "smoke: the same inputs each time; for: until the budget is used up; nightly: several processes")
      ->check(CLI::IsMember({"smoke", "for", "nightly"}))
      ->capture_default_str();
  run->add_option("--target", campaign.targets, "only these targets");
  run->add_option("--seconds", campaign.seconds, "budget, shared by all targets and by what they find")
      ->check(check_positive_real);
  run->add_option("--executions", campaign.executions, "budget of each target")->check(CLI::PositiveNumber);
  run->add_option("--seed", campaign.seed, "seed of the engine")
      ->check(CLI::Range(1U, 4294967295U))
      ->capture_default_str();
  run->add_option("--workers", campaign.workers,
                  "number of processes: of one target in a nightly run, else one per target")
      ->check(CLI::Range(1, 256))
      ->capture_default_str();
  run->add_flag("--skip-known", campaign.skip_known,
                "leave out programs that were fuzzed before without findings");
  return run;
}

}  // namespace

Command add_fuzz_command(CLI::App& program) {
  auto arguments = std::make_shared<FuzzArguments>();
  CLI::App* fuzz = program.add_subcommand("fuzz", "run the fuzz targets and list their runs");
  fuzz->require_subcommand(1);
  CLI::App* run = add_run(*fuzz, *arguments);
  CLI::App* list = arguments->history.add_command(*fuzz, "list", "runs of targets, newest first");
  list->add_option("--target", arguments->target, "only this target");
  list->add_option("--limit", arguments->limit, "most rows to show; 0: all")->capture_default_str();
  CLI::App* coverage = arguments->history.add_command(
      *fuzz, "coverage", "record the coverage of the newest campaign and print it");
  coverage->add_option("summary", arguments->summary, "what llvm-cov export -summary-only printed")
      ->required();
  CLI::App* hardest = arguments->history.add_command(
      *fuzz, "hardest", "list the cases that need the most expansions per robot");
  hardest->add_option("folder", arguments->folders, "folders of cases")->required();
  hardest->add_option("--keep", arguments->keep, "number of cases to keep, of different kinds")
      ->capture_default_str();
  hardest->add_option("-o,--output", arguments->output, "write them there as 01.case, 02.case, ...")
      ->type_name("DIR");

  return {fuzz, [=] {
            if (run->parsed()) return run_campaign(*arguments);
            if (list->parsed()) return run_list(*arguments);
            if (coverage->parsed()) return run_coverage(*arguments);
            return run_hardest(*arguments);
          }};
}

}  // namespace sipplab::cli
