// What a target offers to the program that runs it: libFuzzer, AFL++, or the replay program. The
// names and signatures are libFuzzer's.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string_view>

extern "C" {
/// One input. 0: it may enter the corpus; -1: it is not to.
int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size);

/// Changes an input in place; targets of cases have one, for the others it is null.
std::size_t LLVMFuzzerCustomMutator(std::uint8_t* data, std::size_t size, std::size_t max_size, unsigned seed)
    __attribute__((weak));
std::size_t LLVMFuzzerCustomCrossOver(const std::uint8_t* one, std::size_t one_size,
                                      const std::uint8_t* other, std::size_t other_size, std::uint8_t* out,
                                      std::size_t max_size, unsigned seed) __attribute__((weak));

/// Changes bytes without knowing what they mean; part of the program that runs the target.
std::size_t LLVMFuzzerMutate(std::uint8_t* data, std::size_t size, std::size_t max_size);
}

namespace sipplab::fuzz {

inline std::string_view text_of(const std::uint8_t* data, std::size_t size) {
  return {reinterpret_cast<const char*>(data), size};
}

}  // namespace sipplab::fuzz
