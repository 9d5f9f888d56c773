// The rows of the history, as plain values. Names and units are those of the SQL
// columns; schema.md explains each.
#pragma once

#include <cstdint>
#include <functional>
#include <limits>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "db/table.hpp"

namespace sipplab::db {

/// A count that sets no limit: larger than any count, so that comparisons need no
/// special case. Larger values are stored as this one.
inline constexpr std::uint64_t kNoCountLimit = INT64_MAX;
inline constexpr double kNoTimeLimit = std::numeric_limits<double>::infinity();

/// A commit of the source tree. History is ordered by `ancestor_count`: an ancestor
/// always has fewer, whenever its results were uploaded.
struct CommitInfo {
  std::string hash;           ///< full hexadecimal object name
  std::string committed_utc;  ///< "2026-01-31T12:00:00Z"
  std::string subject;
  std::string first_parent;  ///< hash; empty for a root commit
  /// `git rev-list --count HASH`, the commit itself included; 0 if it is not
  /// known (shallow clone).
  std::int64_t ancestor_count = 0;
  /// `git rev-list --count --first-parent HASH`; 0 if it is not known.
  std::int64_t first_parent_count = 0;
  std::vector<std::string> later_parents = {};  ///< hashes, of a merge: the parents after the first
};

/// A host in one condition: another kernel or more memory makes another machine.
struct MachineInfo {
  std::string host;
  std::string cpu_model;
  std::int64_t cores = 0;         ///< logical processors
  std::int64_t memory_bytes = 0;  ///< physical memory
  std::string kernel;             ///< system name and release, as uname prints them
};

/// Identifies a machine: 16 hexadecimal digits made of all its fields.
std::string fingerprint(const MachineInfo& machine);

struct BuildInfo {
  std::string compiler;  ///< "gcc", "clang"
  std::string compiler_version;
  std::string flags;
  std::string build_type;   ///< "Release", ...
  bool assertions = false;  ///< invariants are checked at run time
  std::string sanitizers;   ///< "address,undefined"; empty for none
  std::string binary_hash;  ///< of the program that ran, hexadecimal
  bool dirty = false;       ///< built from a tree with uncommitted changes
};

/// Where something comes from that is recorded.
struct RunOrigin {
  std::optional<CommitInfo> commit;  ///< none outside a checkout
  std::string branch;                ///< as checked out; empty if there is none
  MachineInfo machine;
  BuildInfo build;
};

/// Under what one process writes to a sweep.
struct AttemptInfo {
  std::string scheduler;           ///< "slurm", "sge", "pbs", "htcondor", "parallel"; empty for none
  std::string job;                 ///< as the scheduler calls it
  std::string task;                ///< of the job's array, as the scheduler counts
  std::int64_t restarts = 0;       ///< times that the scheduler started this task before
  std::optional<double> queued_s;  ///< since it was submitted
  double cores = 0;                ///< that the process may use, by affinity and cgroup; 0: not known
  std::optional<std::int64_t> memory_limit_bytes;  ///< of its cgroup; none: no limit
};

/// What an attempt has taken so far, children included.
struct AttemptUsage {
  std::int64_t cpu_time_ns = 0;
  std::int64_t peak_memory_bytes = 0;
};

/// One start of a sweep.
struct RunInfo : RunOrigin {
  std::string uuid;  ///< the same for all parts of a sweep; empty: a fresh one
  std::string suite;
  std::string shard;  ///< "2/8": the second of eight parts of the suite; empty for all of it
  std::optional<std::int64_t> planned;  ///< plannings of the whole sweep, all parts together
  AttemptInfo attempt;
  std::string command_line;
  /// What must agree, in addition to suite, build and machine, for a run to be resumed:
  /// a canonical text of the options that change results, such as
  /// "count=50 seed=1 repetitions=1 instances=generated".
  std::string options;
  std::uint64_t seed = 0;
  double time_limit_s = kNoTimeLimit;  ///< wall clock, per instance
};

/// The parameters of a benchmark case: all of them, so that two cases are the same
/// exactly when all fields are equal.
struct CaseInfo {
  std::string environment;   ///< "empty", "warehouse", "random", or a name for files
  std::string map_spec;      ///< "empty:32x32", "warehouse", "random:32x32:0.2", or a file
  std::string instance_set;  ///< where instances come from: "generated/seed:1", or a folder
  std::int64_t robots = 0;
  /// As tables show it: "sipplab weight:1.05" (what differs from the defaults), "cmd:NAME" (another program).
  std::string planner;
  double radius_cells = 0.5;     ///< 0: mixed, as each instance says
  double speed_cells_per_s = 1;  ///< 0: mixed, as each instance says
  /// Of the planner, by column: an integer (1 for yes), a finite real or a text. One that has no column in
  /// the schema is here only if it differs from its default.
  std::map<std::string, Value, std::less<>> options;

