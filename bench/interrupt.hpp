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

/// The same, and SIGUSR1, by which a scheduler says beforehand that time runs out: like SIGINT it asks for
/// the end after what is at hand. SIGTERM sets hurry_flag(), too: what is at hand is to be given up. A second
/// one of either does no more.
void catch_warnings();

/// Whether SIGTERM arrived after catch_warnings().
const std::atomic<bool>& hurry_flag();

/// The signal that arrived, or 0.
int interrupted_by();

/// Whether one arrived, for limits that poll it.
const std::atomic<bool>& interrupt_flag();

}  // namespace sipplab::bench
