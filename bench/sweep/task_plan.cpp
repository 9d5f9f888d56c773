#include "bench/sweep/task_plan.hpp"

#include <algorithm>
#include <nlohmann/json.hpp>
#include <optional>

#include "bench/sweep/shard.hpp"
#include "db/json_text.hpp"
#include "db/summaries.hpp"
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

}  // namespace sipplab::bench
