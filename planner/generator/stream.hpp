// Independent streams of random numbers, one for each instance of a seed.
#pragma once

#include <bit>
#include <cstdint>

#include "planner/core/random.hpp"

namespace sipplab {

/// What the numbers are for: maps, places of robots, their bodies (sizes, speeds, headings)
/// and moving obstacles have streams of their own in each instance.
enum class StreamUse : std::uint64_t { kRobots = 1, kMap = 2, kBodies = 3, kObstacles = 4 };

/// Seed, index and use are each scrambled before they are joined, because Random
/// would give overlapping states to seeds that differ by a multiple of the step of
/// its own scrambling.
inline Random instance_stream(std::uint64_t seed, std::uint64_t index, StreamUse use) {
  const std::uint64_t seed_bits = Random(seed).next();
  const std::uint64_t index_bits = std::rotl(Random(index).next(), 21);
  const std::uint64_t use_bits = std::rotl(Random(static_cast<std::uint64_t>(use)).next(), 42);
  return Random(seed_bits ^ index_bits ^ use_bits);
}

}  // namespace sipplab
