// How much memory this process has taken.
#pragma once

#include <cstdint>
#include <optional>

namespace sipplab::bench {

/// The most memory that the process had at one time, from a moment on. Linux alone can begin
/// anew, by /proc/self/clear_refs; elsewhere nothing is measured. A later one begins anew for
/// those before it, too. Some microseconds.
class PeakMemory {
 public:
  /// Begins now.
  PeakMemory();
  /// Resident bytes, with all that the process held before; none if nothing was measured.
  std::optional<std::int64_t> bytes() const;

 private:
  bool is_measured_ = false;
};

}  // namespace sipplab::bench
