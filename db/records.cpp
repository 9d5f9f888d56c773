// Names of states, and the fingerprint of a machine.
#include "db/records.hpp"

#include <fmt/core.h>

namespace sipplab::db {

std::string fingerprint(const MachineInfo& machine) {
  // FNV-1a, 64 bits: the fields are few and no attacker chooses them. The separator keeps
  // neighbouring fields apart.
  constexpr std::uint64_t kOffsetBasis = 14695981039346656037ULL;
  constexpr std::uint64_t kPrime = 1099511628211ULL;
  const std::string text = fmt::format("{}\n{}\n{}\n{}\n{}", machine.host, machine.cpu_model, machine.cores,
                                       machine.memory_bytes, machine.kernel);
  std::uint64_t hash = kOffsetBasis;
  for (const char c : text) {
    hash ^= static_cast<unsigned char>(c);
    hash *= kPrime;
  }
  return fmt::format("{:016x}", hash);
}

std::string_view name(ResultStatus status) {
  constexpr std::string_view kNames[] = {"solved", "failed", "limit", "invalid"};
  return kNames[static_cast<std::size_t>(status)];
}

std::string_view name(RunStatus status) {
  constexpr std::string_view kNames[] = {"running", "finished", "aborted"};
  return kNames[static_cast<std::size_t>(status)];
}

}  // namespace sipplab::db
