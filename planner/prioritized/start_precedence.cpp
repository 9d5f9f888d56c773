#include "planner/prioritized/start_precedence.hpp"

#include <algorithm>
#include <functional>
#include <queue>
#include <utility>

#include "planner/geometry/collision_interval.hpp"
#include "planner/instance/disk_lookup.hpp"
#include "sipplab/options.hpp"

namespace sipplab {
namespace {

/// Cells. Overlap with a start that does not count: more than planned robots come too close
/// (2 * kContactSlackCells), less than the validator accepts (kValidatorToleranceCells).
constexpr double kCrossingDepthCells = 5e-9;

}  // namespace

StartPrecedence::StartPrecedence(const Instance& instance, double ssi_s)
    : instance_(instance),
      ssi_s_(ssi_s),
      crossers_(instance.agents.size()),
      crossed_(instance.agents.size()),
      seen_(instance.agents.size()) {}

bool StartPrecedence::crosses(const Agent& agent, const TimedMotion& motion, const Agent& owner) const {
  const double contact = agent.radius_cells + owner.radius_cells;
  const auto [left, right] = std::minmax(motion.from.x, motion.to.x);
  const auto [top, bottom] = std::minmax(motion.from.y, motion.to.y);
  if (owner.start.x <= left - contact || owner.start.x >= right + contact || owner.start.y <= top - contact ||
      owner.start.y >= bottom + contact) {
    return false;
  }
  const double reach = contact - kCrossingDepthCells;
  const Vec2 place = centre(owner.start);
  const Displacement path(centre(motion.from), centre(motion.to));
  if (ssi_s_ == kInfiniteSsi &&
      disks_overlap(agent.goal, agent.radius_cells, owner.start, owner.radius_cells)) {
    return intrudes(path, place, centre(agent.goal), contact);
  }
  const MovingDisk disk = MovingDisk::moving(path, motion.begin_s, motion.end_s, agent.radius_cells);
  const OpenInterval near = collision_interval(place, disk, reach);
  return !near.empty() && near.begin_s < ssi_s_;
}

void StartPrecedence::set(AgentIndex agent, const Trajectory& trajectory) {
  reset(agent);
  if (ssi_s_ == 0) return;
  const Agent& mover = instance_.agents[agent];
  for (const TimedMotion& motion : trajectory.motions) {
    if (motion.begin_s >= ssi_s_) break;
    for (AgentIndex owner = 0; owner < crossers_.size(); ++owner) {
      if (owner == agent || !crosses(mover, motion, instance_.agents[owner])) continue;
      std::vector<AgentIndex>& crossers = crossers_[owner];
      if (!crossers.empty() && crossers.back() == agent) continue;  // by an earlier motion
      crossers.push_back(agent);
      crossed_[agent].push_back(owner);
    }
  }
}

void StartPrecedence::reset(AgentIndex agent) {
  for (const AgentIndex owner : crossed_[agent]) {
    std::vector<AgentIndex>& crossers = crossers_[owner];
    crossers.erase(std::find(crossers.begin(), crossers.end(), agent));
  }
  crossed_[agent].clear();
}

const std::vector<AgentIndex>& StartPrecedence::followers(AgentIndex agent) {
  found_.clear();
  seen_[agent] = ++walk_;
  const auto visit = [this](AgentIndex from) {
    for (const AgentIndex next : crossers_[from]) {
      if (std::exchange(seen_[next], walk_) != walk_) found_.push_back(next);
    }
  };
  visit(agent);
  for (std::size_t i = 0; i < found_.size(); ++i) visit(found_[i]);
  return found_;
}

bool StartPrecedence::closes_cycle(AgentIndex agent, const Trajectory& trajectory) {
  const std::vector<AgentIndex>& owners = followers(agent);
  for (const TimedMotion& motion : trajectory.motions) {
    if (motion.begin_s >= ssi_s_) break;
    for (const AgentIndex owner : owners) {
      if (crosses(instance_.agents[agent], motion, instance_.agents[owner])) return true;
    }
  }
  return false;
}

std::optional<PriorityOrder> StartPrecedence::order(const PriorityOrder& preferred) const {
  std::vector<std::size_t> rank(preferred.size());
  for (std::size_t i = 0; i < preferred.size(); ++i) rank[preferred[i]] = i;
  std::vector<std::size_t> before(preferred.size());  // how many must still come first
  std::priority_queue<std::size_t, std::vector<std::size_t>, std::greater<>> ready;  // ranks
  for (AgentIndex agent = 0; agent < preferred.size(); ++agent) {
    before[agent] = crossed_[agent].size();
    if (before[agent] == 0) ready.push(rank[agent]);
  }
  PriorityOrder order;
  while (!ready.empty()) {
    order.push_back(preferred[ready.top()]);
    ready.pop();
    for (const AgentIndex next : crossers_[order.back()]) {
      if (--before[next] == 0) ready.push(rank[next]);
    }
  }
  if (order.size() < preferred.size()) return std::nullopt;
  return order;
}

}  // namespace sipplab
