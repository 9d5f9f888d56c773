#include "bench/gate/laboratory.hpp"

#include <fmt/format.h>
#include <unistd.h>

#include <utility>

#include "bench/gate/slowdown.hpp"
#include "bench/sweep/run_info.hpp"
#include "bench/sweep/sweep_case.hpp"
#include "db/database.hpp"
#include "db/queries.hpp"
#include "planner/core/number.hpp"
#include "planner/core/try.hpp"
#include "sipplab/instance_io.hpp"
#include "sipplab/validator.hpp"

namespace sipplab::bench {
namespace {

constexpr std::pair<GateTask, std::string_view> kTaskNames[] = {{GateTask::kPlan, "plan"},
                                                                {GateTask::kRead, "read"},
                                                                {GateTask::kValidate, "validate"},
                                                                {GateTask::kRecord, "record"},
                                                                {GateTask::kAsk, "ask"}};

constexpr int kResultsOfCase = 50;
constexpr int kCasesAsked = 10;
/// In less, a system call that takes its time would show.
constexpr std::int64_t kLeastSpentNs = 2'000'000;

constexpr const char* kQuestions[] = {
    "SELECT environment, robots, results, solved, median_planning_time_s FROM v_run_cells WHERE run = :run",
    "SELECT status, count(*), avg(flowtime_s) FROM v_results WHERE run = :run GROUP BY status"};

db::ResultRow invented(int index) {
  db::ResultRow row;
  row.position = index;
  row.status = db::ResultStatus::kSolved;
  row.planning_time_ns = 1'000'000 + 7919 * (index % 13);
  row.makespan_s = 30 + 0.1 * index;
  row.flowtime_s = 1000 + 0.3 * index;
  row.tries = 2;
  row.expansions = 5000;
  row.generations = 20000;
  row.plan_hash = static_cast<std::uint64_t>(index) + 1;
  row.valid = true;
  return row;
}

Expected<std::uint64_t, std::string> record_case(db::RunRecorder& recorder, std::int64_t seed) {
  db::CaseInfo parameters = case_row({});
  parameters.options["seed"] = seed;
  for (int i = 0; i < kResultsOfCase; ++i) {
    recorder.add(parameters, {fmt::format("{:016x}", i), "map", fmt::format("number {}", i), 64, 32, 32, 0},
                 invented(i));
  }
  const auto done = recorder.commit();
  if (!done) return Unexpected{done.error().message};
  return std::uint64_t{kResultsOfCase};
}

std::uint64_t leading_half(const std::string& hexadecimal) {
  return parse_number<std::uint64_t>(std::string_view(hexadecimal).substr(0, 16), 16).value_or(0);
}

}  // namespace

std::string_view name(GateTask task) { return kTaskNames[static_cast<std::size_t>(task)].second; }

std::optional<GateTask> parse_gate_task(std::string_view text) {
  for (const auto& [task, word] : kTaskNames) {
    if (word == text) return task;
  }
  return std::nullopt;
}

Expected<TimedTask, std::string> Laboratory::run(GateTask task, const std::string& file,
                                                 const Instance& instance, const PlannerOptions& options,
                                                 double slowdown) {
  TimedTask timed;
  timed.outcome = SIPPLAB_TRY(once(task, file, instance, options));  // opens and plans what it needs
  const std::int64_t begin_ns = thread_cpu_ns();
  std::int64_t spent_ns = 0;
  std::int64_t times = 0;
  while (spent_ns < kLeastSpentNs) {
    SIPPLAB_TRY(once(task, file, instance, options));
    ++times;
    spent_ns = thread_cpu_ns() - begin_ns;
  }
  burn(slowdown, spent_ns);
  timed.cpu_ns = (thread_cpu_ns() - begin_ns) / times;
  return timed;
}

Expected<std::uint64_t, std::string> Laboratory::once(GateTask task, const std::string& file,
                                                      const Instance& instance,
                                                      const PlannerOptions& options) {
  switch (task) {
    case GateTask::kRead: {
      InstanceFiles files;
      files.instance = file;
      const Input<LoadedInstance> loaded = load_instance(files);
      if (!loaded) return Unexpected{loaded.error().message()};
      return leading_half(content_hash(loaded->instance));
    }
    case GateTask::kValidate: {
      const auto known = plans_.find(&instance);
      const SolveResult& plan = known != plans_.end()
                                    ? known->second
                                    : plans_.emplace(&instance, solve(instance, options)).first->second;
      return std::uint64_t{1} +
             validate(instance, plan.solution(), plan.guarantees(options.rules)).violations.size();
    }
    case GateTask::kRecord:
      return record();
    case GateTask::kAsk:
      return ask();
    case GateTask::kPlan:
      break;
  }
  return Unexpected{std::string("planning is no task of the laboratory")};
}

Expected<db::RunRecorder, std::string> Laboratory::new_history(const char* file) const {
  auto database = db::Database::open(folder_ / file);
  if (!database) return Unexpected{database.error().message};
  db::RunInfo info;
  info.suite = "gate";
  info.machine = machine_info();
  auto recorder = db::RunRecorder::begin(std::move(*database), info);
  if (!recorder) return Unexpected{recorder.error().message};
  return std::move(*recorder);
}

Expected<std::uint64_t, std::string> Laboratory::record() {
  if (!recorder_) recorder_.emplace(SIPPLAB_TRY(new_history(fmt::format("{}-record.db", getpid()).c_str())));
  return record_case(*recorder_, ++recorded_);
}

Expected<std::uint64_t, std::string> Laboratory::ask() {
  const std::string file = fmt::format("{}-ask.db", getpid());
  if (!is_filled_) {
    auto recorder = SIPPLAB_TRY(new_history(file.c_str()));
    for (int i = 0; i < kCasesAsked; ++i) SIPPLAB_TRY(record_case(recorder, i));
    const auto done = recorder.finish(db::RunStatus::kFinished);
    if (!done) return Unexpected{done.error().message};
    is_filled_ = true;
  }
  std::uint64_t rows = 0;
  for (const char* question : kQuestions) {
    const auto table = db::run_sql(folder_ / file, question);
    if (!table) return Unexpected{table.error().message};
    rows = 100 * rows + table->rows.size();
  }
  return rows;
}

}  // namespace sipplab::bench
