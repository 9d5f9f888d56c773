// One trajectory on its own; see trajectory_check.hpp.
#include "planner/validator/trajectory_check.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "planner/core/tolerances.hpp"
#include "planner/validator/body_track.hpp"
#include "planner/validator/static_clearance.hpp"

namespace sipplab {
namespace {

std::string text(Cell cell) { return fmt::format("({}, {})", cell.x, cell.y); }

class Check {
 public:
  Check(const Instance& instance, AgentIndex agent, const Trajectory& trajectory, std::size_t max_violations,
        std::vector<Violation>& violations)
      : map_(instance.map),
        agent_(instance.agents[agent]),
        index_(agent),
        label_(agent_label(instance, agent)),
        trajectory_(trajectory),
        max_violations_(max_violations),
        violations_(violations) {}

  bool times_are_finite() {
    for (const TimedMotion& motion : trajectory_.motions) {
      for (const double time_s : {motion.begin_s, motion.end_s}) {
        if (std::isfinite(time_s) && time_s >= 0) continue;
        report(ViolationKind::kNotFinite, 0, 0,
               fmt::format("time {} in a motion from {}", time_s, text(motion.from)));
        return false;
      }
    }
    return true;
  }

  void endpoints() {
    if (trajectory_.start != agent_.start) {
      report(ViolationKind::kEndpoint, 0, distance(trajectory_.start, agent_.start),
             fmt::format("begins at {}, not at its start {}", text(trajectory_.start), text(agent_.start)));
    }
    if (trajectory_.end() != agent_.goal) {
      report(ViolationKind::kEndpoint, trajectory_.arrival_s(), distance(trajectory_.end(), agent_.goal),
             fmt::format("ends at {}, not at its goal {}", text(trajectory_.end()), text(agent_.goal)));
    }
  }

  void motions() {
    Cell place = trajectory_.start;
    double time_s = 0;
    clearance(place, place, 0, 0);
    for (const TimedMotion& motion : trajectory_.motions) {
      continuity(motion, place, time_s);
      duration(motion);
      if (!motion.is_wait() || motion.from != place)
        clearance(motion.from, motion.to, motion.begin_s, motion.end_s);
      place = motion.to;
      time_s = motion.end_s;
    }
  }

 private:
  void continuity(const TimedMotion& motion, Cell place, double time_s) {
    if (motion.from != place) {
      report(ViolationKind::kDiscontinuity, motion.begin_s, distance(motion.from, place),
             fmt::format("jumps from {} to {}", text(place), text(motion.from)));
    }
    const double gap_s = std::abs(motion.begin_s - time_s);
    if (gap_s > time_tolerance_s(time_s)) {
      report(ViolationKind::kDiscontinuity, time_s, gap_s,
             fmt::format("a motion begins at time {}, not at {}", motion.begin_s, time_s));
    }
  }

  void duration(const TimedMotion& motion) {
    const double duration_s = motion.end_s - motion.begin_s;
    if (motion.is_wait()) {
      if (duration_s >= 0) return;
      report(ViolationKind::kDiscontinuity, motion.begin_s, -duration_s,
             fmt::format("waits backwards from time {} to {}", motion.begin_s, motion.end_s));
      return;
    }
    const double due_s = distance(motion.from, motion.to) / agent_.speed_cells_per_s;
    const double error_s = std::abs(duration_s - due_s);
    // Late enough, the tolerance of time excuses any duration, and a jump would be compared with no body.
    if (error_s <= time_tolerance_s(motion.end_s) && can_be_followed(motion)) return;
    report(ViolationKind::kSpeed, motion.begin_s, error_s,
           fmt::format("takes {} s from {} to {}, not {} s", duration_s, text(motion.from), text(motion.to),
                       due_s));
  }

  void clearance(Cell from, Cell to, double begin_s, double end_s) {
    const StaticOverlap overlap =
        deepest_static_overlap(map_, from, to, std::min(agent_.radius_cells, kMaxRadiusCells));
    if (!(overlap.depth_cells > kValidatorToleranceCells)) return;
    const std::string what =
        overlap.outside ? "leaves the grid" : "overlaps blocked cell " + text(overlap.blocked);
    report(
        ViolationKind::kStaticObstacle, begin_s + (end_s - begin_s) * overlap.at, overlap.depth_cells,
        fmt::format("{} by {:.3g} cells between {} and {}", what, overlap.depth_cells, text(from), text(to)));
  }

  void report(ViolationKind kind, double time_s, double depth_cells, const std::string& what) {
    if (violations_.size() >= max_violations_) return;
    violations_.push_back({kind, index_, std::nullopt, time_s, depth_cells, label_ + ": " + what});
  }

  const GridMap& map_;
  const Agent& agent_;
  const AgentIndex index_;
  const std::string label_;
  const Trajectory& trajectory_;
  const std::size_t max_violations_;
  std::vector<Violation>& violations_;
};

}  // namespace

double time_tolerance_s(double time_s) { return kDurationTolerance * std::max(1.0, time_s); }

std::string agent_label(const Instance& instance, AgentIndex agent) {
  const std::string& id = instance.agents[agent].id;
  return "agent " + (id.empty() ? std::to_string(agent) : id);
}

bool check_trajectory(const Instance& instance, AgentIndex agent, const Trajectory& trajectory,
                      std::size_t max_violations, std::vector<Violation>& violations) {
  Check check(instance, agent, trajectory, max_violations, violations);
  if (!check.times_are_finite()) return false;
  check.endpoints();
  check.motions();
  return true;
}

}  // namespace sipplab
