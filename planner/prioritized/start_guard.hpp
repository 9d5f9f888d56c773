// Start-safe intervals as the planner respects them: protected starts are resting disks
// in the reservation table. [AY18], section 3.
#pragma once

#include <optional>
#include <vector>

#include "planner/reservation/reservation_table.hpp"
#include "sipplab/instance.hpp"

namespace sipplab {

class StartGuard {
 public:
  /// Protects no start yet; never any if ssi_s is 0. Instance and table must outlive it.
  StartGuard(const Instance& instance, double ssi_s, ReservationTable& reservations);

  /// Protects the start of a robot; no effect if it is protected already.
  void protect(AgentIndex agent);
  /// Ends its protection; no effect if it is not protected.
  void lift(AgentIndex agent);

  /// The robot is about to be planned: its own start is no obstacle to it, now and afterwards. Starts that
  /// are protected for ever let it in if its own goal overlaps them, while it is within the disk of its goal;
  /// otherwise a goal on the start of another robot could never be reached.
  void begin(AgentIndex agent);
  /// The robot has been planned.
  void end();

 private:
  const Instance& instance_;
  double ssi_s_;
  ReservationTable& reservations_;
  std::vector<std::optional<ReservationTable::DiskId>> disks_;  ///< by agent: its start, if protected
  std::vector<AgentIndex> lifted_for_goal_;
};

}  // namespace sipplab
