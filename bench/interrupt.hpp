// Ctrl-C: the first one asks the sweep to end after the instance at hand, the second
// ends the program at once.
#pragma once

#include <atomic>
#include <string_view>

namespace sipplab::bench {

inline constexpr std::string_view kEndsAfterInstance =
    "\nsipplab: ending after this instance; once more to end at once\n";

/// SIGINT and SIGTERM from now on set the flags below, and say `line` on stderr, which must
/// live as long as the program.
void catch_interrupts(std::string_view line = kEndsAfterInstance);

/// The signal that arrived, or 0.
int interrupted_by();

/// Whether one arrived, for limits that poll it.
const std::atomic<bool>& interrupt_flag();

}  // namespace sipplab::bench
