// The 2^k neighbourhoods of a cell, k = 2..5: 4, 8, 16 or 32 straight moves.
// Rivera, Hernandez and Baier, AAAI 2017.
#pragma once

#include <algorithm>
#include <cstdint>
#include <cstdlib>
#include <numbers>
#include <span>

#include "sipplab/grid_map.hpp"

namespace sipplab {

inline constexpr int kMinConnectedness = 2;
inline constexpr int kMaxConnectedness = 5;

/// Displacements to the 2^k neighbours; those of a smaller k, which are shorter, come
/// first. REQUIRES: kMinConnectedness <= k <= kMaxConnectedness.
std::span<const Cell> neighbourhood(int k);

/// neighbourhood_distance() over 16 or 32 neighbours for a displacement of (x, y), x >= y >= 0.
double distance_in_sectors(std::int64_t x, std::int64_t y, int k);

/// Length of the shortest path over the 2^k neighbourhood on an empty grid, in cells:
/// Manhattan, octile, and so on. 0 if from == to.
inline double neighbourhood_distance(Cell from, Cell to, int k) {
  const std::int64_t x = std::abs(static_cast<std::int64_t>(to.x) - from.x);
  const std::int64_t y = std::abs(static_cast<std::int64_t>(to.y) - from.y);
  if (k == 2) return static_cast<double>(x + y);
  const std::int64_t shorter = std::min(x, y);
  const std::int64_t longer = std::max(x, y);
  if (k > 3) return distance_in_sectors(longer, shorter, k);
  return static_cast<double>(longer - shorter) + static_cast<double>(shorter) * std::numbers::sqrt2;
}

}  // namespace sipplab
