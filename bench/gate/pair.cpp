#include "bench/gate/pair.hpp"

#include <algorithm>
#include <chrono>
#include <cmath>

#include "bench/interrupt.hpp"
#include "bench/judge/change.hpp"
#include "bench/judge/difference.hpp"
#include "planner/core/try.hpp"

namespace sipplab::bench {
namespace {

/// A planning that takes no time at all has no logarithm.
constexpr std::int64_t kShortestNs = 1;

double log_ratio(const WorkerAnswer& base, const WorkerAnswer& head) {
  return std::log(static_cast<double>(std::max(head.cpu_ns, kShortestNs)) /
                  static_cast<double>(std::max(base.cpu_ns, kShortestNs)));
}

std::vector<std::size_t> timed_jobs(const GateCases& cases, const std::vector<bool>& wanted) {
  std::vector<std::size_t> jobs;
  for (std::size_t cell = 0; cell < cases.cells().size(); ++cell) {
    if (!wanted[cell]) continue;
    jobs.insert(jobs.end(), cases.cells()[cell].jobs.begin(), cases.cells()[cell].jobs.end());
  }
  return jobs;
}

}  // namespace

Expected<WorkerPair, std::string> start_pair(const GateBuilds& builds, const GateCases& cases, bool all,
                                             Random& random) {
  const std::vector<int> cores = allowed_cores();
  std::optional<int> core;
  if (!cores.empty()) core = cores[static_cast<std::size_t>(random.below(cores.size()))];
  const WorkerProcess::Start base_start{builds.base, "base", core, {}};
  const WorkerProcess::Start head_start{builds.head, "head", core, builds.head_extras};
  const bool head_first = random.below(2) == 1;
  auto first = SIPPLAB_TRY(WorkerProcess::start(head_first ? head_start : base_start));
  auto second = SIPPLAB_TRY(WorkerProcess::start(head_first ? base_start : head_start));
  for (WorkerProcess* worker : {&first, &second}) {
    SIPPLAB_TRY(cases.hand_over(*worker, all));
  }
  if (head_first) return WorkerPair{std::move(second), std::move(first)};
  return WorkerPair{std::move(first), std::move(second)};
}

Expected<FirstAnswers, std::string> plan_all(WorkerPair& workers, const GateCases& cases) {
  FirstAnswers answers;
  for (std::size_t job = 0; job < cases.jobs().size(); ++job) {
    const auto base = SIPPLAB_TRY(workers.base.plan(job, WorkerProcess::Ask::kVerdict));
    const auto head = SIPPLAB_TRY(workers.head.plan(job, WorkerProcess::Ask::kVerdict));
    answers.base.push_back(base.row);
    answers.head.push_back(head.row);
    if (interrupted_by() != 0) return Unexpected{std::string("interrupted")};
  }
  return answers;
}

Expected<PairTimes, std::string> time_pair(WorkerPair& workers, const GateCases& cases,
                                           const std::vector<bool>& wanted, const FirstAnswers& expected,
                                           const PairBudget& budget, Random& random) {
  using Clock = std::chrono::steady_clock;
  Clock::time_point fast_begin = Clock::now();  // the budget is that of cells that are not slow
  PairTimes times;
  times.log_ratios.resize(cases.cells().size());
  std::vector<std::size_t> jobs = timed_jobs(cases, wanted);
  const auto note_repetition = [&times](const db::ResultRow& before, const db::ResultRow& now,
                                        std::size_t job, bool head) {
    // A plan that the validator rejected was checked the first time only.
    if (before.status == db::ResultStatus::kInvalid || !change(before, now)) return;
    if (times.unrepeatable_job) return;
    times.unrepeatable_job = job;
    times.unrepeatable_head = head;
  };
  for (int round = 0; round < budget.fewest_rounds ||
                      std::chrono::duration<double>(Clock::now() - fast_begin).count() < budget.seconds;
       ++round) {
    if (round == budget.slow_rounds) {
      std::erase_if(jobs, [&cases](std::size_t job) { return cases.cells()[cases.jobs()[job].cell].slow; });
      fast_begin = Clock::now();
    }
    if (jobs.empty()) break;
    random.shuffle(jobs);
    for (const std::size_t job : jobs) {
      const bool head_first = random.below(2) == 1;
      const WorkerProcess::Ask ask = round == 0 ? WorkerProcess::Ask::kPages : WorkerProcess::Ask::kClock;
      auto first = SIPPLAB_TRY((head_first ? workers.head : workers.base).plan(job, ask));
      auto second = SIPPLAB_TRY((head_first ? workers.base : workers.head).plan(job, ask));
      const WorkerAnswer& base = head_first ? second : first;
      const WorkerAnswer& head = head_first ? first : second;
      note_repetition(expected.base[job], base.row, job, false);
      note_repetition(expected.head[job], head.row, job, true);
      times.log_ratios[cases.jobs()[job].cell].push_back(log_ratio(base, head));
      if (base.row.peak_memory_bytes && head.row.peak_memory_bytes) {
        times.memory_log_ratios.push_back(std::log(kMemory.value(head.row) / kMemory.value(base.row)));
      }
    }
    if (interrupted_by() != 0) return Unexpected{std::string("interrupted")};
  }
  return times;
}

}  // namespace sipplab::bench
