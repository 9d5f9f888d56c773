// Turns and delays of one trajectory; see heading_check.hpp. Angles are taken between
// directions as vectors; degrees are only what files speak.
#include "planner/validator/heading_check.hpp"

#include <fmt/format.h>

#include <cmath>

#include "planner/core/tolerances.hpp"
#include "planner/validator/trajectory_check.hpp"

namespace sipplab {
namespace {

constexpr double kPi = 3.14159265358979323846;

/// Unit vector of a heading; y grows downwards.
Vec2 facing(double heading_deg) {
  const double radians = heading_deg * (kPi / 180);
  return {std::cos(radians), -std::sin(radians)};
}

Vec2 facing(Cell from, Cell to) {
  const Vec2 path = centre(to) - centre(from);
  const double length = norm(path);
  return {path.x / length, path.y / length};
}

/// Between two unit vectors, in degrees. W. Kahan's formula: accurate for all angles.
double angle_deg(Vec2 a, Vec2 b) { return 2 * std::atan2(norm(a - b), norm(a + b)) * (180 / kPi); }

/// As messages show a direction.
double shown_deg(Vec2 direction) {
  const double degrees = std::atan2(-direction.y, direction.x) * (180 / kPi);
  return degrees < 0 ? degrees + 360 : degrees;
}

class HeadingCheck {
 public:
  HeadingCheck(const Instance& instance, AgentIndex agent, const MotionRules& rules,
               std::size_t max_violations, std::vector<Violation>& violations)
      : agent_(instance.agents[agent]),
        index_(agent),
        label_(agent_label(instance, agent)),
        rules_(rules),
        max_violations_(max_violations),
        violations_(violations),
        facing_(facing(agent_.start_heading_deg)) {}

  void stand(const TimedMotion& motion) {
    if (!motion.is_turn() || !rules_.turns) return;
    const Vec2 towards = facing(*motion.turn_to_deg);
    const double due_s = turn_s(angle_deg(facing_, towards));
    const double duration_s = motion.end_s - motion.begin_s;
    const double short_s = due_s - duration_s;
    const bool too_short = short_s > time_tolerance_s(motion.end_s);
    if (too_short) {
      report(ViolationKind::kStandingTime, motion.begin_s, short_s,
             fmt::format("turns to heading {:.6g} in {:.6g} s at time {:.6g}, not in {:.6g} s",
                         *motion.turn_to_deg, duration_s, motion.begin_s, due_s));
    }
    needed_s_ += too_short ? duration_s : due_s;  // each mistake is reported once
    facing_ = towards;
    states_a_turn_ = true;
  }

  void move(const TimedMotion& motion) {
    needed_s_ += rules_.wait_before_move_s;
    face(facing(motion.from, motion.to), motion.begin_s, "moves");
    require_time(motion.begin_s);
    stands_since_s_ = motion.end_s;
    needed_s_ = 0;
    states_a_turn_ = false;
  }

  /// A turn that is not written down may take the waits before `end_s`.
  void rest(double end_s) {
    if (!agent_.goal_heading_deg) return;
    face(facing(*agent_.goal_heading_deg), end_s, "ends");
    require_time(end_s);
  }

 private:
  double turn_s(double degrees) const { return degrees / (180 * agent_.rotation_speed); }

  /// The robot has to face this direction now.
  void face(Vec2 direction, double time_s, const char* what) {
    if (!rules_.turns) return;
    const double off_deg = angle_deg(facing_, direction);
    if (!states_a_turn_) {
      needed_s_ += turn_s(off_deg);
    } else if (off_deg > kHeadingToleranceDeg) {
      report(ViolationKind::kHeading, time_s, off_deg,
             fmt::format("{} at time {:.6g} with heading {:.6g} while it faces {:.6g}", what, time_s,
                         shown_deg(direction), shown_deg(facing_)));
    }
    facing_ = direction;
  }

  void require_time(double until_s) {
    const double short_s = needed_s_ - (until_s - stands_since_s_);
    if (short_s <= time_tolerance_s(until_s)) return;
    report(ViolationKind::kStandingTime, stands_since_s_, short_s,
           fmt::format("stands for {:.6g} s from time {:.6g} on, turns and delays take {:.6g} s",
                       until_s - stands_since_s_, stands_since_s_, needed_s_));
  }

  void report(ViolationKind kind, double time_s, double error, const std::string& what) {
    if (violations_.size() >= max_violations_) return;
    violations_.push_back({kind, index_, std::nullopt, time_s, error, label_ + ": " + what});
  }

  const Agent& agent_;
  const AgentIndex index_;
  const std::string label_;
  const MotionRules& rules_;
  const std::size_t max_violations_;
  std::vector<Violation>& violations_;

  Vec2 facing_;
  double stands_since_s_ = 0;
  double needed_s_ = 0;         ///< for turns and delays since then
  bool states_a_turn_ = false;  ///< since then
};

}  // namespace

void check_headings(const Instance& instance, AgentIndex agent, const Trajectory& trajectory,
                    const MotionRules& rules, std::size_t max_violations,
                    std::vector<Violation>& violations) {
  if (!rules.turns && !(rules.wait_before_move_s > 0)) return;
  HeadingCheck check(instance, agent, rules, max_violations, violations);
  for (const TimedMotion& motion : trajectory.motions) {
    if (motion.is_wait()) {
      check.stand(motion);
    } else {
      check.move(motion);
    }
  }
  check.rest(trajectory.end_s());
}

}  // namespace sipplab
