#include "bench/sweep/attempt.hpp"

#include <sched.h>
#include <sys/resource.h>

#include <algorithm>
#include <chrono>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <sstream>
#include <string_view>

#include "planner/core/number.hpp"

namespace sipplab::bench {
namespace {

namespace fs = std::filesystem;

std::string variable(const char* name) {
  const char* text = std::getenv(name);
  return text == nullptr ? "" : text;
}

/// How a scheduler says which task of which job this is.
struct Scheduler {
  const char* name;
  const char* job;
  const char* fallback_job;  ///< where the job is no array
  const char* task;
  const char* restarts;
};
constexpr Scheduler kSchedulers[] = {
    {"slurm", "SLURM_ARRAY_JOB_ID", "SLURM_JOB_ID", "SLURM_ARRAY_TASK_ID", "SLURM_RESTART_COUNT"},
    {"sge", "JOB_ID", "JOB_ID", "SGE_TASK_ID", "RESTARTED"},
    {"pbs", "PBS_JOBID", "PBS_JOBID", "PBS_ARRAY_INDEX", "PBS_RESTARTED"},
    {"pbs", "PBS_JOBID", "PBS_JOBID", "PBS_ARRAYID", "PBS_RESTARTED"},
    {"htcondor", "CONDOR_CLUSTER", "CONDOR_CLUSTER", "CONDOR_PROCESS", "CONDOR_RESTARTS"},
    {"parallel", "PARALLEL_PID", "PARALLEL_PID", "PARALLEL_SEQ", "PARALLEL_RETRIES"},
};

/// The scheduler whose array this process is in, else the one whose job it is.
const Scheduler* scheduler() {
  for (const Scheduler& one : kSchedulers) {
    const std::string task = variable(one.task);
    if (!task.empty() && task != "undefined") return &one;  // SGE's word for no array
  }
  for (const Scheduler& one : kSchedulers) {
    if (!variable(one.fallback_job).empty()) return &one;
  }
  return nullptr;
}

std::string first_word(const fs::path& path) {
  std::ifstream file(path);
  std::string word;
  file >> word;
  return word;
}

/// What a file of the process's cgroup says, and what the groups above it say: limits hold for all below.
template <class Visit>
void visit_cgroups(const std::string& controller, const Visit& visit) {
  std::ifstream file("/proc/self/cgroup");
  for (std::string line; std::getline(file, line);) {
    const std::size_t first = line.find(':');
    const std::size_t second = line.find(':', first + 1);
    if (second == std::string::npos) continue;
    const std::string controllers = "," + line.substr(first + 1, second - first - 1) + ",";
    fs::path root = "/sys/fs/cgroup";
    if (controllers != ",,") {
      if (controllers.find("," + controller + ",") == std::string::npos) continue;
      root /= controller;
    }
    for (fs::path group = root / fs::path(line.substr(second + 1)).relative_path();;
         group = group.parent_path()) {
      visit(group);
      if (group == root || group.native().size() <= root.native().size()) break;
    }
  }
}

std::optional<std::int64_t> memory_limit() {
  // Version 1 has no word for "none", but a number beyond all memory.
  constexpr std::int64_t kNoLimit = std::int64_t{1} << 60;
  std::int64_t limit = kNoLimit;
  visit_cgroups("memory", [&limit, kNoLimit](const fs::path& group) {
    for (const char* file : {"memory.max", "memory.limit_in_bytes"}) {
      limit = std::min(limit, parse_number<std::int64_t>(first_word(group / file)).value_or(kNoLimit));
    }
  });
  if (limit == kNoLimit) return std::nullopt;
  return limit;
}

double usable_cores() {
  cpu_set_t set;
  CPU_ZERO(&set);
  double cores = sched_getaffinity(0, sizeof set, &set) == 0 ? CPU_COUNT(&set) : 0;
  visit_cgroups("cpu", [&cores](const fs::path& group) {
    std::ifstream both(group / "cpu.max");
    double quota = 0;
    double period = 0;
    if (!(both >> quota >> period)) {
      std::ifstream(group / "cpu.cfs_quota_us") >> quota;
      std::ifstream(group / "cpu.cfs_period_us") >> period;
    }
    if (quota > 0 && period > 0) cores = std::min(cores, quota / period);
  });
  return cores;
}

}  // namespace

db::AttemptInfo attempt_info() {
  db::AttemptInfo attempt;
  if (const Scheduler* one = scheduler()) {
    attempt.scheduler = one->name;
    attempt.job = variable(one->job);
    if (attempt.job.empty()) attempt.job = variable(one->fallback_job);
    attempt.task = array_index().value_or("");
    attempt.restarts =
        std::max<std::int64_t>(0, parse_number<std::int64_t>(variable(one->restarts)).value_or(0));
  }
  if (const auto submitted = parse_number<std::int64_t>(variable("SIPPLAB_SUBMITTED"))) {
    const auto now = std::chrono::system_clock::now().time_since_epoch();
    attempt.queued_s =
        std::max(0.0, std::chrono::duration<double>(now).count() - static_cast<double>(*submitted));
  }
  attempt.cores = usable_cores();
  attempt.memory_limit_bytes = memory_limit();
  return attempt;
}

std::optional<std::string> array_index() {
  const Scheduler* one = scheduler();
  if (one == nullptr) return std::nullopt;
  const std::string task = variable(one->task);
  if (task.empty() || task == "undefined") return std::nullopt;
  return task;
}

void UsageMeter::add_peak(std::int64_t peak_bytes) { peak_bytes_ = std::max(peak_bytes_, peak_bytes); }

db::AttemptUsage UsageMeter::now() {
  constexpr std::int64_t kBytesPerKib = 1024;
  constexpr std::int64_t kNanosecondsPerSecond = 1'000'000'000;
  constexpr std::int64_t kNanosecondsPerMicrosecond = 1000;
  db::AttemptUsage taken;
  for (const auto whose : {RUSAGE_SELF, RUSAGE_CHILDREN}) {
    rusage usage{};
    if (getrusage(whose, &usage) != 0) continue;
    for (const timeval& time : {usage.ru_utime, usage.ru_stime}) {
      taken.cpu_time_ns += time.tv_sec * kNanosecondsPerSecond + time.tv_usec * kNanosecondsPerMicrosecond;
    }
    add_peak(usage.ru_maxrss * kBytesPerKib);
  }
  taken.peak_memory_bytes = peak_bytes_;
  return taken;
}

}  // namespace sipplab::bench
