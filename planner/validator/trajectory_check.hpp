// What one trajectory guarantees on its own: times, endpoints, continuity, speed and
// a body on free cells.
#pragma once

#include <vector>

#include "sipplab/instance.hpp"
#include "sipplab/solution.hpp"
#include "sipplab/validator.hpp"

namespace sipplab {

/// Appends what is wrong with the trajectory of instance.agents[agent], in order of
/// its motions, until `violations` holds `max_violations`. True when every time is
/// a number that a plan can have, so that the trajectory can be compared with others.
bool check_trajectory(const Instance& instance, AgentIndex agent, const Trajectory& trajectory,
                      std::size_t max_violations, std::vector<Violation>& violations);

/// Seconds. Errors of times that rounding explains, at this time.
double time_tolerance_s(double time_s);

/// How messages call an agent: its id, or its position if it has none.
std::string agent_label(const Instance& instance, AgentIndex agent);

}  // namespace sipplab
