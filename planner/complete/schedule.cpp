#include "planner/complete/schedule.hpp"

#include <algorithm>
#include <array>

#include "sipplab/error.hpp"

namespace sipplab {
namespace {

constexpr ExactTime kUnitMove{1, 0};

/// Longest paths to all visits, each asked for after those that it waits for.
class LongestPaths {
 public:
  LongestPaths(const FreeGrid& grid, const Visits& visits)
      : grid_(grid), visits_(visits), arrivals_(visits.size()), known_(visits.size(), 0) {}

  std::vector<ExactTime> all() {
    for (RobotId robot = 0; robot < visits_.robots(); ++robot) {
      VisitId visit = visits_.first_of(robot);
      known_[visit] = 1;  // at time 0
      for (; visit != kNoVisit; visit = visits_[visit].after) find(visit);
    }
    return std::move(arrivals_);
  }

 private:
  /// The visit that must have begun, a lag after which this one can: that of the robot that
  /// was here before, at the cell where it went next. kNoVisit if no robot was.
  VisitId leader(const Visit& visit) const {
    if (visit.before_here == kNoVisit) return kNoVisit;
    return visits_[visit.before_here].after;
  }

  Cell direction(VisitId to) const {
    const Cell here = grid_.cell(visits_[to].cell);
    const Cell before = grid_.cell(visits_[visits_[to].before].cell);
    return {here.x - before.x, here.y - before.y};
  }

  void find(VisitId wanted) {
    waiting_.assign(1, wanted);
    while (!waiting_.empty()) {
      const VisitId id = waiting_.back();
      const Visit& visit = visits_[id];
      const VisitId ahead = known_[id] != 0 ? kNoVisit : leader(visit);
      if (known_[id] != 0) {
        waiting_.pop_back();
      } else if (!is_known_or_begin(visit.before)) {
        waiting_.push_back(visit.before);
      } else if (ahead != kNoVisit && !is_known_or_begin(ahead)) {
        waiting_.push_back(ahead);
      } else {
        arrivals_[id] = arrivals_[visit.before] + kUnitMove;
        if (ahead != kNoVisit) {
          const ExactTime after_leader =
              arrivals_[ahead] - kUnitMove + follow_lag(direction(ahead), direction(id));
          if (arrivals_[id] < after_leader) arrivals_[id] = after_leader;
        }
        known_[id] = 1;
        waiting_.pop_back();
      }
    }
  }

  /// Robots are at their starts at time 0.
  bool is_known_or_begin(VisitId id) const { return known_[id] != 0 || visits_[id].before == kNoVisit; }

  const FreeGrid& grid_;
  const Visits& visits_;
  std::vector<ExactTime> arrivals_;
  std::vector<std::uint8_t> known_;
  std::vector<VisitId> waiting_;
};

}  // namespace

ExactTime follow_lag(Cell left, Cell entered) {
  constexpr ExactTime kSameDirection{1, 0};
  constexpr ExactTime kRightAngle{0, 1};
  constexpr ExactTime kOpposite{2, 0};
  if (left == entered) return kSameDirection;
  return left.x * entered.x + left.y * entered.y == 0 ? kRightAngle : kOpposite;
}

std::vector<ExactTime> earliest_arrivals(const FreeGrid& grid, const Visits& visits) {
  return LongestPaths(grid, visits).all();
}

Solution timed_motions(const FreeGrid& grid, const Visits& visits, const std::vector<ExactTime>& arrivals,
                       double unit_move_s) {
  Solution solution;
  solution.trajectories.resize(visits.robots());
  for (RobotId robot = 0; robot < visits.robots(); ++robot) {
    Trajectory& trajectory = solution.trajectories[robot];
    VisitId here = visits.first_of(robot);
    trajectory.start = grid.cell(visits[here].cell);
    Cell last_step{0, 0};
    for (VisitId next = visits[here].after; next != kNoVisit;
         here = std::exchange(next, visits[next].after)) {
      const Cell from = grid.cell(visits[here].cell);
      const Cell to = grid.cell(visits[next].cell);
      const Cell step{to.x - from.x, to.y - from.y};
      const ExactTime departure = arrivals[next] - kUnitMove;
      const double end_s = arrivals[next].seconds(unit_move_s);
      std::vector<TimedMotion>& motions = trajectory.motions;
      const bool waits = arrivals[here] < departure;
      if (!waits && step == last_step) {
        motions.back().to = to;
        motions.back().end_s = end_s;
        continue;
      }
      // Different times of a plan differ by far more than rounding: a + b sqrt(2) is at least
      // 1 / (|a| + 2 |b|) away from 0.
      const double begin_s = departure.seconds(unit_move_s);
      if (waits) motions.push_back({trajectory.end_s(), begin_s, from, from});
      motions.push_back({trajectory.end_s(), end_s, from, to});
      last_step = step;
    }
  }
  return solution;
}

}  // namespace sipplab
