#include "bench/program.hpp"

#include <fcntl.h>
#include <poll.h>
#include <spawn.h>
#include <sys/resource.h>
#include <sys/syscall.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <chrono>
#include <cmath>
#include <csignal>
#include <string_view>

#include "bench/process_tree.hpp"

namespace sipplab::bench {
namespace {

using Clock = std::chrono::steady_clock;

/// This process's environment with entries replaced or added.
std::vector<std::string> merged_environment(const std::vector<std::string>& entries) {
  std::vector<std::string> merged = entries;
  for (char** entry = environ; *entry != nullptr; ++entry) {
    const std::string_view text = *entry;
    const std::string_view name = text.substr(0, text.find('=') + 1);
    const auto replaced = [&](const std::string& other) { return other.rfind(name, 0) == 0; };
    if (std::none_of(entries.begin(), entries.end(), replaced)) merged.emplace_back(text);
  }
  return merged;
}

std::vector<char*> pointers_to(std::vector<std::string>& texts) {
  std::vector<char*> pointers;
  for (std::string& text : texts) pointers.push_back(text.data());
  pointers.push_back(nullptr);
  return pointers;
}

/// While a program runs, this often somebody may say that it shall end.
constexpr std::chrono::milliseconds kGiveUpInterval{100};
/// Where the system gives no descriptor of a process to wait for.
constexpr std::chrono::milliseconds kPollInterval{2};
/// Bytes a second: what programs of some threads touch on machines of today. Memory is looked at when it
/// could be at its limit by that, and no more often than this: a look takes a millisecond or two.
constexpr double kFastestGrowth = 8.0 * (std::uint64_t{1} << 30);
constexpr std::chrono::milliseconds kMemoryInterval{5};
constexpr std::size_t kMostOutputBytes = std::size_t{64} << 20;

/// Appends what can be read now; false at the end of the file.
bool read_some(int file, std::string& output) {
  char buffer[4096];
  const ssize_t got = read(file, buffer, sizeof buffer);
  if (got < 0) return errno == EINTR || errno == EAGAIN;
  if (output.size() < kMostOutputBytes) output.append(buffer, static_cast<std::size_t>(got));
  return got > 0;
}

/// Whether the child has ended; it stays to be waited for.
bool has_ended(pid_t child) {
  siginfo_t info{};
  return waitid(P_PID, static_cast<id_t>(child), &info, WEXITED | WNOHANG | WNOWAIT) == 0 &&
         info.si_pid == child;
}

/// Looks at the memory of a program in time.
class MemoryWatch {
 public:
  MemoryWatch(pid_t program, std::uint64_t limit_bytes) : program_(program), limit_bytes_(limit_bytes) {}

  /// The bytes beyond the limit that are held, or 0. Does nothing before time_left() is over.
  std::uint64_t exceeded() {
    if (limit_bytes_ == 0 || Clock::now() < next_) return 0;
    const std::uint64_t held = resident_bytes(program_, limit_bytes_);
    if (held > limit_bytes_) return held;
    const std::chrono::duration<double> soonest(static_cast<double>(limit_bytes_ - held) / kFastestGrowth);
    next_ = Clock::now() +
            std::max<Clock::duration>(std::chrono::duration_cast<Clock::duration>(soonest), kMemoryInterval);
    return 0;
  }
  std::chrono::duration<double, std::milli> time_left() const {
    return limit_bytes_ == 0 ? Clock::duration::max() : next_ - Clock::now();
  }

