// What `sipplab runs`, `show` and `sql` ask of a history, and their answers as text.
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "db/database.hpp"
#include "db/records.hpp"
#include "db/sqlite/error.hpp"
#include "db/table.hpp"

namespace sipplab::db {

/// One row of v_runs.
struct RunSummary {
  std::string uuid;
  std::string suite;
  std::string status;  ///< "running", "finished", "aborted"
  std::string started_utc;
  std::optional<std::string> ended_utc;
  std::optional<std::string> commit_hash;
  std::optional<std::string> commit_subject;
  std::string branch;
  bool dirty = false;
  std::string host;
  std::string cpu_model;
  std::string compiler;  ///< with its version
  std::string build_type;
  std::string command_line;
  std::int64_t cases = 0;
  std::int64_t results = 0;
  std::int64_t solved = 0;
  std::int64_t invalid = 0;
  std::optional<std::string> excluded_reason;
  std::string kind;     ///< "sweep", "report", "property", "fuzz", "gate"
  std::string outcome;  ///< of a kind that has no cases: "passed", "clean", "equivalent", ...

  template <class Self, class Visit>
  static void columns(Self&& self, Visit&& visit) {
    visit("run", self.uuid);
    visit("suite", self.suite);
    visit("status", self.status);
    visit("started_utc", self.started_utc);
    visit("ended_utc", self.ended_utc);
    visit("commit_hash", self.commit_hash);
    visit("commit_subject", self.commit_subject);
    visit("branch", self.branch);
    visit("dirty", self.dirty);
    visit("host", self.host);
    visit("cpu_model", self.cpu_model);
    visit("compiler", self.compiler);
    visit("build_type", self.build_type);
    visit("command_line", self.command_line);
    visit("cases", self.cases);
    visit("results", self.results);
    visit("solved", self.solved);
    visit("invalid", self.invalid);
    visit("excluded_reason", self.excluded_reason);
    visit("kind", self.kind);
    visit("outcome", self.outcome);
  }
};

/// One row of v_run_cells: all instances of one case in one run. Rates are 0..1;
/// makespan and flowtime are over solved instances, and absent when there is none.
struct CellSummary {
  CaseInfo parameters;
  std::int64_t case_id = 0;
  std::int64_t results = 0;
  std::int64_t solved = 0;
  std::int64_t limited = 0;
  std::int64_t invalid = 0;
  std::optional<double> success_rate;
  std::optional<double> mean_planning_time_s;  ///< over all results, limits included
  std::optional<double> median_planning_time_s;
  std::optional<double> mean_makespan_s;
  std::optional<double> median_makespan_s;
  std::optional<double> mean_flowtime_s;
  std::optional<double> median_flowtime_s;
  std::optional<double> mean_tries;
  std::optional<double> mean_expansions;
  std::optional<double> median_solved_time_s;    ///< over solved results
  std::optional<double> median_time_to_solve_s;  ///< unsolved ones as the longest; absent if in the middle
  std::optional<double> par2_time_s;

  template <class Self, class Visit>
  static void columns(Self&& self, Visit&& visit) {
    const CaseInfo& of = self.parameters;
    visit("environment", of.environment);
    visit("robots", of.robots);
    for (const char* column : {"ssi_s", "reschedule", "initial_order"}) visit(column, of.option(column));
    visit("planner", of.planner);
    for (const char* column : {"any_angle", "connectedness"}) visit(column, of.option(column));
    measures(self, visit);
  }

  /// Those that are not of the case.
  template <class Self, class Visit>
  static void measures(Self&& self, Visit&& visit) {
    visit("results", self.results);
    visit("solved", self.solved);
    visit("limited", self.limited);
    visit("invalid", self.invalid);
    visit("success_rate", self.success_rate);
    visit("mean_planning_time_s", self.mean_planning_time_s);
    visit("median_planning_time_s", self.median_planning_time_s);
    visit("mean_makespan_s", self.mean_makespan_s);
    visit("median_makespan_s", self.median_makespan_s);
    visit("mean_flowtime_s", self.mean_flowtime_s);
    visit("median_flowtime_s", self.median_flowtime_s);
    visit("mean_tries", self.mean_tries);
    visit("mean_expansions", self.mean_expansions);
    visit("median_solved_time_s", self.median_solved_time_s);
    visit("median_time_to_solve_s", self.median_time_to_solve_s);
    visit("par2_time_s", self.par2_time_s);
  }
};

struct RunReport {
  RunSummary run;
  std::vector<CellSummary> cells;  ///< by environment, re-scheduling, SSI, robots
  Table details;                   ///< of other kinds than sweeps: what their view says of the run
};

struct RunFilter {
  std::optional<std::string> kind;  ///< none: sweeps and reports; "all": all kinds
  std::optional<std::string> suite;
  bool include_excluded = false;
  std::size_t limit = 20;  ///< newest runs; 0 for all
};

/// Runs, newest first.
Result<std::vector<RunSummary>> list_runs(Database& database, const RunFilter& filter = {});

/// The UUID of the run that `text` names: "latest" (newest sweep or report that is not excluded), a
/// UUID, or a beginning of one, at least four digits long, that fits one sweep or report only, else one run.
Result<std::string> resolve_run(Database& database, std::string_view text);

/// The newest run of the same kind and suite that began before a run, excluded ones left out.
/// REQUIRES: the UUID of a run.
Result<std::optional<std::string>> run_before(Database& database, const std::string& uuid);

/// Everything that `sipplab show RUN` prints.
Result<RunReport> show_run(Database& database, std::string_view run);

/// Leaves a run out of comparisons and trends, with a reason; nothing is deleted.
Result<Done> exclude_run(Database& database, std::string_view run, const std::string& reason);
/// Takes an exclusion back.
Result<Done> include_run(Database& database, std::string_view run);

/// Runs one statement that only reads. The file is opened read-only; writing,
/// ATTACH, PRAGMAs that set anything, and a second statement are refused with one line.
/// The aggregates of statistics/sqlite_functions.hpp are there.
///
/// Named parameters: `parameters` gives name (without colon) and value, a number if it
/// reads as one. Unless it does, :run is the newest run that is not excluded, and :other the one
/// of the same suite before :run.
Result<Table> run_sql(const std::filesystem::path& path, const std::string& sql,
                      const std::vector<std::pair<std::string, std::string>>& parameters = {});

/// Text for a person (rounded), or exact values as CSV or JSON. JSON of a run
/// report is one object: {"run": {...}, "cells": [{...}, ...]}, for other kinds than sweeps with
/// "details" instead of "cells".
std::string format_runs(const std::vector<RunSummary>& runs, OutputFormat format);
std::string format_run_report(const RunReport& report, OutputFormat format);

}  // namespace sipplab::db
