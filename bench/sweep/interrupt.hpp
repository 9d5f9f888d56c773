// Ctrl-C: the first one asks the sweep to end after the instance at hand, the second
// ends the program at once.
#pragma once

namespace sipplab::bench {

/// SIGINT and SIGTERM from now on set the flag below.
void catch_interrupts();

/// The signal that arrived, or 0.
int interrupted_by();

}  // namespace sipplab::bench
