#include "planner/retime/courses.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "planner/core/tolerances.hpp"

namespace sipplab {
namespace {

/// Relative difference of a wait of no length, which rounding of sums makes.
constexpr double kNoWait = 1e-13;

/// Seconds that the move takes: as given, if that is right to within rounding.
Move timed_move(const TimedMotion& motion, double speed) {
  Move move(Displacement(centre(motion.from), centre(motion.to)), speed);
  const double given_s = motion.end_s - motion.begin_s;
  if (std::abs(given_s - move.duration) <= kDurationTolerance * std::max(1.0, motion.end_s)) {
    move.duration = given_s;
  }
  return move;
}

/// What is wrong with a motion that begins where and when `trajectory` is; empty if nothing is.
std::string flaw_of(const TimedMotion& motion, Cell here) {
  if (!std::isfinite(motion.begin_s) || !std::isfinite(motion.end_s) || motion.end_s < motion.begin_s) {
    return fmt::format("a motion from {} to {} s", motion.begin_s, motion.end_s);
  }
  if (motion.from == here) return {};
  return fmt::format("a jump from ({}, {}) to ({}, {}) at {} s", here.x, here.y, motion.from.x, motion.from.y,
                     motion.begin_s);
}

Expected<Course, std::string> course_of(const Trajectory& trajectory, double radius_cells,
                                        std::optional<double> speed, const MotionRules& rules) {
  Course course;
  course.radius_cells = radius_cells;
  course.is_fixed = !speed;
  course.start = centre(trajectory.start);
  Cell here = trajectory.start;
  double stand_s = 0;
  for (const TimedMotion& motion : trajectory.motions) {
    if (std::string flaw = flaw_of(motion, here); !flaw.empty()) return Unexpected{std::move(flaw)};
    here = motion.to;
    if (motion.is_turn()) stand_s += motion.end_s - motion.begin_s;
    if (motion.is_wait()) continue;
    const double span_s = motion.end_s - motion.begin_s;
    if (!speed && !(span_s > 0)) return Unexpected{std::string("a move that takes no time")};
    const double length = norm(centre(motion.to) - centre(motion.from));
    course.moves.push_back({timed_move(motion, speed.value_or(length / span_s)), motion.begin_s, motion.end_s,
                            stand_s + (speed ? rules.wait_before_move_s : 0)});
    stand_s = 0;
  }
  return course;
}

}  // namespace

Expected<std::vector<Course>, std::string> courses_of(const Instance& instance, const Solution& solution,
                                                      const MotionRules& rules) {
  if (solution.trajectories.size() != instance.agents.size()) {
    return Unexpected{fmt::format("{} trajectories, expected the {} of the instance",
                                  solution.trajectories.size(), instance.agents.size())};
  }
  std::vector<Course> courses;
  courses.reserve(instance.agents.size() + instance.obstacles.size());
  const auto add = [&](const char* what, const std::string& id, auto course) {
    std::string error = course ? "" : fmt::format("{} {}: {}", what, id, course.error());
    if (course) courses.push_back(std::move(*course));
    return error;
  };
  for (AgentIndex i = 0; i < instance.agents.size(); ++i) {
    const Agent& agent = instance.agents[i];
    const Trajectory& trajectory = solution.trajectories[i];
    if (trajectory.start != agent.start) {
      return Unexpected{fmt::format("robot {}: begins at ({}, {}), expected its start ({}, {})", agent.id,
                                    trajectory.start.x, trajectory.start.y, agent.start.x, agent.start.y)};
    }
    std::string error =
        add("robot", agent.id, course_of(trajectory, agent.radius_cells, agent.speed_cells_per_s, rules));
    if (!error.empty()) return Unexpected{std::move(error)};
  }
  for (const DynamicObstacle& obstacle : instance.obstacles) {
    std::string error = add("obstacle", obstacle.id,
                            course_of(obstacle.trajectory, obstacle.radius_cells, std::nullopt, rules));
    if (!error.empty()) return Unexpected{std::move(error)};
  }
  return courses;
}

Trajectory with_times(const Trajectory& given, const Course& course, const double* departures_s) {
  Trajectory timed{given.start, {}};
  std::size_t next = 0;
  for (const TimedMotion& motion : given.motions) {
    const double now_s = timed.end_s();
    if (motion.is_turn()) {
      timed.motions.push_back(motion);
      timed.motions.back().begin_s = now_s;
      timed.motions.back().end_s = now_s + (motion.end_s - motion.begin_s);
    } else if (!motion.is_wait()) {
      double begin_s = departures_s[next];
      if (begin_s - now_s <= kNoWait * std::max(1.0, now_s)) begin_s = now_s;
      if (begin_s > now_s) timed.motions.push_back({now_s, begin_s, motion.from, motion.from});
      timed.motions.push_back({begin_s, begin_s + course.moves[next].move.duration, motion.from, motion.to});
      ++next;
    }
  }
  return canonical(timed);
}

}  // namespace sipplab
