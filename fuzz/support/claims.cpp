// Claims and counts; see claims.hpp.
#include "fuzz/support/claims.hpp"

#include <fcntl.h>
#include <sys/mman.h>
#include <unistd.h>

#include <array>
#include <cstdio>
#include <cstdlib>
#include <cstring>

#include "bench/campaigns/counts.hpp"

namespace sipplab::fuzz {
namespace {

constexpr std::array<std::string_view, kClaims> kClaimNames = {
    "refusal is one line",      "reads back equal",
    "reads what it says",       "memory in proportion",
    "result is whole",          "plan is valid",
    "plan is certified",        "costs are arrivals",
    "same input same plan",     "final order explains plan",
    "unreachable is unsolved",  "lone robot is exact",
    "re-scheduling loses none", "last robot at zero",
    "last goal is free",        "budget is kept",
    "trace follows rules",      "verdict is invariant",
    "planted defect is found",  "closed form is right",
    "sight is exact",           "twins agree",
    "complete is complete",     "improvement is no worse",
};
constexpr std::array<std::string_view, kEvents> kEventNames = {
    "inputs",           "accepted",  "refused",      "valid instances", "two robots", "solved",
    "failed",           "limited",   "rescheduled",  "deterministic",   "random",     "any-angle",
    "starts protected", "obstacles", "mixed bodies", "comparisons",
};
constexpr std::size_t kCounts = kClaims + kEvents;
// The compilers' own functions: libc++ before version 19 has no std::atomic_ref.
static_assert(__atomic_always_lock_free(sizeof(std::uint64_t), nullptr));

/// Rows of the file that the environment variable names, else in memory of this process alone.
CountRow* map_rows() {
  static std::array<CountRow, kCounts> own{};
  const char* path = std::getenv(kCountsVariable);
  if (path == nullptr || *path == '\0') return own.data();
  const int file = open(path, O_RDWR | O_CREAT | O_CLOEXEC, 0644);
  if (file < 0) return own.data();
  void* mapped = MAP_FAILED;
  if (ftruncate(file, static_cast<off_t>(sizeof own)) == 0) {
    mapped = mmap(nullptr, sizeof own, PROT_READ | PROT_WRITE, MAP_SHARED, file, 0);
  }
  close(file);
  return mapped == MAP_FAILED ? own.data() : static_cast<CountRow*>(mapped);
}

/// Every process of a run writes the same names.
CountRow* named_rows() {
  CountRow* const rows = map_rows();
  for (std::size_t i = 0; i < kCounts; ++i) {
    const bool is_claim = i < kClaims;
    const std::string_view text = is_claim ? kClaimNames[i] : kEventNames[i - kClaims];
    std::strcpy(rows[i].kind.data(), is_claim ? "claim" : "event");
    text.copy(rows[i].name.data(), rows[i].name.size() - 1);
  }
  return rows;
}

void add_one(std::size_t index) {
  static CountRow* const rows = named_rows();
  __atomic_fetch_add(&rows[index].count, 1, __ATOMIC_RELAXED);
}

}  // namespace

std::string_view name(Claim claim) { return kClaimNames[static_cast<std::size_t>(claim)]; }
std::string_view name(Event event) { return kEventNames[static_cast<std::size_t>(event)]; }

void count(Event event) { add_one(kClaims + static_cast<std::size_t>(event)); }

void require(Claim claim, bool condition, const char* detail) {
  add_one(static_cast<std::size_t>(claim));
  if (condition) return;
  std::fprintf(stderr, "broken claim: %s: %s\n", name(claim).data(), detail);
  std::abort();
}

void require(Claim claim, bool condition, const std::string& detail) {
  require(claim, condition, detail.c_str());
}

}  // namespace sipplab::fuzz
