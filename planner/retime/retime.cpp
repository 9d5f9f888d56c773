#include "planner/retime/retime.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "planner/core/tolerances.hpp"
#include "planner/core/try.hpp"
#include "planner/retime/courses.hpp"
#include "planner/retime/meetings.hpp"
#include "planner/retime/unit_schedule.hpp"

namespace sipplab {
namespace {

/// The departures of all moves, and one event more where there are obstacles: the beginning of time, from
/// which theirs are neither earlier nor later than they are.
class MoveGraph {
 public:
  using Time = double;

  MoveGraph(const std::vector<Course>& courses, const Meetings& meetings) : first_(meetings.first) {
    double fastest = 1;
    for (const Course& course : courses) {
      has_fixed_ = has_fixed_ || course.is_fixed;
      for (const CourseMove& move : course.moves) {
        moves_.push_back(&move);
        fixed_.push_back(course.is_fixed);
        fastest = std::max(fastest, move.move.speed);
      }
    }
    rounding_s_ = kContactSlackCells / fastest;
    begins_.assign(moves_.size() + 1, 0);
    for (const Precedence& precedence : meetings.precedences) ++begins_[precedence.after + 1];
    for (std::size_t i = 0; i < moves_.size(); ++i) begins_[i + 1] += begins_[i];
    lags_.resize(meetings.precedences.size());
    std::vector<std::uint32_t> next(begins_.begin(), begins_.end());
    for (const Precedence& precedence : meetings.precedences) {
      lags_[next[precedence.after]++] = {precedence.before, precedence.lag_s};
    }
    is_first_.assign(moves_.size(), false);
    for (std::size_t c = 0; c < courses.size(); ++c) {
      if (!courses[c].moves.empty()) is_first_[first_[c]] = true;
    }
    if (has_fixed_) {
      for (EventId move = 0; move < moves_.size(); ++move) {
        if (fixed_[move]) fixed_moves_.push_back(move);
      }
    }
  }

  std::size_t size() const { return moves_.size() + (has_fixed_ ? 1 : 0); }
  double earliest(EventId event) const {
    if (event == moves_.size()) return 0;
    return fixed_[event] ? moves_[event]->given_begin_s : is_first_[event] ? moves_[event]->stand_s : 0;
  }
  bool is_later(double a, double b) const { return a > b + rounding_s_; }

  std::optional<Lag<double>> lag(EventId event, std::uint32_t n) const {
    if (event == moves_.size()) {
      if (n >= fixed_moves_.size()) return std::nullopt;
      return Lag<double>{fixed_moves_[n], -moves_[fixed_moves_[n]]->given_begin_s};
    }
    const bool begins_time = is_first_[event] || fixed_[event];
    const bool has_own = has_fixed_ || !begins_time;  // a lag that no meeting asks for
    if (n == 0 && has_own) return own_lag(event, begins_time);
    const std::uint32_t at = begins_[event] + n - (has_own ? 1 : 0);
    if (at >= begins_[event + 1]) return std::nullopt;
    return lags_[at];
  }

 private:
  Lag<double> own_lag(EventId event, bool begins_time) const {
    if (begins_time) return {static_cast<EventId>(moves_.size()), earliest(event)};
    return {event - 1, moves_[event - 1]->move.duration + moves_[event]->stand_s};
  }

