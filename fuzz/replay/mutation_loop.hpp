// A fuzzer of a hundred lines: no feedback, but everywhere, and the same inputs every time.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

namespace sipplab::fuzz {

/// Longest input that is made, as libFuzzer is told. Cases of the mutator's bounds take
/// less than 1,500 bytes, texts of every kind of part and error less than that.
inline constexpr std::size_t kMaxInputBytes = 4096;

/// Runs the target on `count` mutations of the seeds and of inputs made from them. The same
/// arguments give the same inputs. A broken claim ends the process; the input that did it
/// is printed to stderr and, if `keep_in` is not empty, written to that file.
void run_mutations(const std::vector<std::string>& seeds, std::size_t count, std::uint64_t seed,
                   const std::string& keep_in);

}  // namespace sipplab::fuzz
