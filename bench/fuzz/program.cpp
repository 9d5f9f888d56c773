#include "bench/fuzz/program.hpp"

#include <fcntl.h>
#include <poll.h>
#include <spawn.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <csignal>
#include <string_view>

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

/// Reads until the writer ends; false where that takes longer than the limit.
bool read_all(int file, Clock::time_point deadline, std::string& output) {
  char buffer[4096];
  for (;;) {
    const auto left = std::chrono::duration_cast<std::chrono::milliseconds>(deadline - Clock::now()).count();
    if (left <= 0) return false;
    // A day at a time: poll counts in int.
    constexpr long long kMostMs = 86'400'000;
    pollfd readable{file, POLLIN, 0};
    if (poll(&readable, 1, static_cast<int>(std::min<long long>(left, kMostMs))) == 0) continue;
    const ssize_t got = read(file, buffer, sizeof buffer);
    if (got <= 0) return true;
    output.append(buffer, static_cast<std::size_t>(got));
  }
}

double seconds_of(const timeval& time) {
  constexpr double kSecondsPerMicrosecond = 1e-6;
  return static_cast<double>(time.tv_sec) + static_cast<double>(time.tv_usec) * kSecondsPerMicrosecond;
}

}  // namespace

ProgramRun run_program(const std::vector<std::string>& command, const std::vector<std::string>& environment,
                       const std::filesystem::path& log, double limit_s) {
  ProgramRun run;
  int ends[2];
  if (pipe2(ends, O_CLOEXEC) != 0) return run;
  std::vector<std::string> arguments = command;
  std::vector<std::string> variables = merged_environment(environment);
  posix_spawn_file_actions_t actions;
  posix_spawn_file_actions_init(&actions);
  posix_spawn_file_actions_adddup2(&actions, ends[1], STDOUT_FILENO);
  posix_spawn_file_actions_addopen(&actions, STDERR_FILENO, log.c_str(), O_WRONLY | O_CREAT | O_APPEND, 0644);
  pid_t child = 0;
  const int failed = posix_spawn(&child, arguments[0].c_str(), &actions, nullptr,
                                 pointers_to(arguments).data(), pointers_to(variables).data());
  posix_spawn_file_actions_destroy(&actions);
  close(ends[1]);
  if (failed == 0) {
    const auto limit = std::chrono::duration_cast<Clock::duration>(std::chrono::duration<double>(limit_s));
    run.timed_out = !read_all(ends[0], Clock::now() + limit, run.output);
    if (run.timed_out) kill(child, SIGKILL);
    int status = 0;
    rusage usage{};
    run.started = wait4(child, &status, 0, &usage) == child;
    run.cpu_time_s = seconds_of(usage.ru_utime) + seconds_of(usage.ru_stime);
    if (WIFEXITED(status)) run.exit_code = WEXITSTATUS(status);
  }
  close(ends[0]);
  return run;
}

}  // namespace sipplab::bench
