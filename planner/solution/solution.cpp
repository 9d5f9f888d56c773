// What a solution costs, and its hash; see solution.hpp.
#include "sipplab/solution.hpp"

#include <algorithm>

#include "planner/solution/digest.hpp"

namespace sipplab {

bool has_turns(const Solution& solution) {
  for (const Trajectory& trajectory : solution.trajectories) {
    for (const TimedMotion& motion : trajectory.motions) {
      if (motion.is_turn()) return true;
    }
  }
  return false;
}

double makespan_s(const Solution& solution) {
  double latest_s = 0;
  for (const Trajectory& trajectory : solution.trajectories)
    latest_s = std::max(latest_s, trajectory.arrival_s());
  return latest_s;
}

double flowtime_s(const Solution& solution) {
  double sum_s = 0;
  for (const Trajectory& trajectory : solution.trajectories) sum_s += trajectory.arrival_s();
  return sum_s;
}

std::string plan_hash(const Solution& solution) {
  Digest digest("sipplab plan 1");
  digest.add(static_cast<std::uint64_t>(solution.trajectories.size()));
  for (const Trajectory& trajectory : solution.trajectories) digest.add(canonical(trajectory));
  return digest.hex();
}

}  // namespace sipplab
