// Seeded random numbers that are the same on every compiler and standard
// library: xoshiro256** (Blackman and Vigna 2021) seeded through splitmix64.
// The distributions of <random> are not used because they differ between
// libraries.
#pragma once

#include <array>
#include <bit>
#include <cstdint>
#include <utility>
#include <vector>

#include "sipplab/error.hpp"

namespace sipplab {

class Random {
 public:
  explicit Random(std::uint64_t seed) {
    for (std::uint64_t& word : state_) {
      seed += 0x9e3779b97f4a7c15u;
      std::uint64_t z = seed;
      z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9u;
      z = (z ^ (z >> 27)) * 0x94d049bb133111ebu;
      word = z ^ (z >> 31);
    }
  }

  /// Uniform over all 64-bit values.
  std::uint64_t next() {
    const std::uint64_t result = std::rotl(state_[1] * 5, 7) * 9;
    const std::uint64_t shifted = state_[1] << 17;
    state_[2] ^= state_[0];
    state_[3] ^= state_[1];
    state_[1] ^= state_[2];
    state_[0] ^= state_[3];
    state_[2] ^= shifted;
    state_[3] = std::rotl(state_[3], 45);
    return result;
  }

  /// True once in `n` draws. REQUIRES: n > 0.
  bool one_in(std::uint64_t n) { return below(n) == 0; }

  /// Uniform over 0 .. bound - 1, without bias. REQUIRES: bound > 0.
  std::uint64_t below(std::uint64_t bound) {
    PLANNER_ASSERT(bound > 0);
    const std::uint64_t unbiased_from = (0 - bound) % bound;
    std::uint64_t draw = next();
    while (draw < unbiased_from) draw = next();
    return draw % bound;
  }

  /// Uniform over [0, 1) in steps of 2^-53.
  double unit() { return static_cast<double>(next() >> 11) * 0x1.0p-53; }

  /// Fisher-Yates.
  template <class T>
  void shuffle(std::vector<T>& items) {
    for (std::size_t left = items.size(); left > 1; --left) {
      std::swap(items[left - 1], items[static_cast<std::size_t>(below(left))]);
    }
  }

 private:
  std::array<std::uint64_t, 4> state_{};
};

}  // namespace sipplab
