// Property runs in the history: how they get in, and what `sipplab property` asks.
#pragma once

#include <cstddef>
#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "db/database.hpp"
#include "db/error.hpp"
#include "db/records.hpp"
#include "db/table.hpp"

namespace sipplab::db {

/// One check of one property. Names and units are those of the SQL columns.
struct PropertyRun {
  std::string uuid;
  std::string started_utc;
  std::string room;
  std::string title;
  std::uint64_t seed = 0;
  std::int64_t max_success = 0;
  std::string status;  ///< "passed", "failed", "gave_up", "crashed"
  std::int64_t cases = 0;
  std::int64_t discards = 0;
  std::int64_t shrinks = 0;
  std::int64_t shrink_tries = 0;
  std::int64_t wall_time_ns = 0;
  std::map<std::string, std::int64_t> classes;  ///< class to cases in it

  // Of a failure; empty where there is none.
  std::string message;
  std::string reproduce;
  std::string counterexample;
  std::string plan_case;
  std::optional<std::int64_t> case_robots;
  std::optional<std::int64_t> case_cells;
};

/// What a log of property runs has in common.
struct PropertyOrigin {
  std::optional<CommitInfo> commit;  ///< none outside a checkout
  std::string branch;
  MachineInfo machine;
  BuildInfo build;     ///< of the program that records; the properties come from its build folder
  std::string mutant;  ///< name of the bug that was planted in the planner; empty for none
};

struct PropertyRecorded {
  std::size_t added = 0;
  std::size_t known = 0;  ///< were in the file already, by their UUID
};

/// Writes all runs in one transaction: all or nothing. Runs that the file holds already
/// stay as they are, but for one that seemed to have crashed and ended after all.
Result<PropertyRecorded> record_property_runs(Database& database, const PropertyOrigin& origin,
                                              const std::vector<PropertyRun>& runs);

struct PropertyFilter {
  std::optional<std::string> room;
  bool failed = false;     ///< only those that failed or crashed
  bool every_run = false;  ///< else the newest of each property, planted bugs left out
  std::size_t limit = 0;   ///< rows; 0 for all
};

/// id, started_utc, room, title, mutant, status, cases, discards, shrinks, wall_time_s,
/// seed, case_robots, case_cells; by room and title, or newest first with `every_run`.
Result<Table> list_property_runs(Database& database, const PropertyFilter& filter);

/// A run as it is stored, and the columns of v_property_runs that say where it is from.
struct PropertyReport {
  std::int64_t id = 0;
  PropertyRun run;
  std::string mutant;
  std::optional<std::string> commit_hash;
  std::string branch;
  bool dirty = false;
  std::string host;
  std::string compiler;  ///< with its version
  std::string build_type;
  std::string sanitizers;
};

/// The run with that id; an error where there is none.
Result<PropertyReport> show_property_run(Database& database, std::int64_t id);

/// The newest run that failed, planted bugs left out; an error where there is none.
Result<std::int64_t> latest_property_failure(Database& database);

/// Text for a person; for kJson one object, for kCsv "key,value" lines.
std::string format_property_report(const PropertyReport& report, OutputFormat format);

}  // namespace sipplab::db
