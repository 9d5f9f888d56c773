#include "bench/cli/console.hpp"
#include "db/json_text.hpp"

#include <unistd.h>

#include <cerrno>
#include <csignal>
#include <cstdio>
#include <cstring>
#include <iostream>
#include <string>

namespace sipplab::cli {
namespace {

bool stdout_failed = false;
int stdout_errno = 0;

void remember_failure() {
  if (!stdout_failed) stdout_errno = errno;
  stdout_failed = true;
}

/// Benchmark reporters write to std::cout. Whoever flushes first has the reason of a failure, nobody after.
void flush_stdout() {
  errno = 0;
  std::cout.flush();
  if (!std::cout) remember_failure();
  if (std::fflush(stdout) != 0 || std::ferror(stdout) != 0) remember_failure();
}

std::string on_one_line(std::string_view text) {
  std::string line(text);
  for (char& c : line) {
    if (c == '\n' || c == '\r') c = ' ';
  }
  while (!line.empty() && line.back() == ' ') line.pop_back();
  return line;
}

}  // namespace

void print(std::string_view text) {
  if (stdout_failed) return;
  flush_stdout();
  if (stdout_failed) return;
  if (std::fwrite(text.data(), 1, text.size(), stdout) != text.size()) remember_failure();
}

void print_json(const nlohmann::ordered_json& json) { print(db::json_text(json)); }

int close_stdout(int code) {
  flush_stdout();
  if (!stdout_failed) return code;
  // Who read it has seen enough, such as `head`. Programs that die of it end so, too.
  if (stdout_errno == EPIPE) return kSignalExitBase + SIGPIPE;
  const std::string reason = stdout_errno != 0 ? std::strerror(stdout_errno) : "write error";
  return fail("sipplab: cannot write to standard output: " + reason);
}

void diagnose(std::string_view line) {
  const std::string text = on_one_line(line) + "\n";
  flush_stdout();  // if both go to one file, lines keep their order
  std::fwrite(text.data(), 1, text.size(), stderr);
}

int fail(int code, std::string_view line) {
  diagnose(line);
  return code;
}

int fail(const std::string& line) { return fail(kBadUsage, line); }

int fail(const InputError& error) { return fail(error.message()); }

int bad_usage(const std::string& line) { return fail("sipplab: " + line); }

bool stderr_is_terminal() { return isatty(STDERR_FILENO) == 1; }

}  // namespace sipplab::cli