  const std::vector<EventId>& first_;
  std::vector<const CourseMove*> moves_;
  std::vector<bool> fixed_;
  std::vector<bool> is_first_;
  std::vector<EventId> fixed_moves_;
  std::vector<std::uint32_t> begins_;
  std::vector<Lag<double>> lags_;
  double rounding_s_ = 0;
  bool has_fixed_ = false;
};

RingMember member_of(const Instance& instance, std::size_t course, Cell from, Cell to) {
  const std::size_t robots = instance.agents.size();
  if (course < robots) return {course, false, from, to};
  return {course - robots, true, from, to};
}

Cell cell_of(Vec2 place) { return {static_cast<std::int32_t>(place.x), static_cast<std::int32_t>(place.y)}; }

/// The least first, for a text that does not depend on where the ring was entered.
void turn_ring(std::vector<RingMember>& ring) {
  std::rotate(ring.begin(),
              std::min_element(ring.begin(), ring.end(),
                               [](const RingMember& a, const RingMember& b) {
                                 return a.is_obstacle != b.is_obstacle ? b.is_obstacle : a.agent < b.agent;
                               }),
              ring.end());
}

/// One member for each body, at its first move of the circle.
std::vector<RingMember> ring_of(const Instance& instance, const std::vector<Course>& courses,
                                const std::vector<EventId>& first, const std::vector<EventId>& circle) {
  std::vector<RingMember> ring;
  for (const EventId event : circle) {
    if (event == first.back()) continue;  // the beginning of time
    const auto course =
        static_cast<std::size_t>(std::upper_bound(first.begin(), first.end(), event) - first.begin() - 1);
    const Displacement& path = courses[course].moves[event - first[course]].move.path;
    const RingMember member = member_of(instance, course, cell_of(path.from), cell_of(path.to));
    const auto is_same = [&](const RingMember& other) {
      return other.agent == member.agent && other.is_obstacle == member.is_obstacle;
    };
    if (std::none_of(ring.begin(), ring.end(), is_same)) ring.push_back(member);
  }
  turn_ring(ring);
  return ring;
}

Expected<RetimeResult, std::string> retime_any(const Instance& instance, const Solution& solution,
                                               const MotionRules& rules) {
  const std::vector<Course> courses = SIPPLAB_TRY(courses_of(instance, solution, rules));
  const Meetings meetings = find_meetings(courses);
  RetimeResult result;
  if (meetings.deadlock) {
    const Cell place = cell_of(meetings.deadlock_place);
    result.ring = {member_of(instance, meetings.deadlock->first, place, place),
                   member_of(instance, meetings.deadlock->second, place, place)};
    return result;
  }
  const LeastTimes<double> least = least_times(MoveGraph(courses, meetings));
  if (!least.circle.empty()) {
    result.ring = ring_of(instance, courses, meetings.first, least.circle);
    return result;
  }
  result.solution.trajectories.reserve(instance.agents.size());
  for (AgentIndex i = 0; i < instance.agents.size(); ++i) {
    result.solution.trajectories.push_back(
        with_times(solution.trajectories[i], courses[i], least.times.data() + meetings.first[i]));
  }
  return result;
}

bool is_whole(double number) { return std::floor(number) == number; }

/// The visits of a plan of unit moves between free neighbours by equal robots that are never two at a cell;
/// none for any other plan. Times are steps of a clock: those of a plan in continuous time may have the slack
/// of its planner, which find_meetings() gives them back.
std::optional<Visits> unit_visits(const Instance& instance, const Solution& solution, const FreeGrid& grid,
                                  const MotionRules& rules) {
  if (!rules.is_plain() || !instance.obstacles.empty() || instance.agents.empty() ||
      instance.agents.size() != solution.trajectories.size()) {
    return std::nullopt;
  }
  const Agent& one = instance.agents.front();
  const bool are_equal = std::all_of(instance.agents.begin(), instance.agents.end(), [&](const Agent& agent) {
    return agent.radius_cells == one.radius_cells && agent.speed_cells_per_s == one.speed_cells_per_s;
  });
  if (!are_equal || one.radius_cells > kDefaultRadiusCells) return std::nullopt;
  VisitCollector collector(grid.size());
  for (AgentIndex i = 0; i < instance.agents.size(); ++i) {
    const Trajectory& trajectory = solution.trajectories[i];
    Cell here = trajectory.start;
    if (here != instance.agents[i].start) return std::nullopt;
    collector.add_robot(grid.id(here));
    for (const TimedMotion& motion : trajectory.motions) {
      const bool goes_on =
          motion.from == here && std::isfinite(motion.end_s) && motion.begin_s <= motion.end_s;
      if (!goes_on || motion.is_turn()) return std::nullopt;
      if (motion.is_wait()) continue;
      const std::int64_t cells =
          std::abs(std::int64_t{motion.to.x} - here.x) + std::abs(std::int64_t{motion.to.y} - here.y);
      const double speed = one.speed_cells_per_s;
      const bool are_steps = (is_whole(motion.begin_s) && is_whole(motion.end_s)) ||
                             (is_whole(motion.begin_s * speed) && is_whole(motion.end_s * speed));
      if (!are_steps || cells != 1 || !instance.map.contains(motion.to) || instance.map.is_blocked(motion.to))
        return std::nullopt;
      here = motion.to;
      collector.add_move(grid.id(here), motion.begin_s, motion.end_s);
    }
  }
  return std::move(collector).take();
}

}  // namespace

Expected<RetimeResult, std::string> retime(const Instance& instance, const Solution& solution,
                                           const MotionRules& rules) {
  if (rules.inflates()) return Unexpected{std::string("inflated distances and times, expected none")};
  const FreeGrid grid(instance.map);
  const std::optional<Visits> visits = unit_visits(instance, solution, grid, rules);
  if (!visits) return retime_any(instance, solution, rules);
  const Agent& one = instance.agents.front();
  UnitSchedule schedule = unit_schedule(grid, *visits, 2 * one.radius_cells, 1 / one.speed_cells_per_s);
  RetimeResult result;
  result.solution = std::move(schedule.solution);
  for (const VisitId id : schedule.circle) {
    const Visit& visit = (*visits)[id];
    result.ring.push_back(
        {visit.robot, false, grid.cell((*visits)[visit.before].cell), grid.cell(visit.cell)});
  }
  turn_ring(result.ring);
  return result;
}

std::string ring_text(const Instance& instance, const std::vector<RingMember>& ring) {
  constexpr std::size_t kMostMembers = 12;
  std::string text;
  for (std::size_t i = 0; i < std::min(ring.size(), kMostMembers); ++i) {
    const RingMember& member = ring[i];
    text += i == 0 ? "" : ", ";
    text += member.is_obstacle ? "obstacle " + instance.obstacles[member.agent].id
                               : "robot " + instance.agents[member.agent].id;
    text += fmt::format(" ({}, {})", member.from.x, member.from.y);
    if (member.from != member.to) text += fmt::format(" -> ({}, {})", member.to.x, member.to.y);
  }
  if (ring.size() > kMostMembers) text += fmt::format(" and {} more", ring.size() - kMostMembers);
  return text + ": each has to wait for the next one";
}

}  // namespace sipplab
