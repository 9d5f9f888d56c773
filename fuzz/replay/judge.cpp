// Judging by what a child prints before it dies; see judge.hpp.
#include "fuzz/replay/judge.hpp"

#include <fcntl.h>
#include <poll.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <csignal>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <sstream>
#include <string_view>
#include <vector>

#include "fuzz/support/target.hpp"

/// Of the leak sanitizer, where it is there: leaks so far are reported and counted.
extern "C" int __lsan_do_recoverable_leak_check() __attribute__((weak));

namespace sipplab::fuzz {
namespace {

/// Frames that tell one bug from another; those below are common to many.
constexpr std::size_t kFrames = 3;
constexpr int kLeakExitCode = 23;
/// Of a report: what went wrong and the first stack. Below come maps of memory and advice.
constexpr std::size_t kReportLines = 30;

/// What follows `marker` in the line that holds it; empty where none does.
std::string after(const std::string& report, const std::string& marker) {
  const std::size_t at = report.find(marker);
  if (at == std::string::npos) return {};
  const std::size_t begin = at + marker.size();
  return report.substr(begin, report.find('\n', begin) - begin);
}

std::string line_with(const std::string& report, const std::string& marker) {
  const std::size_t at = report.find(marker);
  const std::size_t begin = report.rfind('\n', at) + 1;  // npos + 1 is the beginning
  return report.substr(begin, report.find('\n', at) - begin);
}

/// Numbers say which input it was, not which bug.
std::string without_numbers(const std::string& text) {
  std::string kept;
  for (const char c : text) {
    if (c < '0' || c > '9') {
      kept += c;
    } else if (kept.empty() || kept.back() != 'N') {
      kept += 'N';
    }
  }
  return kept;
}

/// "#3 0x55d0 in sipplab::f(int) /some/planner/io/text.cpp:12:3" gives f; without symbols
/// "#3 0x55d0 (/some/program+0x12)" gives +0x12.
std::string function_of(const std::string& line) {
  const std::size_t in = line.find(" in ");
  if (in == std::string::npos) {
    const std::size_t plus = line.rfind("+0x");
    return plus == std::string::npos ? "" : line.substr(plus, line.find_first_of(") ", plus) - plus);
  }
  bool ours = false;
  for (const char* folder : {"/planner/", "/property_tests/", "/fuzz/"})
    ours |= line.find(folder) != std::string::npos;
  if (!ours || line.find("/fuzz/replay/") != std::string::npos) return "";
  std::string name = line.substr(in + 4);
  constexpr std::string_view kAnonymous = "(anonymous namespace)::";
  for (std::size_t at = name.find(kAnonymous); at != std::string::npos; at = name.find(kAnonymous)) {
    name.erase(at, kAnonymous.size());
  }
  name.resize(std::min(name.find_first_of("(< "), name.size()));
  const std::size_t scope = name.rfind("::");
  if (scope != std::string::npos) name.erase(0, scope + 2);
  return name;
}

std::string frames_of(const std::string& report) {
  std::istringstream lines(report);
  std::string frames;
  std::size_t found = 0;
  bool begun = false;
  for (std::string line; std::getline(lines, line) && found < kFrames;) {
    const std::size_t number = line.find_first_not_of(' ');
    const bool is_frame = number != std::string::npos && line[number] == '#';
    if (begun && !is_frame) break;  // only the first stack: where it happened
    begun = begun || is_frame;
    if (!is_frame) continue;
    const std::string name = function_of(line);
    if (name.empty()) continue;
    frames += (found++ == 0 ? "" : " < ") + name;
  }
  return frames;
}

std::string first_lines(const std::string& report) {
  std::istringstream lines(report);
  std::string kept;
  std::size_t count = 0;
  for (std::string line; count < kReportLines && std::getline(lines, line); ++count) kept += line + '\n';
  return kept;
}

struct Child {
  std::string report;
  int status = 0;
  bool timed_out = false;
  long memory_kib = 0;
};

[[noreturn]] void run_child(const std::string& input, int report) {
  dup2(report, STDERR_FILENO);
  const int nowhere = open("/dev/null", O_WRONLY);
  dup2(nowhere, STDOUT_FILENO);
  // On the heap and without slack, so that a read beyond its end is seen.
  const std::vector<std::uint8_t> bytes(input.begin(), input.end());
  LLVMFuzzerTestOneInput(bytes.data(), bytes.size());
  const bool leaks = __lsan_do_recoverable_leak_check != nullptr && __lsan_do_recoverable_leak_check() != 0;
  _exit(leaks ? kLeakExitCode : 0);
}

Child run(const std::string& input) {
  Child child;
  int ends[2];
  if (pipe2(ends, O_CLOEXEC) != 0) {
    std::perror("pipe");
    std::exit(2);
  }
  std::fflush(nullptr);
  const pid_t pid = fork();
  if (pid < 0) {
    std::perror("fork");
    std::exit(2);
  }
  if (pid == 0) run_child(input, ends[1]);
  close(ends[1]);
  // Its reports end when the child does; a child that is silent for too long is stuck.
  char buffer[4096];
  for (pollfd readable{ends[0], POLLIN, 0};;) {
    const int ready = poll(&readable, 1, kTimeoutS * 1000);
    if (ready == 0) {
      child.timed_out = true;
      kill(pid, SIGKILL);
    }
    const ssize_t got = read(ends[0], buffer, sizeof buffer);
    if (got <= 0) break;
    child.report.append(buffer, static_cast<std::size_t>(got));
  }
  close(ends[0]);
  rusage usage{};
  wait4(pid, &child.status, 0, &usage);
  child.memory_kib = usage.ru_maxrss;
  return child;
}

}  // namespace

Judgement read_report(const std::string& report, const std::string& how) {
  Judgement judgement{true, "crash", how, "", how};
  if (const std::string claim = after(report, "broken claim: "); !claim.empty()) {
    return {true, "claim", claim.substr(0, claim.find(": ")), "", "broken claim: " + claim};
  }
  if (const std::string condition = after(report, "broken invariant: "); !condition.empty()) {
    return {true, "invariant", condition, "", "broken invariant: " + condition};
  }
  judgement.frames = frames_of(report);
  if (const std::string error = after(report, "runtime error: "); !error.empty()) {
    judgement.kind = "sanitizer";
    judgement.claim = without_numbers(error);
    judgement.message = line_with(report, "runtime error: ");
  } else if (report.find("ERROR: LeakSanitizer") != std::string::npos) {
    judgement.kind = "leak";
    judgement.claim = "memory is not freed";
    judgement.message = after(report, "ERROR: LeakSanitizer: ");
  } else if (const std::string summary = after(report, "ERROR: AddressSanitizer: "); !summary.empty()) {
    judgement.kind = "sanitizer";
    judgement.claim = summary.substr(0, summary.find_first_of(" \n"));
    judgement.message = "AddressSanitizer: " + summary.substr(0, summary.find(" on address"));
  } else if (const std::string assertion = after(report, "Assertion '"); !assertion.empty()) {
    judgement.kind = "invariant";
    judgement.claim = assertion.substr(0, assertion.find('\''));
    judgement.message = "Assertion '" + assertion;
  } else if (const std::string thrown = after(report, "terminate called after throwing an instance of ");
             !thrown.empty()) {
    judgement.claim = "exception " + thrown;
    judgement.message = judgement.claim;
  }
  return judgement;
}

Judgement judge(const std::string& input) {
  const Child child = run(input);
  if (child.timed_out) {
    return {true, "timeout", "too slow", "", "no end after " + std::to_string(kTimeoutS) + " s"};
  }
  if (child.memory_kib > kMemoryLimitKib) {
    return {true, "memory", "too much memory", "", std::to_string(child.memory_kib) + " KiB of memory"};
  }
  if (WIFEXITED(child.status) && WEXITSTATUS(child.status) == 0) return {};
  const std::string how = WIFSIGNALED(child.status)
                              ? std::string("signal ") + strsignal(WTERMSIG(child.status))
                              : "exit code " + std::to_string(WEXITSTATUS(child.status));
  Judgement judgement = read_report(child.report, how);
  judgement.report = first_lines(child.report);
  return judgement;
}

}  // namespace sipplab::fuzz
