// Property runs in the history: how they get in, and what `sipplab property` asks.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "db/database.hpp"
#include "db/property_run.hpp"
#include "db/records.hpp"
#include "db/sqlite/error.hpp"
#include "db/table.hpp"

namespace sipplab::db {

struct PropertyRecorded {
  std::size_t added = 0;
  std::size_t known = 0;  ///< were in the file already, by their UUID
};

/// Writes all runs in one transaction: all or nothing. Runs that the file holds already
/// stay as they are, but for one that seemed to have crashed and ended after all. The build of the origin is
/// that of the program that records; the properties come from its build folder. `mutant` names the
/// bug that was planted in the planner; empty for none.
Result<PropertyRecorded> record_property_runs(Database& database, const RunOrigin& origin,
                                              const std::vector<PropertyRun>& runs,
                                              const std::string& mutant = "");

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

  /// Without those of the run.
  template <class Self, class Visit>
  static void columns(Self& self, Visit&& visit) {
    visit("id", self.id);
    visit("mutant", self.mutant);
    visit("commit_hash", self.commit_hash);
    visit("branch", self.branch);
    visit("dirty", self.dirty);
    visit("host", self.host);
    visit("compiler", self.compiler);
    visit("build_type", self.build_type);
    visit("sanitizers", self.sanitizers);
  }
};

/// The run with that id; an error if there is none.
Result<PropertyReport> show_property_run(Database& database, std::int64_t id);

/// The newest run that failed, planted bugs left out; an error if there is none.
Result<std::int64_t> latest_property_failure(Database& database);

/// Text for a person; for kJson one object, for kCsv "key,value" lines.
std::string format_property_report(const PropertyReport& report, OutputFormat format);

}  // namespace sipplab::db
