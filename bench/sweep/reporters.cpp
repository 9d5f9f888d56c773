#include "bench/sweep/reporters.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <nlohmann/json.hpp>
#include <optional>

#include "db/aligned.hpp"
#include "db/json_text.hpp"

namespace sipplab::bench {
namespace {

constexpr double kMillisecondsPerSecond = 1e3;

std::string number(std::optional<double> value, int digits) {
  return value ? fmt::format("{:.{}f}", *value, digits) : "-";
}

/// A column that describes the case; shown only if it tells cases apart, the
/// first two always.
struct Parameter {
  const char* title;
  std::string (*value)(const SweepCase& parameters);
};

constexpr std::size_t kAlwaysShown = 2;
const Parameter kParameters[] = {
    {"environment", [](const SweepCase& c) { return c.map_spec == "files" ? c.environment : c.map_spec; }},
    {"reschedule", [](const SweepCase& c) { return std::string(name(c.options.rescheduling)); }},
    {"order", [](const SweepCase& c) { return std::string(name(c.options.order)); }},
    {"planner", [](const SweepCase& c) { return planner_label(c); }},
    {"seed", [](const SweepCase& c) { return std::to_string(c.options.seed); }},
};

std::vector<Parameter> shown_parameters(const std::vector<SweepEntry>& entries) {
  std::vector<Parameter> shown;
  for (const Parameter& parameter : kParameters) {
    const std::string first = parameter.value(entries.front().parameters);
    const bool varies = std::any_of(entries.begin(), entries.end(), [&](const SweepEntry& entry) {
      return parameter.value(entry.parameters) != first;
    });
    if (varies || shown.size() < kAlwaysShown) shown.push_back(parameter);
  }
  return shown;
}

nlohmann::ordered_json number_or_null(std::optional<double> value) {
  return value ? nlohmann::ordered_json(*value) : nlohmann::ordered_json(nullptr);
}

}  // namespace

bool RecordingReporter::ReportContext(const Context& context) {
  if (!sweep_.begin()) return false;
  return shown_ == nullptr || shown_->ReportContext(context);
}

void RecordingReporter::ReportRuns(const std::vector<Run>& report) {
  sweep_.finish_case(report.front().run_name.function_name);
  if (shown_ == nullptr) return;
  sweep_.progress().clear();
  shown_->ReportRuns(report);
}

void RecordingReporter::Finalize() {
  if (shown_ != nullptr) shown_->Finalize();
}

std::string result_table(const std::vector<SweepEntry>& entries) {
  if (entries.empty()) return "";
  const std::vector<Parameter> parameters = shown_parameters(entries);
  std::vector<std::string> heading;
  for (const Parameter& parameter : parameters) heading.emplace_back(parameter.title);
  for (const char* title :
       {"robots", "ssi", "solved", "limited", "success", "solved in [ms]", "makespan", "flowtime", "tries"}) {
    heading.emplace_back(title);
  }
  std::vector<std::vector<std::string>> rows;
  for (const SweepEntry& entry : entries) {
    if (!entry.finished) continue;
    const CaseOutcome& outcome = entry.outcome;
    std::vector<std::string> row;
    for (const Parameter& parameter : parameters) row.push_back(parameter.value(entry.parameters));
    row.push_back(std::to_string(entry.parameters.robots));
    row.push_back(format_ssi(entry.parameters.options.ssi_s));
    row.push_back(fmt::format("{}/{}", outcome.solved(), outcome.results()));
    row.push_back(std::to_string(outcome.limited()));
    row.push_back(number(outcome.success_rate(), 2));
    std::optional<double> solved_in = outcome.mean_solved_planning_s();
    if (solved_in) *solved_in *= kMillisecondsPerSecond;
    row.push_back(number(solved_in, 2));
    row.push_back(number(outcome.mean_makespan_s(), 2));
    row.push_back(number(outcome.mean_flowtime_s(), 2));
    row.push_back(number(outcome.mean_tries(), 2));
    rows.push_back(std::move(row));
  }
  std::vector<bool> to_the_right(heading.size(), true);
  std::fill_n(to_the_right.begin(), parameters.size(), false);
  return db::align(heading, rows, to_the_right);
}

std::string result_json(const std::vector<SweepEntry>& entries, const std::string& suite,
                        const std::string& run, const std::string& database, bool finished) {
  nlohmann::ordered_json cases = nlohmann::ordered_json::array();
  for (const SweepEntry& entry : entries) {
    if (!entry.finished) continue;
    const CaseOutcome& outcome = entry.outcome;
    nlohmann::ordered_json json;
    json["name"] = entry.name;
    for (const Parameter& parameter : kParameters) json[parameter.title] = parameter.value(entry.parameters);
    json["robots"] = entry.parameters.robots;
    json["ssi"] = format_ssi(entry.parameters.options.ssi_s);
    json["results"] = outcome.results();
    json["solved"] = outcome.solved();
    json["limited"] = outcome.limited();
    json["invalid"] = outcome.invalid();
    json["success_rate"] = outcome.success_rate();
    json["mean_planning_seconds"] = outcome.mean_planning_s();
    json["mean_solved_planning_seconds"] = number_or_null(outcome.mean_solved_planning_s());
    json["mean_makespan"] = number_or_null(outcome.mean_makespan_s());
    json["mean_flowtime"] = number_or_null(outcome.mean_flowtime_s());
    json["mean_tries"] = outcome.mean_tries();
    json["mean_expansions"] = outcome.mean_expansions();
    cases.push_back(std::move(json));
  }
  nlohmann::ordered_json json;
  json["suite"] = suite;
  json["run"] = run;
  json["database"] = database;
  json["status"] = finished ? "finished" : "aborted";
  json["cases"] = std::move(cases);
  return db::json_text(json);
}

}  // namespace sipplab::bench
