// The 2^k neighbourhoods of a cell, k = 2..5: 4, 8, 16 or 32 straight moves.
// Rivera, Hernandez and Baier, AAAI 2017.
#pragma once

#include <span>

#include "sipplab/grid_map.hpp"

namespace sipplab {

inline constexpr int kMinConnectedness = 2;
inline constexpr int kMaxConnectedness = 5;

/// Displacements to the 2^k neighbours; those of a smaller k, which are shorter, come
/// first. REQUIRES: kMinConnectedness <= k <= kMaxConnectedness.
std::span<const Cell> neighbourhood(int k);

/// Length of the shortest path over the 2^k neighbourhood on an empty grid, in cells:
/// Manhattan, octile, and so on. 0 if from == to.
double neighbourhood_distance(Cell from, Cell to, int k);

}  // namespace sipplab
