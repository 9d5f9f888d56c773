// Where two bodies of a plan meet, who goes first there, and how much later the other one may follow.
#pragma once

#include <cstdint>
#include <optional>
#include <utility>
#include <vector>

#include "planner/retime/courses.hpp"
#include "planner/retime/longest_paths.hpp"

namespace sipplab {

/// The departure of move `after` is at least `lag_s` later than that of move `before`; < 0 is allowed. Moves
/// are numbered through all courses.
struct Precedence {
  EventId after = 0;
  EventId before = 0;
  double lag_s = 0;
};

struct Meetings {
  std::vector<EventId> first;  ///< by course, the number of its first move; one more at the end
  std::vector<Precedence> precedences;
  /// Two courses of which no one can go first: each has to pass while the other stands, or one stands for
  /// ever where the other one passes. Nothing else is of use then.
  std::optional<std::pair<std::size_t, std::size_t>> deadlock;
  Vec2 deadlock_place;
};

/// Two moves collide for one open interval of relative departures (meeting_interval), so that one of the two
/// has to go first. Moves whose collisions hang together, by way of the places where a body may stand between
/// two moves, have one answer:
///  (1) who stands there at its start goes first, who stays there at its end goes last;
///  (2) else who goes first in the given plan, by its own clock;
///  (3) where the bodies overlap in the given plan, who goes first at more of the moves that hang together
///      without an overlap, and last whose lead is longer.
/// Orders among fixed courses are left out. A move that the plan lets pass up to kGivenOverlapCells too early
/// is let pass as early.
/// O(moves + pairs of moves whose paths come near each other).
Meetings find_meetings(const std::vector<Course>& courses);

/// Cells. What the validator lets two bodies overlap without a word.
inline constexpr double kGivenOverlapCells = 2e-8;

}  // namespace sipplab
