// The guarantee of start-safe intervals: no robot comes too close to the start of a
// lower-priority robot while that start is protected. [AY18], section 3.
#pragma once

#include <cstddef>
#include <vector>

#include "planner/validator/body_track.hpp"
#include "sipplab/instance.hpp"

namespace sipplab {

/// Robot `agent` at its closest to the start of `other`, which has lower priority.
struct StartIntrusion {
  AgentIndex agent = 0;
  AgentIndex other = 0;
  double time_s = 0;
  double depth_cells = 0;
};

/// For each robot and each robot of lower priority: the deepest intrusion into the
/// latter's start during [0, ssi_s], when deeper than `tolerance_cells`. With an
/// infinite ssi_s only the time counts that a robot spends at least the sum of the
/// two radii away from its own goal. At most `max_intrusions` of them; by agent,
/// then other.
///
/// REQUIRES: `order` is a permutation of the agents, from highest to lowest
/// priority; one track for each agent; ssi_s > 0.
std::vector<StartIntrusion> check_start_safe_intervals(const Instance& instance,
                                                       const std::vector<BodyTrack>& robots,
                                                       const std::vector<AgentIndex>& order, double ssi_s,
                                                       double tolerance_cells, std::size_t max_intrusions);

}  // namespace sipplab
