// The same problem and the same plan, seen from elsewhere.
#pragma once

#include <vector>

#include "sipplab/instance.hpp"
#include "sipplab/solution.hpp"

namespace sipplab {

struct Scene {
  Instance instance;
  Solution solution;
};

/// A quarter turn, clockwise as a viewer sees it.
Scene rotated(const Scene& scene);
/// Left and right exchanged.
Scene reflected(const Scene& scene);
/// All times `factor` times as long, all speeds (of rotation, too) lower by it. Exact for powers of two.
Scene slowed(const Scene& scene, double factor);
/// Without one agent.
Scene without_agent(const Scene& scene, AgentIndex agent);
/// The same for a priority order over the agents.
std::vector<AgentIndex> without_agent(const std::vector<AgentIndex>& order, AgentIndex agent);

}  // namespace sipplab
