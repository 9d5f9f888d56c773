// Fuzzing in the history: what each target did in a campaign, and how much of the planner
// it reached.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "db/database.hpp"
#include "db/records.hpp"
#include "db/sqlite/error.hpp"
#include "db/table.hpp"

namespace sipplab::db {

/// The state of a fuzzing run at one moment.
struct FuzzSnapshot {
  std::int64_t executions = 0;
  std::int64_t elapsed_ns = 0;
  std::int64_t edges = 0;
  std::int64_t features = 0;
  std::int64_t corpus_files = 0;
  std::int64_t memory_bytes = 0;
};

/// How often something happened (kind "event") or was checked ("claim").
struct FuzzCount {
  std::string kind;
  std::string name;
  std::int64_t count = 0;
};

/// One run of one target. Names and units are those of the SQL columns.
struct FuzzRun {
  std::string uuid;
  std::string campaign;  ///< shared by the targets of one command
  std::string target;
  std::string mode;  ///< "smoke", "for", "nightly"
  std::string started_utc;
  std::int64_t wall_time_ns = 0;
  std::int64_t cpu_time_ns = 0;  ///< of all its processes
  std::string status;            ///< "clean", "findings", "broken": it did not run as it should
  std::uint64_t seed = 0;
  std::optional<std::int64_t> budget_executions;
  std::optional<double> budget_s;
  std::int64_t workers = 1;
  std::string target_hash;  ///< of the target's program
  std::int64_t executions = 0;
  std::int64_t edges = 0;
  std::int64_t features = 0;
  std::int64_t corpus_files = 0;
  std::int64_t corpus_bytes = 0;
  std::int64_t peak_memory_bytes = 0;
  std::int64_t slowest_input_s = 0;
  std::int64_t crashes = 0;
  std::int64_t timeouts = 0;
  std::int64_t ooms = 0;
  std::int64_t leaks = 0;
  std::vector<FuzzSnapshot> snapshots;
  std::vector<FuzzCount> counts;
};

/// Writes a run with its snapshots and counts in one transaction; gives its id. The build of the origin is
/// that of the program that records; targets are known by their own hash.
Result<std::int64_t> record_fuzz_run(Database& database, const RunOrigin& origin, const FuzzRun& run);

/// Whether this very program of a target has run for a time and found nothing.
Result<bool> is_fuzzed_clean(Database& database, const std::string& target, const std::string& target_hash);

struct FileCoverage {
  std::string file;  ///< from the root of the source tree
  std::int64_t lines = 0;
  std::int64_t covered_lines = 0;
};
Result<Done> record_fuzz_coverage(Database& database, const std::string& campaign,
                                  const std::vector<FileCoverage>& files);

/// The campaign of the newest run, excluded ones left out; an error if there is none.
Result<std::string> latest_fuzz_campaign(Database& database);

struct FuzzRunFilter {
  std::optional<std::string> target;
  std::optional<std::string> campaign;
  std::size_t limit = 0;  ///< newest runs; 0 for all
};
/// id, started_utc, target, mode, status, executions, executions_per_s, executions_per_cpu_s,
/// edges, features, corpus_files, crashes, timeouts, ooms, leaks, wall_time_s, valid_share; newest first,
/// excluded runs left out. valid_share: of the inputs, those that are instances with two robots or more.
Result<Table> list_fuzz_runs(Database& database, const FuzzRunFilter& filter);

/// room, lines, covered_lines, share; by room, and one row for all of planner/.
Result<Table> list_fuzz_coverage(Database& database, const std::string& campaign);

}  // namespace sipplab::db
