// How much memory this process takes for something, whatever it held before.
#pragma once

#include <cstdint>
#include <optional>

namespace sipplab::bench {

/// The most memory that the process had at one time, from a moment on. Linux alone can begin
/// anew, by /proc/self/clear_refs; elsewhere nothing is measured. A later one begins anew for
/// those before it, too. Returns to the system what was freed: what follows takes pages anew.
class PeakMemory {
 public:
  /// Begins now.
  PeakMemory();
  /// Forgets the peak, and not what the process held when it began: for the next of several plannings, which
  /// take what those before gave back and so cost no time for pages.
  void restart();
  /// Resident bytes beyond what the process held when it began; none if nothing was measured.
  std::optional<std::int64_t> bytes() const;

 private:
  bool is_measured_ = false;
  std::int64_t before_bytes_ = 0;
};

}  // namespace sipplab::bench
