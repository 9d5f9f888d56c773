#include "bench/process_tree.hpp"

#include <dirent.h>
#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <fstream>
#include <memory>
#include <sstream>
#include <string>
#include <vector>

#include "planner/core/number.hpp"

namespace sipplab::bench {
namespace {

struct Process {
  pid_t id = 0;
  pid_t parent = 0;
  pid_t group = 0;
  std::uint64_t pages = 0;
};

/// proc(5): "pid (name) state ppid pgrp ...", resident pages as field 24. The name may hold blanks and
/// brackets.
bool read_process(const std::string& id, Process& process) {
  std::ifstream file("/proc/" + id + "/stat");
  std::string line;
  if (!std::getline(file, line)) return false;
  const std::size_t name_end = line.rfind(')');
  if (name_end == std::string::npos) return false;
  std::istringstream fields(line.substr(name_end + 1));
  std::string skipped;
  fields >> skipped >> process.parent >> process.group;
  constexpr int kSkipped = 18;  // fields 6 to 23
  for (int i = 0; i < kSkipped; ++i) fields >> skipped;
  process.id = parse_number<pid_t>(id).value_or(0);
  return static_cast<bool>(fields >> process.pages);
}

std::vector<Process> all_processes() {
  std::vector<Process> found;
  const std::unique_ptr<DIR, int (*)(DIR*)> folder(opendir("/proc"), closedir);
  while (const dirent* entry = folder ? readdir(folder.get()) : nullptr) {
    Process process;
    const std::string name = entry->d_name;
    if (name.find_first_not_of("0123456789") == std::string::npos && read_process(name, process)) {
      found.push_back(process);
    }
  }
  return found;
}

/// Its part of the pages that it shares, where the kernel tells; else all of them.
std::uint64_t proportional_bytes(const Process& process, std::uint64_t otherwise) {
  std::ifstream file(fmt::format("/proc/{}/smaps_rollup", process.id));
  constexpr std::uint64_t kBytesPerKib = 1024;
  std::string word;
  std::uint64_t kib = 0;
  while (file >> word) {
    if (word == "Pss:" && file >> kib) return kib * kBytesPerKib;
  }
  return otherwise;
}

}  // namespace

std::uint64_t resident_bytes(pid_t program, std::uint64_t limit_bytes) {
  std::vector<Process> others = all_processes();
  std::vector<Process> members;
  const auto is_member = [&](const Process& process) {
    return process.id == program || process.group == program ||
           std::any_of(members.begin(), members.end(),
                       [&](const Process& member) { return member.id == process.parent; });
  };
  for (std::size_t before = others.size() + 1; others.size() < before;) {
    before = others.size();
    const auto rest = std::stable_partition(others.begin(), others.end(), is_member);
    members.insert(members.end(), others.begin(), rest);
    others.erase(others.begin(), rest);
  }
  const auto page_bytes = static_cast<std::uint64_t>(sysconf(_SC_PAGESIZE));
  std::uint64_t bytes = 0;
  for (const Process& member : members) bytes += member.pages * page_bytes;
  if (bytes <= limit_bytes) return bytes;
  bytes = 0;
  for (const Process& member : members) bytes += proportional_bytes(member, member.pages * page_bytes);
  return bytes;
}

}  // namespace sipplab::bench
