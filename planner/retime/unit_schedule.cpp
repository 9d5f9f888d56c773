#include "planner/retime/unit_schedule.hpp"

#include <cmath>
#include <optional>
#include <utility>

#include "planner/core/tolerances.hpp"
#include "planner/retime/longest_paths.hpp"
#include "sipplab/error.hpp"

namespace sipplab {
namespace {

/// Unit moves. Sums of lags of different events differ by more, where they differ at all and are not exact;
/// rounding of a thousand lags is far below.
constexpr double kUnitRounding = 1e-9;

/// Times of disks that touch at 1, in unit moves.
struct ExactClock {
  using Time = ExactTime;
  static constexpr ExactTime kUnitMove{1, 0};
  ExactTime lag(Cell left, Cell entered) const { return follow_lag(left, entered); }
  bool is_later(ExactTime a, ExactTime b) const { return b < a; }
  double seconds(ExactTime time, double unit_move_s) const { return time.seconds(unit_move_s); }
};

/// follow_lag() of disks of this reach, in moves.
double lag_of(Cell left, Cell entered, double reach) {
  constexpr double kSameCells = 1;
  const bool is_opposite = left.x == -entered.x && left.y == -entered.y;
  return follow_lag(left, entered).seconds(is_opposite ? kSameCells : reach);
}

/// And of smaller ones.
struct RealClock {
  using Time = double;
  static constexpr double kUnitMove = 1;
  double reach;
  double lag(Cell left, Cell entered) const { return lag_of(left, entered, reach); }
  bool is_later(double a, double b) const { return a > b + kUnitRounding; }
  double seconds(double time, double unit_move_s) const { return time * unit_move_s; }
};

/// And in steps.
struct StepClock {
  using Time = std::int64_t;
  static constexpr std::int64_t kUnitMove = 1;
  std::int64_t lag(Cell, Cell) const { return kUnitMove; }
  bool is_later(std::int64_t a, std::int64_t b) const { return a > b; }
};

/// And in ticks.
struct TickClock {
  using Time = std::int64_t;
  static constexpr std::int64_t kUnitMove = kTicksPerMove;
  double reach;
  std::int64_t lag(Cell left, Cell entered) const { return follow_ticks(left, entered, reach); }
  bool is_later(std::int64_t a, std::int64_t b) const { return a > b; }
};

/// Visits as events: what each waits for.
template <class Clock>
class VisitGraph {
 public:
  using Time = typename Clock::Time;

  VisitGraph(const Clock& clock, const FreeGrid& grid, const Visits& visits)
      : clock_(clock), grid_(grid), visits_(visits) {}

  std::size_t size() const { return visits_.size(); }
  Time earliest(EventId) const { return {}; }
  bool is_later(Time a, Time b) const { return clock_.is_later(a, b); }

  /// The robot's visit before, and the visit that must have begun, a lag after which this one can: that of
  /// the robot that was here before, at the cell where it went next.
  std::optional<Lag<Time>> lag(VisitId id, std::uint32_t n) const {
    const Visit& visit = visits_[id];
    if (visit.before == kNoVisit) return std::nullopt;  // at time 0
    if (n == 0) return Lag<Time>{visit.before, Clock::kUnitMove};
    if (n > 1 || visit.before_here == kNoVisit) return std::nullopt;
    const VisitId ahead = visits_[visit.before_here].after;
    PLANNER_ASSERT(ahead != kNoVisit);
    return Lag<Time>{ahead, clock_.lag(direction(ahead), direction(id)) - Clock::kUnitMove};
  }

 private:
  Cell direction(VisitId to) const {
    const Cell here = grid_.cell(visits_[to].cell);
    const Cell before = grid_.cell(visits_[visits_[to].before].cell);
    return {here.x - before.x, here.y - before.y};
  }

