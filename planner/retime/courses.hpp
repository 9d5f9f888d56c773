// What is left of a plan when its clock is taken away: the straight moves of each body, one after the other.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "planner/geometry/moving_disk.hpp"
#include "sipplab/instance.hpp"
#include "sipplab/solution.hpp"

namespace sipplab {

/// A straight move, and when the given plan makes it.
struct CourseMove {
  Move move;
  double given_begin_s = 0;
  double given_end_s = 0;
  double stand_s = 0;  ///< least time between the move before (or time 0) and this one: for turns and delays
};

/// A robot, or a dynamic obstacle, whose times are fixed.
struct Course {
  double radius_cells = 0;
  bool is_fixed = false;
  std::vector<CourseMove> moves;
  Vec2 start;

  Vec2 end() const { return moves.empty() ? start : moves.back().move.path.to; }
};

/// Those of all robots, then those of the obstacles. A move takes what it takes in the plan where that is its
/// length over the robot's speed to within rounding, and that quotient otherwise. Errors: one line, for a
/// plan without one trajectory for each robot, a jump, another start than the instance has, a time that is
/// none.
Expected<std::vector<Course>, std::string> courses_of(const Instance& instance, const Solution& solution,
                                                      const MotionRules& rules);

/// The trajectory with new times of its moves; turns begin when the robot stands. Moves that go straight on
/// without a wait become one, unless they were apart already.
/// REQUIRES: one departure for each move of the course.
Trajectory with_times(const Trajectory& given, const Course& course, const double* departures_s);

}  // namespace sipplab
