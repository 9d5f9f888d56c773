#include "bench/sweep/sweep.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

#include "bench/interrupt.hpp"
#include "bench/sweep/peak_memory.hpp"
#include "bench/sweep/run_instance.hpp"

namespace sipplab::bench {
namespace {

constexpr double kSecondsPerNanosecond = 1e-9;
/// Stands for a mean over nothing where a counter cannot be left out.
constexpr double kNoValue = -1;

std::vector<SweepEntry> entries_of(std::vector<NamedCase> cases) {
  std::vector<SweepEntry> entries;
  for (NamedCase& named : cases) {
    SweepEntry entry;
    entry.name = std::move(named.name);
    entry.row = case_row(named.parameters);
    entry.parameters = std::move(named.parameters);
    entries.push_back(std::move(entry));
  }
  return entries;
}

std::size_t instance_count(const ExpandedSweep& sweep) {
  std::size_t count = 0;
  for (const NamedCase& named : sweep.cases) count += sweep.sets[named.parameters.set].instances.size();
  return count;
}

void set_counters(benchmark::State& state, const CaseOutcome& outcome, bool fill) {
  state.counters["success_rate"] = outcome.success_rate();
  state.counters["tries"] = outcome.mean_tries();
  state.counters["expansions"] = outcome.mean_expansions();
  if (outcome.solved() > 0 || fill) {
    state.counters["makespan"] = outcome.mean_makespan_s().value_or(kNoValue);
    state.counters["flowtime"] = outcome.mean_flowtime_s().value_or(kNoValue);
  }
}

}  // namespace

Recording::Recording(db::Database database, db::RunInfo info, std::optional<std::string> resume)
    : database_(std::move(database)), info_(std::move(info)), resume_(std::move(resume)) {}

db::Result<db::Done> Recording::start() {
  auto recorder = resume_ ? db::RunRecorder::resume(std::move(*database_), *resume_)
                          : db::RunRecorder::begin(std::move(*database_), info_);
  database_.reset();
  if (!recorder) return Unexpected{recorder.error()};
  recorder_.emplace(std::move(*recorder));
  return db::Done{};
}

Sweep::Sweep(ExpandedSweep cases, Recording recording, std::int64_t repetitions, bool live_progress,
             std::optional<CommandPlanner> command, bool retimed)
    : recording_(std::move(recording)),
      repetitions_(repetitions),
      progress_(cases.cases.size(), instance_count(cases) * static_cast<std::size_t>(repetitions),
                live_progress),
      command_(std::move(command)),
      retimed_(retimed) {
  sets_ = std::move(cases.sets);
  entries_ = entries_of(std::move(cases.cases));
}

void Sweep::register_benchmarks(bool fill_counters) {
  for (SweepEntry& entry : entries_) {
    const auto count = static_cast<benchmark::IterationCount>(sets_[entry.parameters.set].instances.size());
    benchmark::RegisterBenchmark(
        entry.name.c_str(),
        [this, &entry, fill_counters](benchmark::State& state) { measure(state, entry, fill_counters); })
        ->Iterations(count)
        ->UseManualTime()
        ->Unit(benchmark::kMillisecond);
  }
}

bool Sweep::begin() {
  const db::Result<db::Done> started = recording_.start();
  if (!started) error_ = started.error();
  return started.has_value();
}

bool Sweep::stopping() const { return interrupted_by() != 0 || error_.has_value(); }

Expected<db::ResultRow, std::string> Sweep::plan_one(const PreparedInstance& prepared,
                                                     const SweepCase& parameters) {
  if (!prepared.broken.empty()) {
    db::ResultRow row;
    row.message = prepared.broken;
    return row;
  }
  const LowerBound& bound = bound_of(prepared, parameters.options);
  const PeakMemory memory;
  Expected<db::ResultRow, std::string> row = command_ ? command_->run(prepared.instance, parameters.options)
                                                      : run_instance(prepared.instance, parameters.options, retimed_);
  if (!row) return row;
  if (!command_) row->peak_memory_bytes = memory.bytes();
  // Improvement takes its time to find a greater one.
  row->flowtime_bound_s = std::max(row->flowtime_bound_s.value_or(0), bound.flowtime_s);
  row->makespan_bound_s = std::max(row->makespan_bound_s.value_or(0), bound.makespan_s);
  return row;
}

const LowerBound& Sweep::bound_of(const PreparedInstance& prepared, const PlannerOptions& options) {
  const auto [bound, is_new] =
      bounds_.try_emplace({&prepared, options.any_angle, options.any_angle ? 0 : options.connectedness});
  if (is_new) bound->second = lower_bound(prepared.instance, options.any_angle, options.connectedness);
  return bound->second;
}

void Sweep::measure(benchmark::State& state, SweepEntry& entry, bool fill_counters) {
  const std::vector<PreparedInstance>& instances = sets_[entry.parameters.set].instances;
  if (!std::exchange(entry.begun, true) && !stopping()) {
    progress_.begin_case(short_case_name(entry.parameters),
                         instances.size() * static_cast<std::size_t>(repetitions_));
  }
  CaseOutcome outcome;  // of this repetition
  std::string violation;
  std::size_t next = 0;
  for ([[maybe_unused]] auto iteration : state) {
    if (stopping()) {
      state.SkipWithError("stopped before its end");
      break;
    }
    const std::size_t position = next++;
    const PreparedInstance& prepared = instances[position];
    Expected<db::ResultRow, std::string> planned = plan_one(prepared, entry.parameters);
    if (!planned) error_ = db::Error{db::ErrorKind::kInternal, std::move(planned.error())};
    if (command_ && stopping()) {
      state.SkipWithError("stopped before its end");  // the program was ended, too
      break;
    }
    db::ResultRow& row = *planned;
    row.position = static_cast<std::int64_t>(position);
    row.repetition = entry.repetitions;
    state.SetIterationTime(static_cast<double>(row.planning_time_ns) * kSecondsPerNanosecond);
    // Of this planner that is an error of its own; of another one it is a result.
    if (!command_ && row.status == db::ResultStatus::kInvalid && violation.empty()) {
      violation = entry.name + ", " + prepared.row.name + ": " + row.message;
    }
    outcome.add(row);
    entry.outcome.add(row);
    recording_.recorder().add(entry.row, prepared.row, row);
    progress_.finish_instance();
  }
  ++entry.repetitions;
  if (!violation.empty()) {
    if (first_invalid_.empty()) first_invalid_ = violation;
    state.SkipWithError(("invalid plan: " + violation).c_str());
  } else if (!state.error_occurred()) {
    set_counters(state, outcome, fill_counters);
  }
}

void Sweep::finish_case(const std::string& name) {
  const auto entry = std::find_if(entries_.begin(), entries_.end(),
                                  [&name](const SweepEntry& candidate) { return candidate.name == name; });
  if (entry == entries_.end() || entry->finished || error_) return;
  const std::size_t expected =
      sets_[entry->parameters.set].instances.size() * static_cast<std::size_t>(repetitions_);
  if (static_cast<std::size_t>(entry->outcome.results()) < expected) {  // stopped half-way
    recording_.recorder().discard_case(entry->row);
    return;
  }
  const db::Result<db::Done> committed = recording_.recorder().commit_case(entry->row);
  if (!committed) {
    error_ = committed.error();
    return;
  }
  entry->finished = true;
  const std::optional<double> solved_in_s = entry->outcome.mean_solved_planning_s();
  progress_.finish_case(fmt::format("success {:.2f}", entry->outcome.success_rate()) +
                        (solved_in_s ? fmt::format(", solved in {:.2f} ms", *solved_in_s * 1e3) : ""));
}

void Sweep::end() {
  progress_.clear();
  if (!recording_.started()) return;
  const bool complete =
      std::all_of(entries_.begin(), entries_.end(), [](const SweepEntry& entry) { return entry.finished; });
  const db::Result<db::Done> closed =
      recording_.recorder().finish(complete ? db::RunStatus::kFinished : db::RunStatus::kAborted);
  if (!closed && !error_) error_ = closed.error();
}

std::string Sweep::run_uuid() { return recording_.started() ? recording_.recorder().run_uuid() : ""; }

}  // namespace sipplab::bench