  const Clock& clock_;
  const FreeGrid& grid_;
  const Visits& visits_;
};

/// `motions`: memory.
template <class Clock>
Trajectory timed(const Clock& clock, const FreeGrid& grid, const Visits& visits,
                 const std::vector<typename Clock::Time>& arrivals, VisitId here, double unit_move_s,
                 std::vector<TimedMotion>& motions) {
  const Cell start = grid.cell(visits[here].cell);
  motions.clear();
  Cell last_step{0, 0};
  for (VisitId next = visits[here].after; next != kNoVisit; here = std::exchange(next, visits[next].after)) {
    const Cell from = grid.cell(visits[here].cell);
    const Cell to = grid.cell(visits[next].cell);
    const Cell step{to.x - from.x, to.y - from.y};
    const typename Clock::Time departure = arrivals[next] - Clock::kUnitMove;
    const double end_s = clock.seconds(arrivals[next], unit_move_s);
    const bool waits = clock.is_later(departure, arrivals[here]);
    if (!waits && step == last_step) {
      motions.back().to = to;
      motions.back().end_s = end_s;
      continue;
    }
    // Different times of a plan differ by far more than rounding: a + b sqrt(2) is at least
    // 1 / (|a| + 2 |b|) away from 0.
    const auto now_s = [&] { return motions.empty() ? 0 : motions.back().end_s; };
    if (waits) motions.push_back({now_s(), clock.seconds(departure, unit_move_s), from, from});
    motions.push_back({now_s(), end_s, from, to});
    last_step = step;
  }
  return {start, motions};
}

template <class Clock>
UnitSchedule schedule_by(const Clock& clock, const FreeGrid& grid, const Visits& visits, double unit_move_s) {
  LeastTimes<typename Clock::Time> least = least_times(VisitGraph<Clock>(clock, grid, visits));
  UnitSchedule schedule;
  schedule.circle = std::move(least.circle);
  if (!schedule.circle.empty()) return schedule;
  schedule.arrivals_s.reserve(least.times.size());
  for (const auto& time : least.times) schedule.arrivals_s.push_back(clock.seconds(time, unit_move_s));
  schedule.solution.trajectories.reserve(visits.robots());
  std::vector<TimedMotion> motions;
  for (RobotId robot = 0; robot < visits.robots(); ++robot) {
    schedule.solution.trajectories.push_back(
        timed(clock, grid, visits, least.times, visits.first_of(robot), unit_move_s, motions));
  }
  return schedule;
}

}  // namespace

ExactTime follow_lag(Cell left, Cell entered) {
  constexpr ExactTime kSameDirection{1, 0};
  constexpr ExactTime kRightAngle{0, 1};
  constexpr ExactTime kOpposite{2, 0};
  if (left == entered) return kSameDirection;
  return left.x * entered.x + left.y * entered.y == 0 ? kRightAngle : kOpposite;
}

std::int32_t follow_ticks(Cell left, Cell entered, double reach_cells) {
  return static_cast<std::int32_t>(
      std::ceil((lag_of(left, entered, reach_cells) - kUnitRounding) * kTicksPerMove));
}

UnitSchedule unit_schedule(const FreeGrid& grid, const Visits& visits, double reach_cells,
                           double unit_move_s) {
  PLANNER_ASSERT(0 < reach_cells && reach_cells <= 1 + kTouchDepthCells);
  if (reach_cells < 1 - kTouchDepthCells) {
    return schedule_by(RealClock{reach_cells}, grid, visits, unit_move_s);
  }
  return schedule_by(ExactClock{}, grid, visits, unit_move_s);
}

std::vector<std::int64_t> unit_steps(const FreeGrid& grid, const Visits& visits) {
  return least_times(VisitGraph<StepClock>(StepClock{}, grid, visits)).times;
}

std::vector<std::int64_t> unit_ticks(const FreeGrid& grid, const Visits& visits, double reach_cells) {
  return least_times(VisitGraph<TickClock>(TickClock{reach_cells}, grid, visits)).times;
}

}  // namespace sipplab
