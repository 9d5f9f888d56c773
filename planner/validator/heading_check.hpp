// What one trajectory guarantees beyond its path: a robot moves the way it faces, has the
// time to turn, and stands as long as the rules ask before it moves.
#pragma once

#include <vector>

#include "sipplab/instance.hpp"
#include "sipplab/solution.hpp"
#include "sipplab/validator.hpp"

namespace sipplab {

/// Appends what the trajectory of instance.agents[agent] does against the rules, in order
/// of its motions, until `violations` holds `max_violations`. If the trajectory states a
/// turn between two moves, the turn must lead into the direction of the next one and take
/// its time; if it states none, standing long enough is as good.
/// REQUIRES: all times are finite.
void check_headings(const Instance& instance, AgentIndex agent, const Trajectory& trajectory,
                    const MotionRules& rules, std::size_t max_violations, std::vector<Violation>& violations);

}  // namespace sipplab
