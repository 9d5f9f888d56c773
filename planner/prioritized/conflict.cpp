#include "planner/prioritized/conflict.hpp"

#include <algorithm>
#include <cstddef>
#include <cstdint>

#include "planner/geometry/collision_interval.hpp"

namespace sipplab {
namespace {

/// A part of a trajectory: a motion, or the rest at its end.
TimedMotion part_of(const Trajectory& trajectory, std::size_t i) {
  if (i < trajectory.motions.size()) return trajectory.motions[i];
  return {trajectory.end_s(), kForever, trajectory.end(), trajectory.end()};
}

/// Whether the two stay farther apart than `reach` along either axis.
bool are_apart(const TimedMotion& a, const TimedMotion& b, double reach) {
  const auto apart = [reach](std::int32_t a0, std::int32_t a1, std::int32_t b0, std::int32_t b1) {
    return std::max(a0, a1) + reach <= std::min(b0, b1) || std::max(b0, b1) + reach <= std::min(a0, a1);
  };
  return apart(a.from.x, a.to.x, b.from.x, b.to.x) || apart(a.from.y, a.to.y, b.from.y, b.to.y);
}

bool overlap(const Agent& agent, const TimedMotion& mine, double other_radius_cells,
             const TimedMotion& other) {
  const double reach = agent.radius_cells + other_radius_cells;
  if (are_apart(mine, other, reach)) return false;
  const Displacement other_path(centre(other.from), centre(other.to));
  const MovingDisk disk = MovingDisk::moving(other_path, other.begin_s, other.end_s, other_radius_cells);
  if (mine.is_wait()) {
    const OpenInterval near = collision_interval(centre(mine.from), disk, reach);
    return !near.empty() && near.begin_s < mine.end_s && near.end_s > mine.begin_s;
  }
  const Move move(Displacement(centre(mine.from), centre(mine.to)), agent.speed_cells_per_s);
  return closeness(move, mine.begin_s, disk, reach) != Closeness::kApart &&
         unsafe_departures(move, disk, reach).contains(mine.begin_s);
}

}  // namespace

bool are_in_conflict(const Agent& agent, const Trajectory& mine, double other_radius_cells,
                     const Trajectory& other) {
  std::size_t i = 0;
  std::size_t j = 0;
  while (i <= mine.motions.size() && j <= other.motions.size()) {
    const TimedMotion a = part_of(mine, i);
    const TimedMotion b = part_of(other, j);
    if (overlap(agent, a, other_radius_cells, b)) return true;
    if (a.end_s == kForever && b.end_s == kForever) return false;
    // If both parts end together, go on in both: neither meets the other's next part for longer than a
    // moment, and that moment belongs to the parts before as well.
    if (a.end_s <= b.end_s) ++i;
    if (b.end_s <= a.end_s) ++j;
  }
  return false;
}

}  // namespace sipplab
