// Records one run, planning by planning, several in one transaction: a killed run leaves what was
// committed and loses the rest.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "db/database.hpp"
#include "db/records.hpp"
#include "db/sqlite/error.hpp"

namespace sipplab::db {

/// A run of the same sweep that is there already.
struct EarlierRun {
  std::string uuid;
  std::string started_utc;
  RunStatus status = RunStatus::kRunning;
  bool being_written = false;  ///< by another process of this machine that is alive
  bool has_shard = false;      ///< an attempt of the same shard is there
  std::int64_t results = 0;
};

/// The plannings of one case that a run holds: of each row what sums of a case are made of, and which
/// planning it is.
struct RecordedCase {
  CaseInfo parameters;
  std::vector<ResultRow> rows;
};

/// UUID of the newest run that counts in which another command than that of `digest` planned as `planner`
/// ("cmd:NAME", with or without options behind it); runs without a command are passed over.
Result<std::optional<std::string>> find_other_command(Database& database, const std::string& planner,
                                                      const std::string& digest);

/// The run that `info` continues: same suite, options and build; the one of info.uuid, where that is empty
/// one that was recorded here and is not excluded, the newest that is not finished, else the newest. Where
/// `run` is given (as resolve_run takes it), that one, wherever it was recorded; an error if it is of
/// another suite, with other options or of another build.
Result<std::optional<EarlierRun>> find_earlier_run(Database& database, const RunInfo& info,
                                                   const std::optional<std::string>& run = {});

/// The error if there is a run of that id and it is not resumed.
Error run_is_there(const Database& database, const std::string& uuid);

/// What a run holds, case by case in the order in which they were begun.
Result<std::vector<RecordedCase>> recorded_cases(Database& database, const std::string& run_uuid);

/// Usage:
///
///     auto recorder = RunRecorder::begin(std::move(database), info);
///     for each case, for each instance that is not recorded:
///       recorder->add(the_case, instance, row);
///       once in a while: recorder->commit();
///     recorder->finish(RunStatus::kFinished);
///
/// Not for use by two threads at once; other processes may write to the same file.
class RunRecorder {
 public:
  /// Writes the row of a new run with the status "running", and of its first attempt. An error if the
  /// file holds a run of info.uuid.
  static Result<RunRecorder> begin(Database database, const RunInfo& info);

  /// Takes up a run under its own UUID, as a new attempt. From then on a process that still wrote to
  /// it gets an error, so that a run has one writer. An error if the run is excluded, or its writer is
  /// another process of this machine that is alive.
  static Result<RunRecorder> resume(Database database, const std::string& run_uuid, const RunInfo& info);

  const std::string& run_uuid() const { return run_uuid_; }

  /// Buffers one result; nothing is written yet. Cases may interleave.
  void add(const CaseInfo& parameters, const InstanceInfo& instance, const ResultRow& row);

  /// Writes all that is buffered in one transaction, with the summaries of its cases and what the attempt has
  /// taken so far. After an error nothing of it is in the file, the results are still buffered, and
  /// the call may be repeated. Two results of one instance, position and repetition are an error.
  Result<Done> commit(const AttemptUsage& usage = {});

  /// Forgets what is buffered.
  void discard() { buffered_.clear(); }

  /// Closes the run. Results that were buffered and not committed are dropped.
  Result<Done> finish(RunStatus status, const AttemptUsage& usage = {});

 private:
  struct BufferedResult {
    InstanceInfo instance;
    ResultRow row;
  };
  using BufferedCase = std::pair<CaseInfo, std::vector<BufferedResult>>;

  RunRecorder(Database database, std::string run_uuid, std::int64_t run_id, std::int64_t attempt_id);

  /// The row of a new attempt.
  static Result<std::int64_t> insert_attempt(sqlite::Connection& connection, std::int64_t run_id,
                                             const RunInfo& info);
  Result<Done> write_case(const CaseInfo& parameters, const std::vector<BufferedResult>& results);
  Result<Done> write_results(std::int64_t cell_id, const std::vector<BufferedResult>& results);
  Result<Done> write_retiming(std::int64_t cell_id, std::int64_t instance_id, const ResultRow& row);
  Result<Done> write_reported(std::int64_t cell_id, std::int64_t instance_id, const ResultRow& row);
  Result<Done> write_bounds(std::int64_t case_id, const std::vector<BufferedResult>& results);
  Result<Done> write_progress(std::int64_t cell_id, std::int64_t instance_id, const ResultRow& row);
  Result<Done> write_attempt(RunStatus status, const AttemptUsage& usage);
  /// An error when another process has taken the run over.
  Result<Done> check_writer();

  Database database_;
  std::string run_uuid_;
  std::int64_t run_id_ = 0;
  std::int64_t attempt_id_ = 0;
  std::vector<BufferedCase> buffered_;
};

}  // namespace sipplab::db
