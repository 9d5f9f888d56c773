// Runs and run reports as text: rounded for a person, exact for programs.
#include <fmt/core.h>

#include <cmath>
#include <nlohmann/json.hpp>

#include "db/aligned.hpp"
#include "db/columns.hpp"
#include "db/json_text.hpp"
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

std::string commit_text(const RunSummary& run) {
  if (!run.commit_hash) return "-";
  return brief(*run.commit_hash) + (run.dirty ? "+" : "");
}

std::string state_text(const RunSummary& run) {
  if (run.excluded_reason) return "excluded";
  return run.outcome.empty() ? run.status : run.outcome;
}

Table rounded_runs(const std::vector<RunSummary>& runs) {
  Table table{{"run", "started (UTC)", "kind", "suite", "status", "commit", "branch", "host", "cases",
               "results", "solved"},
              {}};
  for (const RunSummary& run : runs) {
    table.rows.push_back({brief(run.uuid), to_seconds(run.started_utc), run.kind, run.suite, state_text(run),
                          commit_text(run), run.branch, run.host, run.cases, run.results, run.solved});
  }
  return table;
}

/// Rounded numbers are text here, and are aligned to the right like numbers.
std::string format_cells(const std::vector<CellSummary>& cells) {
  struct Column {
    const char* heading;
    bool number;
  };
  constexpr Column kColumns[] = {
      {"environment", false}, {"planner", false}, {"order", false},  {"reschedule", false}, {"ssi", true},
      {"robots", true},       {"solved", true},   {"success", true}, {"median time", true}, {"PAR-2", true},
      {"makespan", true},     {"flowtime", true}, {"tries", true},   {"expansions", true}};
  std::vector<std::string> heading;
  std::vector<bool> to_the_right;
  for (const Column& column : kColumns) {
    heading.emplace_back(column.heading);
    to_the_right.push_back(column.number);
  }
  std::vector<std::vector<std::string>> rows;
  for (const CellSummary& cell : cells) {
    const CaseInfo& of = cell.parameters;
    rows.push_back({escaped(of.environment), escaped(of.planner), escaped(of.text("initial_order")),
                    escaped(of.text("reschedule")), ssi_text(of.real("ssi_s")), std::to_string(of.robots),
                    fmt::format("{}/{}", cell.solved, cell.results), rounded(cell.success_rate, 2),
                    duration(cell.median_time_to_solve_s), duration(cell.par2_time_s),
                    rounded(cell.mean_makespan_s, 2), rounded(cell.mean_flowtime_s, 2),
                    rounded(cell.mean_tries, 1), rounded(cell.mean_expansions, 0)});
  }
  return align(heading, rows, to_the_right) +
         "median time: an unsolved result counts as the longest; PAR-2: mean time, an unsolved one as twice "
         "the "
         "limit\n"
         "makespan, flowtime: means over what this run solved; `sipplab compare` compares runs where both "
         "solve\n";
}

/// A single wide row reads better as a line for each column that has a value.
Table upright(const Table& table) {
  if (table.rows.size() != 1) return table;
  Table lines{{"column", "value"}, {}};
  for (std::size_t i = 0; i < table.columns.size(); ++i) {
    const Value& value = table.rows.front()[i];
    if (!std::holds_alternative<Null>(value)) lines.rows.push_back({table.columns[i], value});
  }
  return lines;
}

std::string describe(const RunSummary& run) {
  std::string text = fmt::format("run       {}\n", run.uuid);
  text += fmt::format("{:<9} {}, {}\n", run.kind == "sweep" ? "suite" : run.kind, run.suite,
                      run.outcome.empty() ? run.status : run.outcome);
  text += fmt::format("started   {} UTC", to_seconds(run.started_utc));
  text += run.ended_utc ? fmt::format(", ended {} UTC\n", to_seconds(*run.ended_utc)) : "\n";
  if (run.commit_hash) {
    text += fmt::format("commit    {} {}{}{}\n", *run.commit_hash, escaped(run.commit_subject.value_or("")),
                        run.branch.empty() ? "" : " (" + escaped(run.branch) + ")",
                        run.dirty ? ", with uncommitted changes" : "");
  }
  text += fmt::format("machine   {}, {}\n", escaped(run.host), escaped(run.cpu_model));
  text += fmt::format("build     {}, {}\n", run.compiler, run.build_type);
  if (!run.command_line.empty()) text += fmt::format("command   {}\n", escaped(run.command_line));
  if (run.kind == "sweep") {
    text += fmt::format("results   {} in {} cases, {} solved, {} invalid\n", run.results, run.cases,
                        run.solved, run.invalid);
  }
  if (run.excluded_reason) text += fmt::format("excluded  {}\n", escaped(*run.excluded_reason));
  return text;
}

}  // namespace

std::string format_runs(const std::vector<RunSummary>& runs, OutputFormat format) {
  if (format != OutputFormat::kTable) return db::format(table_of(runs), format);
  if (runs.empty()) return "no runs\n";
  return format_aligned(rounded_runs(runs));
}

std::string format_run_report(const RunReport& report, OutputFormat format) {
  const bool sweep = report.run.kind == "sweep";
  switch (format) {
    case OutputFormat::kTable: {
      const std::string cells = report.cells.empty() ? "no finished case\n" : format_cells(report.cells);
      return describe(report.run) + '\n' + (sweep ? cells : format_aligned(upright(report.details)));
    }
    case OutputFormat::kCsv:
      return format_csv(sweep ? table_of(report.cells) : report.details);
    case OutputFormat::kJson: {
      Json document;
      document["run"] = Json::parse(format_json(table_of(std::vector{report.run}))).front();
      document[sweep ? "cells" : "details"] =
          Json::parse(format_json(sweep ? table_of(report.cells) : report.details));
      return json_text(document);
    }
  }
  return {};
}

}  // namespace sipplab::db
