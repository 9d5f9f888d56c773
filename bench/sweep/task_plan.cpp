#include "bench/sweep/task_plan.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <csignal>
#include <nlohmann/json.hpp>
#include <optional>

#include "bench/program.hpp"
#include "bench/sweep/shard.hpp"
#include "db/json_text.hpp"
#include "db/summaries.hpp"
#include "planner/core/number.hpp"
#include "planner/core/try.hpp"
#include "planner/io/text_file.hpp"

namespace sipplab::bench {
namespace {

std::string plan_file(const std::filesystem::path& folder) { return (folder / "sweep.json").string(); }

/// Each member under its name.
template <class Plan, class Visit>
void members(Plan& plan, Visit&& visit) {
  visit("sweep", plan.sweep);
  visit("tasks", plan.tasks);
  visit("plannings", plan.plannings);
  visit("suite", plan.suite);
  visit("options", plan.options);
  visit("binary_hash", plan.binary_hash);
  visit("folder", plan.folder);
  visit("arguments", plan.arguments);
  visit("seconds", plan.seconds);
}

/// None if the program was killed with its machine, or never ran.
std::optional<int> exit_code_of(const std::filesystem::path& folder, std::size_t task) {
  const auto text = read_file(exit_file(folder, task).string());
  if (!text) return std::nullopt;
  return parse_number<int>(text->substr(0, text->find('\n')));
}

/// Whether a scheduler or a person ended it: to go on with it is no trial of what failed.
bool was_stopped(int code) {
  for (const int signal_number : {SIGINT, SIGTERM, SIGUSR1}) {
    if (code == kSignalExitBase + signal_number) return true;
  }
  return false;
}

}  // namespace

Expected<TaskPlan, std::string> read_task_plan(const std::filesystem::path& folder) {
  const std::string file = plan_file(folder);
  const auto text = read_file(file);
  if (!text) return Unexpected{text.error().message()};
  const auto json = nlohmann::json::parse(*text, nullptr, false);
  TaskPlan plan;
  try {
    members(plan, [&json](const char* name, auto& value) { json.at(name).get_to(value); });
  } catch (const nlohmann::json::exception&) {
    return Unexpected{file + ": not a plan of tasks, expected what `sipplab bench --plan-tasks` wrote"};
  }
  if (plan.tasks == 0) return Unexpected{file + ": no tasks, expected at least one"};
  return plan;
}

std::optional<std::string> write_task_plan(const std::filesystem::path& folder, const TaskPlan& plan) {
  nlohmann::ordered_json json;
  members(plan, [&json](const char* name, const auto& value) { json[name] = value; });
  if (const auto failed = write_file(plan_file(folder), db::json_text(json))) return failed->message();
  return std::nullopt;
}

db::Result<std::vector<double>> expected_seconds(const ExpandedSweep& sweep, db::Database* history) {
  std::vector<db::CaseTime> known;
  if (history != nullptr) known = SIPPLAB_TRY(db::case_times(*history));
  std::vector<double> seconds;
  std::vector<bool> is_known;
  double guessed_s = 0;
  double measured_s = 0;
  for (const NamedCase& named : sweep.cases) {
    const double guess_s = expected_seconds(named.parameters);
    const db::CaseInfo row = case_row(named.parameters);
    const auto found = std::find_if(known.begin(), known.end(),
                                    [&row](const db::CaseTime& time) { return time.parameters == row; });
    is_known.push_back(found != known.end());
    seconds.push_back(is_known.back() ? found->mean_planning_time_s : guess_s);
    if (!is_known.back()) continue;
    guessed_s += guess_s;
    measured_s += seconds.back();
  }
  if (guessed_s <= 0) return seconds;
  for (std::size_t i = 0; i < seconds.size(); ++i) {
    if (!is_known[i]) seconds[i] *= measured_s / guessed_s;
  }
  return seconds;
}

double seconds_of_all(const ExpandedSweep& sweep, std::int64_t repetitions,
                      const std::vector<double>& seconds) {
  double all_s = 0;
  for (std::size_t i = 0; i < sweep.cases.size(); ++i) {
    const std::size_t instances = sweep.sets[sweep.cases[i].parameters.set].instances.size();
    all_s += seconds[i] * static_cast<double>(repetitions) * static_cast<double>(instances);
  }
  return all_s;
}

std::size_t tasks_for(double seconds, double seconds_per_task) {
  // What the largest array of Slurm is without a word of its administrator.
  constexpr double kMostTasks = 1000;
  return static_cast<std::size_t>(std::clamp(std::ceil(seconds / seconds_per_task), 1.0, kMostTasks));
}

std::vector<std::string> arguments_without(const std::vector<std::string>& arguments,
                                           const std::set<std::string>& options) {
  std::vector<std::string> kept;
  for (std::size_t i = 0; i < arguments.size(); ++i) {
    const std::size_t equals = arguments[i].find('=');
    if (!options.contains(arguments[i].substr(0, equals))) {
      kept.push_back(arguments[i]);
    } else if (equals == std::string::npos) {
      ++i;
    }
  }
  return kept;
}

TaskStates states_of(const std::filesystem::path& folder, std::size_t tasks) {
  TaskStates states;
  for (std::size_t task = 1; task <= tasks; ++task) {
    const auto code = exit_code_of(folder, task);
    const bool ended_well = code && *code == 0;
    std::error_code ignored;
    if (ended_well && std::filesystem::exists(task_database(folder, task), ignored)) {
      states.done.push_back(task);
    } else if (!code || ended_well || was_stopped(*code)) {
      states.missing.push_back(task);
    } else {
      states.failed.emplace_back(task, *code);
    }
  }
  return states;
}

std::string ranges(const std::vector<std::size_t>& numbers) {
  std::string text;
  for (std::size_t i = 0; i < numbers.size();) {
    std::size_t last = i;
    while (last + 1 < numbers.size() && numbers[last + 1] == numbers[last] + 1) ++last;
    text += fmt::format("{}{}", text.empty() ? "" : ",", numbers[i]);
    if (last > i) text += fmt::format("-{}", numbers[last]);
    i = last + 1;
  }
  return text;
}

}  // namespace sipplab::bench
