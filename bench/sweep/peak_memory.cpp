#include "bench/sweep/peak_memory.hpp"

#include <fcntl.h>
#include <sys/resource.h>
#include <unistd.h>

#include <algorithm>
#include <fstream>

#ifdef __GLIBC__
#include <malloc.h>
#endif

namespace sipplab::bench {
namespace {

/// What getrusage() counts memory in.
constexpr std::int64_t kBytesPerKib = 1024;

/// What the process holds now; 0 if the system does not say.
std::int64_t resident_bytes() {
  std::int64_t pages = 0;
  std::ifstream("/proc/self/statm") >> pages >> pages;  // of all, then those that are resident
  return pages * sysconf(_SC_PAGESIZE);
}

}  // namespace

PeakMemory::PeakMemory() {
#ifdef __GLIBC__
  malloc_trim(0);  // what was freed before would be taken again unseen
#endif
  restart();
  before_bytes_ = resident_bytes();
}

void PeakMemory::restart() {
  constexpr char kResetPeak = '5';  // see proc(5)
  const int file = open("/proc/self/clear_refs", O_WRONLY | O_CLOEXEC);
  is_measured_ = file >= 0 && write(file, &kResetPeak, 1) == 1;
  if (file >= 0) close(file);
}

std::optional<std::int64_t> PeakMemory::bytes() const {
  rusage usage{};
  if (!is_measured_ || getrusage(RUSAGE_SELF, &usage) != 0) return std::nullopt;
  return std::max<std::int64_t>(0, usage.ru_maxrss * kBytesPerKib - before_bytes_);
}

}  // namespace sipplab::bench
