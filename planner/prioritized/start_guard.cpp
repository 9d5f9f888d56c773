#include "planner/prioritized/start_guard.hpp"

#include "planner/instance/disk_lookup.hpp"
#include "sipplab/options.hpp"

namespace sipplab {

StartGuard::StartGuard(const Instance& instance, double ssi_s, ReservationTable& reservations)
    : instance_(instance), ssi_s_(ssi_s), reservations_(reservations), disks_(instance.agents.size()) {}

void StartGuard::protect(AgentIndex agent) {
  if (ssi_s_ == 0 || disks_[agent]) return;
  const Agent& owner = instance_.agents[agent];
  disks_[agent] = reservations_.add(MovingDisk::resting(centre(owner.start), 0, ssi_s_, owner.radius_cells));
}

void StartGuard::lift(AgentIndex agent) {
  if (!disks_[agent]) return;
  reservations_.remove(*disks_[agent]);
  disks_[agent].reset();
}

void StartGuard::begin(AgentIndex agent) {
  lift(agent);
  if (ssi_s_ < kInfiniteSsi) return;
  const Agent& planned = instance_.agents[agent];
  for (AgentIndex other = 0; other < disks_.size(); ++other) {
    const Agent& owner = instance_.agents[other];
    if (disks_[other] && disks_overlap(planned.goal, planned.radius_cells, owner.start, owner.radius_cells)) {
      lift(other);
      reservations_.add_keepout(centre(owner.start), owner.radius_cells, centre(planned.goal));
      lifted_for_goal_.push_back(other);
    }
  }
}

void StartGuard::end() {
  reservations_.clear_keepouts();
  for (const AgentIndex other : lifted_for_goal_) protect(other);
  lifted_for_goal_.clear();
}

}  // namespace sipplab
