// A state of SIPP: a cell and one of its safe intervals, with the earliest known
// arrival. [PL11], section III.
#pragma once

#include <cstdint>

#include "sipplab/geometry.hpp"
#include "sipplab/grid_map.hpp"

namespace sipplab {

/// Nodes live in one vector and point to each other by index.
using NodeId = std::uint32_t;
inline constexpr NodeId kNoNode = UINT32_MAX;

/// One cache line: a search waits for these more than for anything else.
struct alignas(64) SippNode {
  SafeInterval interval;
  double arrival_s = kForever;  ///< earliest known; kForever: not reached yet
  double departure_s = 0;       ///< from the parent, to arrive then
  double to_goal_s = 0;         ///< weighted heuristic: at most `weight` times the time by steps to the goal
  /// No earlier departure is safe for the straight move from `edge_from`, unless that node's arrival fell
  /// since. Several neighbours of a cell have the same parent.
  double edge_departure_s = 0;
  std::int16_t x = 0;
  std::int16_t y = 0;
  NodeId parent = kNoNode;
  NodeId edge_from = kNoNode;
  std::uint16_t version = 0;  ///< how often the arrival fell; stops at kLastVersion
  std::uint16_t edge_version = 0;

  Cell cell() const { return {x, y}; }
  /// REQUIRES: arrives_s <= arrival_s.
  void reach(NodeId from, double leaves_s, double arrives_s) {
    if (arrives_s < arrival_s && version < kLastVersion) ++version;
    parent = from;
    departure_s = leaves_s;
    arrival_s = arrives_s;
  }
  /// Whether `edge_departure_s` holds for node `id`.
  bool knows_edge_from(NodeId id, const SippNode& from) const {
    return edge_from == id && edge_version == from.version && from.version < kLastVersion;
  }
  void know_edge_from(NodeId id, std::uint16_t from_version, double departs_s) {
    edge_from = id;
    edge_version = from_version;
    edge_departure_s = departs_s;
  }
  static constexpr std::uint16_t kLastVersion = UINT16_MAX;
};

}  // namespace sipplab
