// Records one run, case by case. A case lands in one transaction, so a killed run
// leaves its finished cases and nothing of the others.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "db/database.hpp"
#include "db/records.hpp"
#include "db/sqlite/error.hpp"

namespace sipplab::db {

/// A run that ended early and can be taken up again.
struct ResumableRun {
  std::string uuid;
  std::string started_utc;
  RunStatus status = RunStatus::kRunning;
  std::size_t finished_cases = 0;
};

/// UUID of the newest run that counts in which another command than that of `digest` planned as `planner`
/// ("cmd:NAME", with or without options behind it); runs without a command are passed over.
Result<std::optional<std::string>> find_other_command(Database& database, const std::string& planner,
                                                      const std::string& digest);

/// The newest run that `info` could continue: same suite, options, build and
/// machine, not finished, not excluded, and not being written by a live process.
Result<std::optional<ResumableRun>> find_resumable_run(Database& database, const RunInfo& info);

/// The cases that a run has finished, in the order in which they were.
Result<std::vector<CaseInfo>> finished_cases(Database& database, const std::string& run_uuid);

/// Usage:
///
///     auto recorder = RunRecorder::begin(std::move(database), info);
///     for each case:
///       if (recorder->is_finished(the_case)) continue;
///       for each instance: recorder->add(the_case, instance, row);
///       recorder->commit_case(the_case);
///     recorder->finish(RunStatus::kFinished);
///
/// Not for use by two threads at once; other processes may write to the same file.
class RunRecorder {
 public:
  /// Writes the row of a new run, with a fresh UUID and the status "running".
  static Result<RunRecorder> begin(Database database, const RunInfo& info);

  /// Takes up a run under its own UUID. From then on a process that still wrote to
  /// it gets an error, so that a run has one writer.
  static Result<RunRecorder> resume(Database database, const std::string& run_uuid);

  const std::string& run_uuid() const { return run_uuid_; }

  /// Whether the run holds this case already.
  bool is_finished(const CaseInfo& parameters) const;

  /// Buffers one result; nothing is written yet. Cases may interleave.
  void add(const CaseInfo& parameters, const InstanceInfo& instance, const ResultRow& row);

  /// Writes the buffered results of a case in one transaction and marks it as
  /// finished (a case without results too). After an error nothing of the case is
  /// in the file, its results are still buffered, and the call may be repeated.
  /// Two results of one instance, position and repetition are an error.
  Result<Done> commit_case(const CaseInfo& parameters);

  /// Forgets the buffered results of a case.
  void discard_case(const CaseInfo& parameters);

  /// Closes the run. Results that were buffered and not committed are dropped.
  Result<Done> finish(RunStatus status);

 private:
  struct BufferedResult {
    InstanceInfo instance;
    ResultRow row;
  };
  using BufferedCase = std::pair<CaseInfo, std::vector<BufferedResult>>;

  RunRecorder(Database database, std::string run_uuid, std::int64_t run_id);

  Result<Done> write_case(const CaseInfo& parameters, const std::vector<BufferedResult>& results);
  Result<Done> write_results(std::int64_t cell_id, const std::vector<BufferedResult>& results);
  Result<Done> write_retiming(std::int64_t cell_id, std::int64_t instance_id, const ResultRow& row);
  Result<Done> write_reported(std::int64_t cell_id, std::int64_t instance_id, const ResultRow& row);
  Result<Done> write_bounds(std::int64_t case_id, const std::vector<BufferedResult>& results);
  Result<Done> write_progress(std::int64_t cell_id, std::int64_t instance_id, const ResultRow& row);
  /// An error when another process has taken the run over.
  Result<Done> check_writer();

  Database database_;
  std::string run_uuid_;
  std::int64_t run_id_ = 0;
  std::vector<CaseInfo> finished_;
  std::vector<BufferedCase> buffered_;
};

}  // namespace sipplab::db
