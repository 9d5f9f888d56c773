// How many instructions a piece of work takes: a count that other processes do not disturb.
#pragma once

#include <cstdint>
#include <optional>

namespace sipplab::bench {

/// One counter of the kernel, see perf_event_open(2), for this thread and those that it makes
/// from now on, in user space alone. Counts from its construction. Some ten microseconds.
class PerfCounter {
 public:
  /// As in perf_event_attr.
  PerfCounter(std::uint32_t type, std::uint64_t config);
  PerfCounter(const PerfCounter&) = delete;
  PerfCounter& operator=(const PerfCounter&) = delete;
  ~PerfCounter();

  /// None if the machine has no such counter or forbids it, as many virtual machines do.
  std::optional<std::int64_t> count() const;

 private:
  int file_;
};

/// Instructions retired.
class InstructionCount : public PerfCounter {
 public:
  InstructionCount();
};

}  // namespace sipplab::bench
