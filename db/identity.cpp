// UUIDs from the system's random device; processes as Linux describes them in /proc.
#include "db/identity.hpp"

#include <fmt/core.h>
#include <unistd.h>

#include <array>
#include <chrono>
#include <cstdint>
#include <ctime>
#include <fstream>
#include <iterator>
#include <random>
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

std::string new_uuid() {
  std::random_device device;
  std::array<std::uint32_t, 4> words{};
  for (std::uint32_t& word : words) word = device();
  words[1] = (words[1] & 0xffff0fffU) | 0x00004000U;  // version 4
  words[2] = (words[2] & 0x3fffffffU) | 0x80000000U;  // variant of RFC 4122
  return fmt::format("{:08x}-{:04x}-{:04x}-{:04x}-{:04x}{:08x}", words[0], words[1] >> 16, words[1] & 0xffffU,
                     words[2] >> 16, words[2] & 0xffffU, words[3]);
}

std::string utc_now() {
  using namespace std::chrono;
  const auto now = system_clock::now();
  const std::time_t seconds_now = system_clock::to_time_t(now);
  const auto ms = duration_cast<milliseconds>(now.time_since_epoch()).count() % 1000;
  std::tm utc{};
  gmtime_r(&seconds_now, &utc);
  return fmt::format("{:04}-{:02}-{:02}T{:02}:{:02}:{:02}.{:03}Z", utc.tm_year + 1900, utc.tm_mon + 1,
                     utc.tm_mday, utc.tm_hour, utc.tm_min, utc.tm_sec, ms);
}

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

}  // namespace sipplab::db
