#include "bench/interrupt.hpp"

#include <signal.h>
#include <unistd.h>

namespace sipplab::bench {
namespace {

volatile sig_atomic_t caught = 0;
std::atomic<bool> was_caught{false};
static_assert(std::atomic<bool>::is_always_lock_free);  // or a handler may not set it
std::atomic<bool> in_a_hurry{false};
bool warned = false;
std::string_view said;

void remember(int signal_number) {
  caught = signal_number;
  was_caught = true;
  if (warned && signal_number == SIGTERM) in_a_hurry = true;
  // Nothing can be done here about a stderr that is closed.
  if (write(STDERR_FILENO, said.data(), said.size()) < 0) return;
}

}  // namespace

void catch_interrupts(std::string_view line) {
  said = line;
  struct sigaction action = {};
  action.sa_handler = remember;
  action.sa_flags = static_cast<int>(SA_RESETHAND | SA_RESTART);  // the second signal has its default effect
  sigemptyset(&action.sa_mask);
  sigaction(SIGINT, &action, nullptr);
  sigaction(SIGTERM, &action, nullptr);
}

void catch_warnings() {
  catch_interrupts();
  warned = true;
  struct sigaction action = {};
  action.sa_handler = remember;
  action.sa_flags = static_cast<int>(SA_RESTART);
  sigemptyset(&action.sa_mask);
  // Schedulers send some of them to every process of a job, and these hand them on to each other.
  sigaction(SIGUSR1, &action, nullptr);
  sigaction(SIGTERM, &action, nullptr);
}

const std::atomic<bool>& hurry_flag() { return in_a_hurry; }

int interrupted_by() { return static_cast<int>(caught); }

const std::atomic<bool>& interrupt_flag() { return was_caught; }

}  // namespace sipplab::bench
