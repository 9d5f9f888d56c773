#include "bench/sweep/sweep.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

#include "bench/interrupt.hpp"
#include "bench/sweep/run_instance.hpp"
#include "sipplab/generator.hpp"

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
    // Of what was called for last the planner hears while it plans.
    entry.parameters.options.stop = &hurry_flag();
    entry.plannings = std::move(named.plannings);
    entry.outcome = named.outcome;
    entries.push_back(std::move(entry));
  }
  return entries;
}

/// Plans something small, so that what the first case is measured to take, memory above all, is not that of
/// code which is read for the first time.
void warm_up() {
  GeneratorOptions robots;
  robots.agents = 64;
  const auto instance = generate_instance(warehouse_map(), robots);
  if (instance) run_instance(*instance, {});
}

std::size_t cases_left(const ExpandedSweep& sweep) {
  return static_cast<std::size_t>(std::count_if(sweep.cases.begin(), sweep.cases.end(),
                                                [](const auto& named) { return !named.plannings.empty(); }));
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
  auto recorder = resume_ ? db::RunRecorder::resume(std::move(*database_), *resume_, info_)
                          : db::RunRecorder::begin(std::move(*database_), info_);
  database_.reset();
  if (!recorder) return Unexpected{recorder.error()};
  recorder_.emplace(std::move(*recorder));
  committed_ = std::chrono::steady_clock::now();
  return db::Done{};
}

void Recording::add(const SweepEntry& entry, const db::InstanceInfo& instance, const db::ResultRow& row) {
  recorder_->add(entry.row, instance, row);
  usage_.add_peak(row.peak_memory_bytes.value_or(0));
}

db::Result<db::Done> Recording::commit_if_due() {
  // What a kill may cost. A commit takes milliseconds.
  constexpr std::chrono::seconds kBetweenCommits{1};
  const auto now = std::chrono::steady_clock::now();
  if (now - committed_ < kBetweenCommits) return db::Done{};
  committed_ = now;
  return recorder_->commit(usage_.now());
}

db::Result<db::Done> Recording::finish(db::RunStatus status) {
  SIPPLAB_TRY(recorder_->commit(usage_.now()));
  return recorder_->finish(status, usage_.now());
}

Sweep::Sweep(ExpandedSweep cases, Recording recording, std::int64_t repetitions, bool live_progress,
             std::optional<CommandPlanner> command, bool retimed)
    : recording_(std::move(recording)),
      repetitions_(repetitions),
      progress_(cases_left(cases), count_left(cases), live_progress),
      command_(std::move(command)),
      retimed_(retimed) {
  sets_ = std::move(cases.sets);
  entries_ = entries_of(std::move(cases.cases));
}

void Sweep::register_benchmarks(bool fill_counters) {
  for (SweepEntry& entry : entries_) {
    if (entry.finished()) continue;
    const std::size_t instances = sets_[entry.parameters.set].instances.size();
    const bool whole = entry.plannings.size() == instances * static_cast<std::size_t>(repetitions_);
    benchmark::internal::Benchmark* benchmark = benchmark::RegisterBenchmark(
        entry.name.c_str(),
        [this, &entry, fill_counters](benchmark::State& state) { measure(state, entry, fill_counters); });
    benchmark->Iterations(static_cast<benchmark::IterationCount>(whole ? instances : entry.plannings.size()))
        ->UseManualTime()
        ->Unit(benchmark::kMillisecond);
    if (!whole && repetitions_ > 1) benchmark->Repetitions(1);
  }
}

bool Sweep::begin() {
  const db::Result<db::Done> started = recording_.start();
  if (!started) error_ = started.error();
  if (started && !command_) warm_up();
  return started.has_value();
}

bool Sweep::stopping() const { return interrupted_by() != 0 || error_.has_value(); }

Expected<db::ResultRow, std::string> Sweep::plan_one(const PreparedInstance& prepared,
                                                     const SweepCase& parameters, PeakMemory& memory) {
  if (!prepared.broken.empty()) {
    db::ResultRow row;
    row.message = prepared.broken;
    return row;
  }
  const LowerBound& bound = bound_of(prepared, parameters.options);
  memory.restart();
  Expected<db::ResultRow, std::string> row =
      command_ ? command_->run(prepared.instance, parameters.options)
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
    progress_.begin_case(short_case_name(entry.parameters), entry.plannings.size());
  }
  CaseOutcome outcome;  // of this repetition
  std::string violation;
  PeakMemory memory;  // a case has its own baseline: the process holds what cases before it left
  for ([[maybe_unused]] auto iteration : state) {
    if (stopping()) {
      state.SkipWithError("stopped before its end");
      break;
    }
    const Planning& planning = entry.plannings[entry.next];
    const PreparedInstance& prepared = instances[static_cast<std::size_t>(planning.position)];
    Expected<db::ResultRow, std::string> planned = plan_one(prepared, entry.parameters, memory);
    if (!planned) error_ = db::Error{db::ErrorKind::kInternal, std::move(planned.error())};
    if (hurry_flag() || (command_ && stopping())) {
      state.SkipWithError("stopped before its end");  // and so was the planning
      break;
    }
    ++entry.next;
    db::ResultRow& row = *planned;
    row.position = planning.position;
    row.repetition = planning.repetition;
    state.SetIterationTime(static_cast<double>(row.planning_time_ns) * kSecondsPerNanosecond);
    // Of this planner that is an error of its own; of another one it is a result.
    if (!command_ && row.status == db::ResultStatus::kInvalid && violation.empty()) {
      violation = entry.name + ", " + prepared.row.name + ": " + row.message;
    }
    outcome.add(row);
    entry.outcome.add(row);
    recording_.add(entry, prepared.row, row);
    if (const auto committed = recording_.commit_if_due(); !committed) error_ = committed.error();
    progress_.finish_instance();
  }
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
  if (entry == entries_.end() || !entry->finished() || error_) return;
  const std::optional<double> solved_in_s = entry->outcome.mean_solved_planning_s();
  progress_.finish_case(fmt::format("success {:.2f}", entry->outcome.success_rate()) +
                        (solved_in_s ? fmt::format(", solved in {:.2f} ms", *solved_in_s * 1e3) : ""));
}

void Sweep::end() {
  progress_.clear();
  if (!recording_.started()) return;
  const bool complete =
      std::all_of(entries_.begin(), entries_.end(), [](const SweepEntry& entry) { return entry.finished(); });
  const db::Result<db::Done> closed =
      recording_.finish(complete && !error_ ? db::RunStatus::kFinished : db::RunStatus::kAborted);
  if (!closed && !error_) error_ = closed.error();
}

std::string Sweep::run_uuid() { return recording_.started() ? recording_.run_uuid() : ""; }

}  // namespace sipplab::bench
