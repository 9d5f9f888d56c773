#include "bench/sweep/interrupt.hpp"

#include <signal.h>
#include <unistd.h>

#include <string_view>

namespace sipplab::bench {
namespace {

volatile sig_atomic_t caught = 0;

void remember(int signal_number) {
  caught = signal_number;
  constexpr std::string_view kLine = "\nsipplab: ending after this instance; once more to end at once\n";
  // Nothing can be done here about a stderr that is closed.
  if (write(STDERR_FILENO, kLine.data(), kLine.size()) < 0) return;
}

}  // namespace

void catch_interrupts() {
  struct sigaction action = {};
  action.sa_handler = remember;
  action.sa_flags = static_cast<int>(SA_RESETHAND | SA_RESTART);  // the second signal has its default effect
  sigemptyset(&action.sa_mask);
  sigaction(SIGINT, &action, nullptr);
  sigaction(SIGTERM, &action, nullptr);
}

int interrupted_by() { return static_cast<int>(caught); }

}  // namespace sipplab::bench