  /// NULL if there is no such column.
  const Value& option(std::string_view column) const {
    static const Value kNone = Null{};
    const auto found = options.find(column);
    return found == options.end() ? kNone : found->second;
  }
  /// REQUIRES of both: there is such a column, with a value of this kind.
  double real(std::string_view column) const { return std::get<double>(option(column)); }
  const std::string& text(std::string_view column) const { return std::get<std::string>(option(column)); }

  /// Those that are no option.
  template <class Self, class Visit>
  static void columns(Self& self, Visit&& visit) {
    visit("environment", self.environment);
    visit("map_spec", self.map_spec);
    visit("instance_set", self.instance_set);
    visit("robots", self.robots);
    visit("planner", self.planner);
    visit("radius_cells", self.radius_cells);
    visit("speed_cells_per_s", self.speed_cells_per_s);
  }

  friend bool operator==(const CaseInfo&, const CaseInfo&) = default;
};

/// A planning problem, identified by its content.
struct InstanceInfo {
  std::string content_hash;  ///< hexadecimal; equal content, equal hash
  std::string map_hash;      ///< hexadecimal
  std::string name;          ///< file name, or generator spec with seed and index
  std::int64_t robots = 0;
  std::int64_t width_cells = 0;
  std::int64_t height_cells = 0;
  std::int64_t blocked_cells = 0;
};

enum class ResultStatus {
  kSolved,
  kFailed,   ///< the method ended without a solution
  kLimit,    ///< censored: a limit ended it first
  kInvalid,  ///< a plan that the validator rejected
};
/// "solved", "failed", "limit", "invalid".
std::string_view name(ResultStatus status);

/// A point of the curve along which a plan was improved.
struct ProgressRow {
  std::int64_t iteration = 0;
  std::int64_t elapsed_ns = 0;  ///< wall clock since planning began
  double flowtime_s = 0;
  double makespan_s = 0;
  double flowtime_bound_s = 0;  ///< no plan can fall below
  double makespan_bound_s = 0;
};

/// A plan as it was given, if the result is of the same paths and orders with other times.
struct RetimingRow {
  bool executable = true;  ///< false: no times exist for these paths and orders
  bool given_valid = false;
  std::int64_t given_violations = 0;
  double given_makespan_s = 0;  ///< by the given plan's own clock
  double given_flowtime_s = 0;
  std::int64_t retime_ns = 0;  ///< wall clock of re-timing alone
  std::optional<std::int64_t>
      unit_step_cost;  ///< of plans of unit moves: the sum of steps, all robots at once
};

/// What one planning of one instance gave.
struct ResultRow {
  /// Place of the instance in its set, counted from 0. A set may hold one instance
  /// several times, as the archive of AAMAS 2018 does.
  std::int64_t position = 0;
  std::int64_t repetition = 0;  ///< counted from 0
  ResultStatus status = ResultStatus::kFailed;
  std::int64_t planning_time_ns = 0;  ///< wall clock, planning alone
  std::optional<double> makespan_s;   ///< solved and invalid plans only
  std::optional<double> flowtime_s;
  std::uint64_t tries = 0;
  std::uint64_t expansions = 0;
  std::uint64_t generations = 0;
  std::optional<std::uint64_t> plan_hash;
  /// The validator's verdict; none if there was no plan to check.
  std::optional<bool> valid;
  std::int64_t violations = 0;
  std::optional<double> min_clearance_cells;  ///< may be infinite (one robot)
  std::optional<std::int64_t> peak_memory_bytes;
  /// Which limit struck: "time", "expansions", "restarts", "memory"; else empty.
  std::string limit;
  std::string message;                       ///< the first violation in words; else empty
  std::string made_by;                       ///< "prioritized", "complete"; empty: another program
  std::optional<double> ssi_kept_s;          ///< may be infinite
  std::optional<std::int64_t> instructions;  ///< of planning, in user space
  std::optional<std::int64_t> cpu_time_ns;   ///< processor time of planning, over all threads
  /// What no plan of the instance by the moves of the case can fall below, solved or not; kept once for
  /// all results of the instance.
  std::optional<double> flowtime_bound_s;
  std::optional<double> makespan_bound_s;
  std::vector<ProgressRow> progress = {};    ///< of improvement, in order of time; else empty
  std::optional<RetimingRow> retiming = {};  ///< if the plan was re-timed
  /// What another program says of its run, under its own names: unchecked.
  std::vector<std::pair<std::string, double>> reported = {};
};

enum class RunStatus {
  kRunning,   ///< under way, or killed
  kFinished,  ///< everything that was asked for is there
  kAborted,   ///< ended early by its user or by an error
};
/// "running", "finished", "aborted".
std::string_view name(RunStatus status);

}  // namespace sipplab::db
