// Under what this process writes to a sweep, and what it takes: scheduler, limits, processor time, memory.
#pragma once

#include <cstdint>
#include <optional>
#include <string>

#include "db/records.hpp"

namespace sipplab::bench {

/// From the variables of Slurm, SGE, PBS, HTCondor and GNU parallel, the cgroup (version 2, else 1) and the
/// processors that the process may run on. $SIPPLAB_SUBMITTED (seconds since 1970) is when it was submitted.
db::AttemptInfo attempt_info();

/// The place in a job array by those variables; none outside of one.
std::optional<std::string> array_index();

/// What the process has taken, with all children that have ended.
class UsageMeter {
 public:
  /// `peak_bytes`: what a planning took; measuring it begins anew what the system keeps of the process.
  void add_peak(std::int64_t peak_bytes);
  db::AttemptUsage now();

 private:
  std::int64_t peak_bytes_ = 0;
};

}  // namespace sipplab::bench
