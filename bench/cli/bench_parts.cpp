#include "bench/cli/bench_parts.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <nlohmann/json.hpp>

#include "bench/cli/console.hpp"
#include "bench/cli/history.hpp"
#include "bench/sweep/shard.hpp"
#include "bench/sweep/shell_command.hpp"
#include "bench/sweep/task_plan.hpp"
#include "db/run_names.hpp"
#include "planner/io/text.hpp"

namespace sipplab::cli {
Expected<db::Done, std::string> deal_out(const BenchArguments& arguments, const db::RunInfo& info,
                                         bench::ExpandedSweep& cases) {
  if (!arguments.shard) {
    bench::deal_all(cases, arguments.repetitions);
    return db::Done{};
  }
  const bench::Shard shard = bench::parse_shard(*arguments.shard).value_or(bench::Shard{});
  std::vector<double> seconds;
  for (const bench::NamedCase& named : cases.cases)
    seconds.push_back(bench::expected_seconds(named.parameters));
  if (arguments.task) {
    const auto plan = SIPPLAB_TRY(bench::read_task_plan(*arguments.task));
    if (plan.binary_hash != info.build.binary_hash) {
      return Unexpected{*arguments.task +
                        " was planned by another build, expected the program that planned it"};
    }
    if (plan.options != info.options || plan.seconds.size() != seconds.size()) {
      return Unexpected{*arguments.task +
                        ": its instances have changed, expected what they were when it was planned"};
    }
    seconds = plan.seconds;
  }
  bench::deal(cases, arguments.repetitions, shard, arguments.seed, seconds);
  if (cases.cases.empty()) {
    return Unexpected{fmt::format("--shard {}: no planning is left for it, expected at most {} shards",
                                  *arguments.shard, info.planned.value_or(0))};
  }
  return db::Done{};
}

db::Result<std::optional<db::EarlierRun>> take_up(const BenchArguments& arguments, db::Database& database,
                                                  const db::RunInfo& info, bench::ExpandedSweep& sweep) {
  const bool resumes = arguments.resume->count() > 0;
  std::optional<std::string> named;
  if (!arguments.resumed_run.empty()) named = arguments.resumed_run;
  std::optional<db::EarlierRun> earlier;
  if (resumes || !info.uuid.empty()) earlier = SIPPLAB_TRY(db::find_earlier_run(database, info, named));
  // Another shard joins its run without a word; the same one again may be a mistake.
  if (earlier && !resumes && earlier->has_shard) {
    return Unexpected{db::run_is_there(database, earlier->uuid)};
  }
  if (resumes && !earlier && !arguments.task)
    diagnose("no run of this command and build: starting a new one");
  if (!earlier) return earlier;
  if (earlier->being_written) {
    return Unexpected{db::Error{db::ErrorKind::kBadInput,
                                fmt::format("{}: run {} is being written, expected its process to have ended",
                                            database.path().string(), earlier->uuid)}};
  }
  const std::size_t all = bench::count_left(sweep);
  bench::leave_out(sweep, SIPPLAB_TRY(db::recorded_cases(database, earlier->uuid)));
  const std::size_t left = bench::count_left(sweep);
  diagnose(fmt::format("resuming run {}: {} of {} plannings are there", earlier->uuid, all - left, all));
  return earlier;
}

int plan_tasks(const BenchArguments& arguments, const db::RunInfo& info, const bench::ExpandedSweep& cases) {
  const std::filesystem::path folder = *arguments.plan_tasks;
  std::error_code error;
  std::filesystem::create_directories(folder, error);
  if (std::filesystem::exists(folder / "sweep.json", error)) {
    return bad_usage(folder.string() +
                     " holds a sweep, expected an empty folder, or `sipplab task` for that one");
  }
  std::optional<db::Database> history;
  const std::filesystem::path path = db::database_path(arguments.database);
  if (std::filesystem::exists(path, error)) {
    history = SIPPLAB_TRY_OR(fail, db::Database::open_read_only(path));
  }
  bench::TaskPlan plan;
  plan.sweep = info.uuid.empty() ? db::new_uuid() : info.uuid;
  plan.plannings = info.planned.value_or(0);
  plan.suite = info.suite;
  plan.options = info.options;
  plan.binary_hash = info.build.binary_hash;
  plan.folder = std::filesystem::current_path(error).string();
  plan.arguments = bench::arguments_without(
      arguments.invocation.arguments, {"--plan-tasks", "--tasks", "--seconds-per-task", "--sweep", "--db"});
  plan.seconds = SIPPLAB_TRY_OR(fail, bench::expected_seconds(cases, history ? &*history : nullptr));
  const double seconds = bench::seconds_of_all(cases, arguments.repetitions, plan.seconds);
  plan.tasks = std::min(arguments.tasks.value_or(bench::tasks_for(seconds, arguments.seconds_per_task)),
                        static_cast<std::size_t>(plan.plannings));
  if (const auto failed = bench::write_task_plan(folder, plan)) return fail(*failed);
  if (arguments.json) {
    print_json({{"folder", folder.string()},
                {"sweep", plan.sweep},
                {"tasks", plan.tasks},
                {"plannings", plan.plannings},
                {"expected_seconds", seconds}});
    return kSuccess;
  }
  print(
      fmt::format("{} plannings in {} tasks, about {:.0f} s in all\n", plan.plannings, plan.tasks, seconds));
  diagnose(fmt::format("next: each of `{0} task run {1} I`, I from 1 to {2}, then `{0} task collect {1}`",
                       bench::shell_word(arguments.invocation.program), bench::shell_word(folder.string()),
                       plan.tasks));
  return kSuccess;
}

std::vector<CLI::Option*> add_part_flags(CLI::App& command, BenchArguments& arguments) {
  CLI::Option* shard =
      command
          .add_option("--shard", arguments.shard,
                      "only part I of N of the plannings; `sipplab merge` joins the histories to one run")
          ->check([](const std::string& text) {
            return bench::parse_shard(text)
                       ? std::string()
                       : in_quotes(text) + ", expected I/N with 1 <= I <= N, such as 2/8";
          })
          ->type_name("I/N");
  CLI::Option* sweep = command
                           .add_option("--sweep", arguments.sweep,
                                       "the run's id, or any word; shards with the same one form one run")
                           ->type_name("ID");
  CLI::Option* resume = command
                            .add_option("--resume", arguments.resumed_run,
                                        "do only what RUN lacks; default: the last run of this command")
                            ->expected(0, 1)
                            ->type_name("[RUN]");
  arguments.resume = resume;
  CLI::Option* plan = command
                          .add_option("--plan-tasks", arguments.plan_tasks,
                                      "only split the sweep into tasks of a job array, in DIR")
                          ->excludes(shard)
                          ->excludes(resume)
                          ->type_name("DIR");
  CLI::Option* tasks = command.add_option("--tasks", arguments.tasks, "number of tasks")
                           ->needs(plan)
                           ->check(CLI::Range(std::size_t{1}, std::size_t{1'000'000}));
  CLI::Option* seconds = command
                             .add_option("--seconds-per-task", arguments.seconds_per_task,
                                         "expected duration of a task; makes at most 1000 tasks")
                             ->needs(plan)
                             ->excludes(tasks)
                             ->check(check_positive_real)
                             ->capture_default_str();
  // Internal: given by `sipplab task run`.
  command.add_option("--task-of", arguments.task, "")->needs(shard)->group("");
  return {shard, sweep, resume, plan, tasks, seconds};
}

}  // namespace sipplab::cli
