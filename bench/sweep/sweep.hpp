// A sweep under way: the one place where planner, Google Benchmark and history meet.
// Each case is a benchmark whose iterations run over its plannings; about once a second
// what is done goes to the history in one transaction.
#pragma once

#include <benchmark/benchmark.h>

#include <chrono>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <tuple>
#include <vector>

#include "bench/sweep/attempt.hpp"
#include "bench/sweep/case_outcome.hpp"
#include "bench/sweep/command_planner.hpp"
#include "bench/sweep/expand.hpp"
#include "bench/sweep/peak_memory.hpp"
#include "bench/sweep/progress.hpp"
#include "db/recorder.hpp"
#include "planner/improve/static_times.hpp"

namespace sipplab::bench {

struct SweepEntry {
  std::string name;
  SweepCase parameters;
  db::CaseInfo row;
  std::vector<Planning> plannings;  ///< to be done by this process
  std::size_t next = 0;             ///< the first of them that is not done
  CaseOutcome outcome;
  bool begun = false;

  bool finished() const { return next == plannings.size(); }
};

/// Where the results go. Nothing is written before start().
class Recording {
 public:
  /// `resume`: take up that run; else a new one. REQUIRES: an open history.
  Recording(db::Database database, db::RunInfo info, std::optional<std::string> resume);

  db::Result<db::Done> start();
  bool started() const { return recorder_.has_value(); }
  void add(const SweepEntry& entry, const db::InstanceInfo& instance, const db::ResultRow& row);
  /// Commits if the last commit was about a second ago.
  db::Result<db::Done> commit_if_due();
  db::Result<db::Done> finish(db::RunStatus status);
  const std::string& run_uuid() const { return recorder_->run_uuid(); }

 private:
  std::optional<db::Database> database_;
  db::RunInfo info_;
  std::optional<std::string> resume_;
  std::optional<db::RunRecorder> recorder_;
  UsageMeter usage_;
  std::chrono::steady_clock::time_point committed_ = {};
};

class Sweep {
 public:
  /// Does the plannings that the cases name; `repetitions` of each instance belong together in reports where
  /// all of a case are to be done. `command`: plans instead of this planner. `retimed`: this planner's plans
  /// are re-timed.
  Sweep(ExpandedSweep cases, Recording recording, std::int64_t repetitions, bool live_progress,
        std::optional<CommandPlanner> command = std::nullopt, bool retimed = false);

  /// Makes a benchmark of each case that is not finished. `fill_counters`: give every counter a value, as
  /// CSV needs (-1 for a mean over nothing).
  void register_benchmarks(bool fill_counters);

  /// Opens the run in the history. False, with error(), where that fails.
  bool begin();
  /// Says what became of a case; `name` is that of its benchmark.
  void finish_case(const std::string& name);
  /// Commits what is left and closes the run.
  void end();

  const std::vector<SweepEntry>& entries() const { return entries_; }
  /// UUID of the run; empty before begin().
  std::string run_uuid();
  /// The first thing that went wrong with the history.
  const std::optional<db::Error>& error() const { return error_; }
  /// The first plan that the validator rejected.
  const std::string& first_invalid() const { return first_invalid_; }
  Progress& progress() { return progress_; }

 private:
  void measure(benchmark::State& state, SweepEntry& entry, bool fill_counters);
  bool stopping() const;
  Expected<db::ResultRow, std::string> plan_one(const PreparedInstance& prepared, const SweepCase& parameters,
                                                PeakMemory& memory);
  /// Computed once for all cases and repetitions.
  const LowerBound& bound_of(const PreparedInstance& prepared, const PlannerOptions& options);

  std::vector<InstanceSet> sets_;
  std::vector<SweepEntry> entries_;
  std::map<std::tuple<const PreparedInstance*, bool, int>, LowerBound> bounds_;
  Recording recording_;
  std::int64_t repetitions_;
  Progress progress_;
  std::optional<CommandPlanner> command_;
  bool retimed_ = false;
  std::optional<db::Error> error_;
  std::string first_invalid_;
};

}  // namespace sipplab::bench
