// Runs and run reports as text: rounded for a person, exact for programs.
#include <fmt/core.h>

#include <cmath>
#include <nlohmann/json.hpp>

#include "db/aligned.hpp"
#include "db/queries.hpp"

namespace sipplab::db {
namespace {

using Json = nlohmann::ordered_json;

// Digits of a hash or UUID that tell rows apart at a glance and can be typed.
constexpr std::size_t kShortLength = 8;

std::string brief(const std::string& identity) { return identity.substr(0, kShortLength); }

/// "2026-01-31 12:00:00" of "2026-01-31T12:00:00.123Z".
std::string to_seconds(const std::string& utc) {
  constexpr std::size_t kDate = 10;
  constexpr std::size_t kSeconds = 19;
  if (utc.size() < kSeconds) return utc;
  return utc.substr(0, kDate) + ' ' + utc.substr(kDate + 1, kSeconds - kDate - 1);
}

std::string rounded(const std::optional<double>& value, int digits) {
  return value ? fmt::format("{:.{}f}", *value, digits) : "-";
}

/// Wall-clock time in the unit in which it reads best.
std::string duration(const std::optional<double>& seconds) {
  if (!seconds) return "-";
  constexpr double kMillisecond = 1e-3;
  constexpr double kMicrosecond = 1e-6;
  if (*seconds >= 1) return fmt::format("{:.2f} s", *seconds);
  if (*seconds >= kMillisecond) return fmt::format("{:.2f} ms", *seconds / kMillisecond);
  return fmt::format("{:.2f} us", *seconds / kMicrosecond);
}

std::string ssi_text(double ssi_s) { return std::isinf(ssi_s) ? "inf" : fmt::format("{}", ssi_s); }

Value optional_value(const std::optional<double>& value) { return value ? Value{*value} : Value{Null{}}; }
Value optional_value(const std::optional<std::string>& value) {
  return value ? Value{*value} : Value{Null{}};
}
Value flag(bool value) { return std::int64_t{value ? 1 : 0}; }

Table exact(const std::vector<RunSummary>& runs) {
  Table table{{"run", "suite", "status", "started_utc", "ended_utc", "commit_hash", "commit_subject",
               "branch", "dirty", "host", "cpu_model", "compiler", "build_type", "command_line", "cases",
               "results", "solved", "invalid", "excluded_reason"},
              {}};
  for (const RunSummary& run : runs) {
    table.rows.push_back({run.uuid, run.suite, run.status, run.started_utc, optional_value(run.ended_utc),
                          optional_value(run.commit_hash), optional_value(run.commit_subject), run.branch,
                          flag(run.dirty), run.host, run.cpu_model, run.compiler, run.build_type,
                          run.command_line, run.cases, run.results, run.solved, run.invalid,
                          optional_value(run.excluded_reason)});
  }
  return table;
}

Table exact(const std::vector<CellSummary>& cells) {
  Table table{{"environment",
               "robots",
               "ssi_s",
               "reschedule",
               "initial_order",
               "planner",
               "any_angle",
               "connectedness",
               "results",
               "solved",
               "limited",
               "invalid",
               "success_rate",
               "mean_planning_time_s",
               "median_planning_time_s",
               "mean_makespan_s",
               "median_makespan_s",
               "mean_flowtime_s",
               "median_flowtime_s",
               "mean_tries",
               "mean_expansions"},
              {}};
  for (const CellSummary& cell : cells) {
    table.rows.push_back({cell.environment,
                          cell.robots,
                          cell.ssi_s,
                          cell.reschedule,
                          cell.order,
                          cell.planner,
                          flag(cell.any_angle),
                          cell.connectedness,
                          cell.results,
                          cell.solved,
                          cell.limited,
                          cell.invalid,
                          optional_value(cell.success_rate),
                          optional_value(cell.mean_planning_time_s),
                          optional_value(cell.median_planning_time_s),
                          optional_value(cell.mean_makespan_s),
                          optional_value(cell.median_makespan_s),
                          optional_value(cell.mean_flowtime_s),
                          optional_value(cell.median_flowtime_s),
                          optional_value(cell.mean_tries),
                          optional_value(cell.mean_expansions)});
  }
  return table;
}

std::string commit_text(const RunSummary& run) {
  if (!run.commit_hash) return "-";
  return brief(*run.commit_hash) + (run.dirty ? "+" : "");
}

std::string state_text(const RunSummary& run) { return run.excluded_reason ? "excluded" : run.status; }

Table rounded_runs(const std::vector<RunSummary>& runs) {
  Table table{
      {"run", "started (UTC)", "suite", "status", "commit", "branch", "host", "cases", "results", "solved"},
      {}};
  for (const RunSummary& run : runs) {
    table.rows.push_back({brief(run.uuid), to_seconds(run.started_utc), run.suite, state_text(run),
                          commit_text(run), run.branch, run.host, run.cases, run.results, run.solved});
  }
  return table;
}

/// Rounded numbers are text by now, and stand to the right all the same.
std::string format_cells(const std::vector<CellSummary>& cells) {
  struct Column {
    const char* heading;
    bool number;
  };
  constexpr Column kColumns[] = {{"environment", false}, {"planner", false},    {"neighbours", true},
                                 {"order", false},       {"reschedule", false}, {"ssi", true},
                                 {"robots", true},       {"solved", true},      {"success", true},
                                 {"mean time", true},    {"median time", true}, {"makespan", true},
                                 {"flowtime", true},     {"tries", true},       {"expansions", true}};
  std::vector<std::string> heading;
  std::vector<bool> to_the_right;
  for (const Column& column : kColumns) {
    heading.emplace_back(column.heading);
    to_the_right.push_back(column.number);
  }
  std::vector<std::vector<std::string>> rows;
  for (const CellSummary& cell : cells) {
    rows.push_back({escaped(cell.environment), escaped(cell.planner),
                    fmt::format("{}", 1 << cell.connectedness), escaped(cell.order), escaped(cell.reschedule),
                    ssi_text(cell.ssi_s), fmt::format("{}", cell.robots),
                    fmt::format("{}/{}", cell.solved, cell.results), rounded(cell.success_rate, 2),
                    duration(cell.mean_planning_time_s), duration(cell.median_planning_time_s),
                    rounded(cell.mean_makespan_s, 2), rounded(cell.mean_flowtime_s, 2),
                    rounded(cell.mean_tries, 1), rounded(cell.mean_expansions, 0)});
  }
  return align(heading, rows, to_the_right);
}

std::string describe(const RunSummary& run) {
  std::string text = fmt::format("run       {}\n", run.uuid);
  text += fmt::format("suite     {}, {}\n", run.suite, run.status);
  text += fmt::format("started   {} UTC", to_seconds(run.started_utc));
  text += run.ended_utc ? fmt::format(", ended {} UTC\n", to_seconds(*run.ended_utc)) : "\n";
  if (run.commit_hash) {
    text += fmt::format("commit    {} {}{}{}\n", *run.commit_hash, run.commit_subject.value_or(""),
                        run.branch.empty() ? "" : " (" + run.branch + ")",
                        run.dirty ? ", with uncommitted changes" : "");
  }
  text += fmt::format("machine   {}, {}\n", run.host, run.cpu_model);
  text += fmt::format("build     {}, {}\n", run.compiler, run.build_type);
  text += fmt::format("command   {}\n", run.command_line);
  text += fmt::format("results   {} in {} cases, {} solved, {} invalid\n", run.results, run.cases, run.solved,
                      run.invalid);
  if (run.excluded_reason) text += fmt::format("excluded  {}\n", *run.excluded_reason);
  return text;
}

}  // namespace

std::string format_runs(const std::vector<RunSummary>& runs, OutputFormat format) {
  if (format != OutputFormat::kTable) return db::format(exact(runs), format);
  if (runs.empty()) return "no runs\n";
  return format_aligned(rounded_runs(runs));
}

std::string format_run_report(const RunReport& report, OutputFormat format) {
  switch (format) {
    case OutputFormat::kTable:
      return describe(report.run) + '\n' +
             (report.cells.empty() ? "no finished case\n" : format_cells(report.cells));
    case OutputFormat::kCsv:
      return format_csv(exact(report.cells));
    case OutputFormat::kJson: {
      Json document;
      document["run"] = Json::parse(format_json(exact(std::vector{report.run}))).front();
      document["cells"] = Json::parse(format_json(exact(report.cells)));
      return document.dump(2) + '\n';
    }
  }
  return {};
}

}  // namespace sipplab::db
