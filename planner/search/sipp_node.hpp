// A state of SIPP: a cell and one of its safe intervals, with the earliest known
// arrival. [PL11], section III.
#pragma once

#include <cstdint>

#include "planner/geometry/interval.hpp"
#include "planner/grid/cell.hpp"

namespace sipplab {

/// Nodes live in one vector and point to each other by index.
using NodeId = std::uint32_t;
inline constexpr NodeId kNoNode = UINT32_MAX;

struct SippNode {
  SafeInterval interval;
  double arrival_s = kForever;  ///< earliest known; kForever: not reached yet
  double departure_s = 0;       ///< when the parent is left to arrive then
  double to_goal_s = 0;         ///< the heuristic: at most the time by steps from here to the goal, weighted
  Cell cell;
  NodeId parent = kNoNode;
};

}  // namespace sipplab
