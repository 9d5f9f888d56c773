// Anyone's plan with the earliest times that are right for disks: its paths stay, and who goes first wherever
// two bodies meet.
#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "sipplab/error.hpp"
#include "sipplab/instance.hpp"
#include "sipplab/solution.hpp"

namespace sipplab {

/// A body that has to wait for the next one in the ring, and the move that it cannot make.
struct RingMember {
  std::size_t agent = 0;  ///< or the obstacle's position
  bool is_obstacle = false;
  Cell from;
  Cell to;
};

struct RetimeResult {
  Solution solution;             ///< empty if there is no schedule
  std::vector<RingMember> ring;  ///< why there is none; else empty

  bool is_executable() const { return ring.empty(); }
};

/// Keeps the straight moves of each robot, in their order and at the robot's speed, and at each place where
/// two bodies would collide the order in which they pass it (meetings.hpp says what that is where the given
/// plan is not valid). Of all schedules that do so this is the least:
///  (1) every move begins as early as in any of them;
///  (2) a solution of a valid plan is valid, and no arrival is later than it was;
///  (3) a solution of a plan with valid paths (static obstacles, starts, goals) is valid;
///  (4) there is no schedule exactly if there is a ring of bodies of which each has to wait for the next: one
///  of
///      as few as any through those of the ring that was found first.
/// Linear in the moves for plans of unit moves between four neighbours by robots of one speed and one radius
/// of at most 0.5 in which no two robots are at one cell at once; see find_meetings() for others. Errors: one
/// line, if the plan is none for this instance, or the rules inflate (who keeps away from whom depends on
/// an order). REQUIRES: !find_error(instance).
Expected<RetimeResult, std::string> retime(const Instance& instance, const Solution& solution,
                                           const MotionRules& rules = {});

/// "robots 3 (4, 5) -> (5, 5), 7 (5, 5) -> (5, 6): each has to wait for the next one".
std::string ring_text(const Instance& instance, const std::vector<RingMember>& ring);

}  // namespace sipplab
