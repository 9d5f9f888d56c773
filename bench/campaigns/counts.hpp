// The file in which a fuzz target counts what it did: one row for each thing that it counts. All processes of
// a run map it into memory and add to the same numbers, so that one which crashes loses none.
#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <vector>

namespace sipplab::fuzz {

/// The environment variable that names the file.
inline constexpr const char* kCountsVariable = "SIPPLAB_FUZZ_COUNTS";

/// A row as its bytes are in the file. Texts are filled up with zeros, one of them at least.
struct CountRow {
  std::array<char, 8> kind{};   ///< "claim" or "event"
  std::array<char, 48> name{};  ///< such as "plan is valid"
  std::uint64_t count = 0;
};
static_assert(sizeof(CountRow) == 64);

/// A count by name, such as {"event", "inputs", 12}.
struct Count {
  std::string kind;
  std::string name;
  std::uint64_t count = 0;
};

/// What was counted at least once; empty if there is no such file.
std::vector<Count> read_counts(const std::string& path);

}  // namespace sipplab::fuzz
