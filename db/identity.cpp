// Processes as Linux describes them in /proc.
#include "db/identity.hpp"

#include <fmt/core.h>
#include <stdlib.h>  // getloadavg is no part of C++
#include <unistd.h>

#include <fstream>
#include <iterator>
#include <sstream>
#include <utility>

namespace sipplab::db {
namespace {

std::string read_all(const std::string& path) {
  std::ifstream file{path};
  return {std::istreambuf_iterator<char>{file}, std::istreambuf_iterator<char>{}};
}

std::string boot_id() {
  std::istringstream text{read_all("/proc/sys/kernel/random/boot_id")};
  std::string id;
  text >> id;
  return id;
}

// Field 22 of /proc/PID/stat, in clock ticks since boot: two processes that had the
// same number one after the other differ in it. Field 2 is a name that may contain
// spaces and parentheses, so fields are counted from its end. Field 3 is the state: one that
// has ended and waits for its parent to ask how (Z), or is being removed (X), starts nothing more.
std::string start_time(const std::string& pid) {
  const std::string stat = read_all("/proc/" + pid + "/stat");
  const std::size_t name_end = stat.rfind(')');
  if (name_end == std::string::npos) return {};
  constexpr int kFieldsFromName = 20;
  std::istringstream fields{stat.substr(name_end + 1)};
  std::string field;
  for (int i = 0; i < kFieldsFromName; ++i) {
    fields >> field;
    if (i == 0 && (field == "Z" || field == "X")) return {};
  }
  return fields ? field : std::string{};
}

}  // namespace

std::string this_process() {
  // Asked for at every case, read once: a process keeps its name until it forks.
  static thread_local std::pair<pid_t, std::string> known{0, {}};
  if (known.first == getpid()) return known.second;
  const std::string pid = fmt::format("{}", getpid());
  const std::string boot = boot_id();
  const std::string start = start_time(pid);
  known = {getpid(), boot.empty() || start.empty() ? pid : boot + ' ' + pid + ' ' + start};
  return known.second;
}

bool is_alive(std::string_view process) {
  std::istringstream parts{std::string{process}};
  std::string boot;
  std::string pid;
  std::string start;
  parts >> boot >> pid >> start;
  return !start.empty() && boot == boot_id() && start == start_time(pid);
}

std::optional<double> machine_load() {
  double load = 0;
  if (getloadavg(&load, 1) != 1) return std::nullopt;
  return load;
}

}  // namespace sipplab::db