 private:
  pid_t program_;
  std::uint64_t limit_bytes_;
  Clock::time_point next_;
};

/// Waits until the process ends, reading what it writes meanwhile, or until its time or memory is up.
void watch(pid_t child, int output, const ProgramOptions& options, ProgramRun& run) {
  // The wrapper of glibc 2.36 has no C linkage.
  const int process = static_cast<int>(syscall(SYS_pidfd_open, child, 0));
  const auto limit = std::chrono::duration<double>(options.limit_s);
  const Clock::time_point begin = Clock::now();
  MemoryWatch memory(child, options.memory_limit_bytes);
  for (;;) {
    const auto left = limit - (Clock::now() - begin);
    run.timed_out = left <= left.zero();
    run.given_up = options.give_up != nullptr && options.give_up();
    if (run.timed_out || run.given_up || has_ended(child)) break;
    if ((run.memory_seen_bytes = memory.exceeded()) > 0) break;
    const auto slice = std::min<std::chrono::duration<double, std::milli>>(
        {left, memory.time_left(), process < 0 ? kPollInterval : kGiveUpInterval});
    pollfd files[] = {{process, POLLIN, 0}, {output, POLLIN, 0}};
    poll(files, 2, std::max(0, static_cast<int>(std::ceil(slice.count()))));
    if (files[1].revents != 0 && !read_some(output, run.output)) output = -1;  // poll leaves out -1
  }
  if (process >= 0) close(process);
  while (output >= 0 && read_some(output, run.output)) {
    pollfd rest{output, POLLIN, 0};
    if (poll(&rest, 1, 0) <= 0) break;  // a child that it left behind holds the other end
  }
}

double seconds_of(const timeval& time) {
  constexpr double kSecondsPerMicrosecond = 1e-6;
  return static_cast<double>(time.tv_sec) + static_cast<double>(time.tv_usec) * kSecondsPerMicrosecond;
}

}  // namespace

ProgramRun run_program(const std::vector<std::string>& command, const ProgramOptions& options) {
  ProgramRun run;
  int ends[2];
  if (pipe2(ends, O_CLOEXEC) != 0) return run;
  fcntl(ends[0], F_SETFL, O_NONBLOCK);
  std::vector<std::string> arguments = command;
  std::vector<std::string> variables = merged_environment(options.environment);
  posix_spawn_file_actions_t actions;
  posix_spawn_file_actions_init(&actions);
  if (!options.log.empty()) {
    posix_spawn_file_actions_addopen(&actions, STDERR_FILENO, options.log.c_str(),
                                     O_WRONLY | O_CREAT | O_APPEND, 0644);
  }
  posix_spawn_file_actions_adddup2(&actions, options.all_to_log ? STDERR_FILENO : ends[1], STDOUT_FILENO);
  if (!options.folder.empty()) posix_spawn_file_actions_addchdir_np(&actions, options.folder.c_str());
  posix_spawnattr_t attributes;
  posix_spawnattr_init(&attributes);
  // Ignored signals stay so in a program that is started, and its pipelines count on this one.
  sigset_t usual;
  sigemptyset(&usual);
  sigaddset(&usual, SIGPIPE);
  posix_spawnattr_setsigdefault(&attributes, &usual);
  const int group = options.own_group ? POSIX_SPAWN_SETPGROUP : 0;  // group 0: its own
  posix_spawnattr_setflags(&attributes, static_cast<short>(POSIX_SPAWN_SETSIGDEF | group));
  const Clock::time_point begin = Clock::now();
  pid_t child = 0;
  const int failed = posix_spawn(&child, arguments[0].c_str(), &actions, &attributes,
                                 pointers_to(arguments).data(), pointers_to(variables).data());
  posix_spawnattr_destroy(&attributes);
  posix_spawn_file_actions_destroy(&actions);
  close(ends[1]);
  if (failed == 0) {
    watch(child, ends[0], options, run);
    run.wall_time_s = std::chrono::duration<double>(Clock::now() - begin).count();
    if (run.timed_out || run.given_up || run.memory_seen_bytes > 0) kill(child, SIGKILL);
    if (options.own_group) kill(-child, SIGKILL);
    int status = 0;
    rusage usage{};
    while ((run.started = wait4(child, &status, 0, &usage) == child) == false && errno == EINTR) {
    }
    run.cpu_time_s = seconds_of(usage.ru_utime) + seconds_of(usage.ru_stime);
    run.peak_memory_bytes = std::int64_t{usage.ru_maxrss} * 1024;  // it counts in KiB
    if (WIFEXITED(status)) run.exit_code = WEXITSTATUS(status);
    if (WIFSIGNALED(status)) run.signal = WTERMSIG(status);
  }
  close(ends[0]);
  return run;
}

}  // namespace sipplab::bench
