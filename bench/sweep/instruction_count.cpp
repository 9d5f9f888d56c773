#include "bench/sweep/instruction_count.hpp"

#include <linux/perf_event.h>
#include <sys/syscall.h>
#include <unistd.h>

namespace sipplab::bench {

PerfCounter::PerfCounter(std::uint32_t type, std::uint64_t config) {
  perf_event_attr event{};
  event.type = type;
  event.size = sizeof(event);
  event.config = config;
  event.inherit = 1;
  event.exclude_kernel = 1;
  event.exclude_hv = 1;
  constexpr int kThisProcess = 0;
  constexpr int kAnyProcessor = -1;
  constexpr int kNoGroup = -1;
  file_ = static_cast<int>(
      syscall(SYS_perf_event_open, &event, kThisProcess, kAnyProcessor, kNoGroup, PERF_FLAG_FD_CLOEXEC));
}

PerfCounter::~PerfCounter() {
  if (file_ >= 0) close(file_);
}

std::optional<std::int64_t> PerfCounter::count() const {
  std::int64_t counted = 0;
  if (file_ < 0 || read(file_, &counted, sizeof(counted)) != sizeof(counted)) return std::nullopt;
  return counted;
}

InstructionCount::InstructionCount() : PerfCounter(PERF_TYPE_HARDWARE, PERF_COUNT_HW_INSTRUCTIONS) {}

}  // namespace sipplab::bench
