#include "bench/sweep/peak_memory.hpp"

#include <fcntl.h>
#include <sys/resource.h>
#include <unistd.h>

namespace sipplab::bench {
namespace {

/// What getrusage() counts memory in.
constexpr std::int64_t kBytesPerKib = 1024;

}  // namespace

PeakMemory::PeakMemory() {
  constexpr char kResetPeak = '5';  // see proc(5)
  const int file = open("/proc/self/clear_refs", O_WRONLY | O_CLOEXEC);
  if (file < 0) return;
  is_measured_ = write(file, &kResetPeak, 1) == 1;
  close(file);
}

std::optional<std::int64_t> PeakMemory::bytes() const {
  rusage usage{};
  if (!is_measured_ || getrusage(RUSAGE_SELF, &usage) != 0) return std::nullopt;
  return usage.ru_maxrss * kBytesPerKib;
}

}  // namespace sipplab::bench
