// sipplab task: one task of a sweep that was split for a job array, and joining what all of them left.
#include <fmt/format.h>
#include <signal.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <filesystem>
#include <memory>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <vector>

#include "bench/cli/commands.hpp"
#include "bench/cli/console.hpp"
#include "bench/cli/history.hpp"
#include "bench/cli/planner_flags.hpp"
#include "bench/sweep/attempt.hpp"
#include "bench/sweep/task_plan.hpp"
#include "db/database.hpp"
#include "db/merge.hpp"
#include "db/queries.hpp"
#include "planner/core/number.hpp"
#include "planner/io/text.hpp"
#include "planner/io/text_file.hpp"

namespace sipplab::cli {
namespace {

namespace fs = std::filesystem;

struct TaskArguments {
  std::string folder;
  std::optional<std::string> index;
  std::optional<std::string> database;
  bool json = false;
};

/// 1 to `tasks`. Schedulers count from 0 or from 1: 0 is the last one, so either way all have their turn.
Expected<std::size_t, std::string> task_number(const TaskArguments& arguments, std::size_t tasks) {
  const std::optional<std::string> text = arguments.index ? arguments.index : bench::array_index();
  if (!text) {
    return Unexpected{std::string("no task: expected its number, or to be in a job array")};
  }
  const auto number = parse_number<std::size_t>(*text);
  if (!number || *number > tasks) {
    return Unexpected{
        fmt::format("task {}, expected a number from 1 to {} (or 0 for the last)", in_quotes(*text), tasks)};
  }
  return *number == 0 ? tasks : *number;
}

volatile sig_atomic_t child = 0;
void pass_on(int signal_number) {
  // Ctrl-C goes to all processes of a terminal.
  if (child > 0 && signal_number != SIGINT) kill(static_cast<pid_t>(child), signal_number);
}

/// Runs this program again with other arguments, hands signals on to it, and waits for it.
int run_again(std::vector<std::string> arguments) {
  arguments.insert(arguments.begin(), "sipplab");
  std::vector<char*> pointers;
  for (std::string& argument : arguments) pointers.push_back(argument.data());
  pointers.push_back(nullptr);
  struct sigaction action = {};
  action.sa_handler = pass_on;
  sigemptyset(&action.sa_mask);
  action.sa_flags = static_cast<int>(SA_RESTART);
  // A signal between the fork and the next line waits for it.
  sigset_t passed;
  sigset_t before;
  sigemptyset(&passed);
  for (const int signal_number : {SIGINT, SIGTERM, SIGUSR1}) sigaddset(&passed, signal_number);
  sigprocmask(SIG_BLOCK, &passed, &before);
  posix_spawnattr_t attributes;
  posix_spawnattr_init(&attributes);
  posix_spawnattr_setsigmask(&attributes, &before);
  posix_spawnattr_setflags(&attributes, POSIX_SPAWN_SETSIGMASK);
  pid_t started = 0;
  const int failed = posix_spawn(&started, "/proc/self/exe", nullptr, &attributes, pointers.data(), environ);
  posix_spawnattr_destroy(&attributes);
  if (failed != 0)
    return fail(kInternalError, std::string("sipplab: cannot run itself: ") + std::strerror(failed));
  child = started;
  for (const int signal_number : {SIGINT, SIGTERM, SIGUSR1}) sigaction(signal_number, &action, nullptr);
  sigprocmask(SIG_SETMASK, &before, nullptr);
  int status = 0;
  while (waitpid(started, &status, 0) < 0 && errno == EINTR) {
  }
  return WIFSIGNALED(status) ? kSignalExitBase + WTERMSIG(status) : WEXITSTATUS(status);
}

int run_task(const TaskArguments& arguments) {
  std::error_code error;
  const fs::path folder = fs::absolute(arguments.folder, error);
  const bench::TaskPlan plan = SIPPLAB_TRY_OR(fail, bench::read_task_plan(folder));
  const std::size_t task = SIPPLAB_TRY_OR(bad_usage, task_number(arguments, plan.tasks));
  // While it is not there, nobody knows of an end.
  fs::remove(bench::exit_file(folder, task), error);
  fs::current_path(plan.folder, error);
  if (error)
    return fail(plan.folder + ": " + error.message() + ", expected the folder where the sweep was planned");
  std::vector<std::string> command = plan.arguments;
  for (const std::string& argument :
       {std::string("--shard"), fmt::format("{}/{}", task, plan.tasks), std::string("--sweep"), plan.sweep,
        std::string("--task-of"), folder.string(), std::string("--db"),
        bench::task_database(folder, task).string(), std::string("--resume")}) {
    command.push_back(argument);
  }
  const int code = run_again(std::move(command));
  const auto failed = write_file(bench::exit_file(folder, task).string(), std::to_string(code) + "\n");
  // If the program failed too, it has said why: mostly for the same reason.
  return failed && code == kSuccess ? fail(failed->message()) : code;
}

void say_failed(const bench::TaskStates& states) {
  constexpr std::size_t kMostLines = 20;
  for (std::size_t i = 0; i < states.failed.size(); ++i) {
    if (i == kMostLines) {
      diagnose(fmt::format("and {} more tasks failed", states.failed.size() - i));
      return;
    }
    diagnose(fmt::format("task {} failed by itself: exit code {}", states.failed[i].first,
                         states.failed[i].second));
  }
}

int show_missing(const TaskArguments& arguments) {
  const bench::TaskPlan plan = SIPPLAB_TRY_OR(fail, bench::read_task_plan(arguments.folder));
  const bench::TaskStates states = bench::states_of(arguments.folder, plan.tasks);
  if (!states.missing.empty()) print(bench::ranges(states.missing) + "\n");
  say_failed(states);
  return kSuccess;
}

int collect(const TaskArguments& arguments) {
  const fs::path folder = arguments.folder;
  const bench::TaskPlan plan = SIPPLAB_TRY_OR(fail, bench::read_task_plan(folder));
  auto database = SIPPLAB_TRY_OR(fail, open_history(arguments.database));
  std::vector<fs::path> sources;
  for (std::size_t task = 1; task <= plan.tasks; ++task) {
    std::error_code error;
    if (fs::exists(bench::task_database(folder, task), error)) {
      sources.push_back(bench::task_database(folder, task));
    }
  }
  const auto report = SIPPLAB_TRY_OR(fail, db::merge_into(database, sources));
  for (const db::Error& error : report.refused) diagnose(error.message);
  const std::size_t files = sources.size() - report.refused.size();
  const std::int64_t added = report.rows_of("result");
  const bench::TaskStates states = bench::states_of(folder, plan.tasks);
  say_failed(states);
  const auto sweeps =
      SIPPLAB_TRY_OR(fail, db::run_sql(database.path(), "SELECT results FROM v_sweeps WHERE run = :sweep",
                                       {{"sweep", plan.sweep}}));
  const std::int64_t results = sweeps.rows.empty() ? 0 : std::get<std::int64_t>(sweeps.rows.front().front());
  const std::int64_t missing = plan.plannings - results;
  if (arguments.json) {
    print_json({{"run", plan.sweep},
                {"database", database.path().string()},
                {"files", files},
                {"added", added},
                {"results", results},
                {"missing", missing},
                {"missing_tasks", bench::ranges(states.missing)}});
  } else {
    print(fmt::format("run {}: {} of {} plannings, {} new, from {} of {} tasks\n", plan.sweep, results,
                      plan.plannings, added, files, plan.tasks));
  }
  if (missing == 0) return kSuccess;
  diagnose(
      fmt::format("{} plannings are missing{}", missing,
                  states.missing.empty() ? std::string() : "; of tasks " + bench::ranges(states.missing)));
  return kNegativeVerdict;
}

}  // namespace

Command add_task_command(CLI::App& program) {
  CLI::App* task = program.add_subcommand(
      "task", "tasks of a job array: run one, collect all (made by `sipplab bench --plan-tasks DIR`)");
  task->require_subcommand(1);
  auto chosen = std::make_shared<std::function<int()>>();
  const auto add = [task, chosen](const char* name, const char* purpose, int (*run)(const TaskArguments&)) {
    auto arguments = std::make_shared<TaskArguments>();
    CLI::App* command = task->add_subcommand(name, purpose);
    command->add_option("dir", arguments->folder, "folder of the plan")->required()->type_name("DIR");
    command->callback([chosen, arguments, run] { *chosen = [arguments, run] { return run(*arguments); }; });
    return std::pair(command, arguments);
  };
  {
    const auto [command, arguments] = add(
        "run", "plan what is missing of a task, into DIR/I.db; its exit code goes to DIR/I.exit", run_task);
    command
        ->add_option("index", arguments->index,
                     "its number; default: what Slurm, SGE, PBS, HTCondor or GNU parallel say")
        ->type_name("I");
  }
  {
    const auto [command, arguments] =
        add("collect",
            "merge what all tasks have into the history, as one run; repeating it changes nothing; "
            "exit code 1: something is missing",
            collect);
    add_database_flag(*command, arguments->database);
    command->add_flag("--json", arguments->json, "print one JSON document");
  }
  add("missing",
      "print the tasks to be run (again), as 1-3,7; those that failed by themselves are only named",
      show_missing);
  return {task, [chosen] { return (*chosen)(); }};
}

}  // namespace sipplab::cli
