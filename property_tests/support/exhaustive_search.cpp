// Label setting over cells and safe intervals; see exhaustive_search.hpp.
#include "property_tests/support/exhaustive_search.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <optional>

#include "property_tests/support/distance_oracle.hpp"

namespace sipplab {
namespace {

/// Seconds by which unsafe spans shrink at contacts and grow at the end of a motion, so that
/// slots of zero width survive rounding and motions leave no gaps. Larger than any
/// rounding, smaller than any true difference on the lattices of the tests.
constexpr double kSlotS = 1e-8;

/// Unsafe times that the spans found by bisection give, `extra_s` sooner and later.
void add_unsafe(const BisectedSpan& span, Contacts contacts, double extra_s,
                std::vector<OpenInterval>& unsafe) {
  if (span.empty) return;
  const bool allowed = contacts == Contacts::kAllowed;
  const double begin_s = span.begin_s - extra_s;
  const double end_s = span.end_s + extra_s;
  unsafe.push_back({allowed && span.contact_begin ? begin_s + kSlotS : begin_s - kSlotS,
                    allowed && span.contact_end ? end_s - kSlotS : end_s + kSlotS});
}

/// Whether the boxes around a path and around the disk's are within reach. If not, the two need no bisection.
bool may_meet(Vec2 from, Vec2 to, const MovingDisk& disk, double reach) {
  const auto gap = [](double a, double b, double c, double d) {
    return std::max(std::min(a, b) - std::max(c, d), std::min(c, d) - std::max(a, b));
  };
  return gap(from.x, to.x, disk.path.from.x, disk.path.to.x) < reach &&
         gap(from.y, to.y, disk.path.from.y, disk.path.to.y) < reach;
}

/// What the unsafe spans leave of [0, infinity).
std::vector<Interval> safe_between(std::vector<OpenInterval> unsafe) {
  std::sort(unsafe.begin(), unsafe.end(),
            [](const OpenInterval& a, const OpenInterval& b) { return a.begin_s < b.begin_s; });
  std::vector<Interval> safe;
  double free_from_s = 0;
  for (const OpenInterval& span : unsafe) {
    if (span.begin_s >= free_from_s) safe.push_back({free_from_s, span.begin_s});
    free_from_s = std::max(free_from_s, span.end_s);
  }
  if (free_from_s < kForever) safe.push_back({free_from_s, kForever});
  return safe;
}

/// Cells. Less than a contact counts as apart.
constexpr double kTouchCells = 1e-7;

/// Cells. At the very edge of what is pardoned a path may be judged either way.
constexpr double kEdgeCells = 1e-6;

/// Where along the endless line through both, in cells from `from`, it is within reach of a
/// place. Empty if the move itself never is; REQUIRES: the move has a length.
struct Within {
  double begin = 0;
  double end = 0;
  bool empty = true;
};

Within within(Vec2 place, double reach, Vec2 from, Vec2 to) {
  const double length = norm(to - from);
  const Vec2 apart = place - from;
  const Vec2 along{(to.x - from.x) / length, (to.y - from.y) / length};
  const double nearest = apart.x * along.x + apart.y * along.y;
  const double aside = apart.x * along.y - apart.y * along.x;
  if (std::abs(aside) >= reach) return {};
  const double half = std::sqrt(reach * reach - aside * aside);
  return {nearest - half, nearest + half, nearest - half > length || nearest + half < 0};
}

/// Degrees. Of a direction of the grid, by its tangent within a quarter.
double direction_deg(Cell step) {
  double quarters = 0;
  Cell turned = step;  // until it points right or up, with y growing downwards
  while (!(turned.x > 0 && turned.y <= 0)) {
    turned = {-turned.y, turned.x};
    quarters += 1;
  }
  return 90 * quarters + std::atan(static_cast<double>(-turned.y) / turned.x) * (180 / std::acos(-1.0));
}

/// Degrees, the shorter way round.
double between_deg(double a, double b) { return std::abs(std::remainder(a - b, 360)); }

struct Label {
  Cell cell;
  std::size_t heading;  ///< position in Search::headings_deg_
  Interval interval;
  double arrival_s = kForever;
  bool settled = false;
};

class Search {
 public:
  Search(const GridMap& map, const std::vector<MovingDisk>& disks, const LoneRobot& robot,
         const std::vector<Forbidden>& forbidden, Contacts contacts)
      : map_(map),
        disks_(disks),
        robot_(robot),
        forbidden_(forbidden),
        contacts_(contacts),
        steps_(mediant_neighbourhood(robot.connectedness)),
        departures_(map.cell_count() * steps_.size()) {
    // Without turning one heading stands for all; else each step's, and that of the start.
    if (robot.turning) {
      for (const Cell step : steps_) headings_deg_.push_back(direction_deg(step));
    }
    headings_deg_.push_back(robot.turning ? robot.turning->start_deg : 0);
    for (std::size_t i = 0; i < map.cell_count(); ++i) {
      const Cell cell = map.cell(i);
      if (!exactly_legal(map, robot.radius, cell) || is_forbidden(cell, cell)) continue;
      std::vector<OpenInterval> unsafe;
      for (const MovingDisk& disk : disks) {
        if (!may_meet(centre(cell), centre(cell), disk, reach(disk))) continue;
        add_unsafe(bisect_collision(centre(cell), disk, reach(disk)), contacts_, robot.extra_time_s, unsafe);
      }
      for (const Interval& interval : safe_between(unsafe)) {
        const bool at_start = cell == robot.start && interval.contains(0);
        for (std::size_t heading = 0; heading < headings_deg_.size(); ++heading) {
          const bool faces_start = heading + 1 == headings_deg_.size();
          labels_.push_back({cell, heading, interval, at_start && faces_start ? 0 : kForever, false});
        }
      }
    }
  }

  std::optional<double> run() {
    double best_s = kForever;  // of labels at the goal, their last turn done
    while (true) {
      Label* next = nullptr;
      for (Label& label : labels_) {
        if (!label.settled && (!next || label.arrival_s < next->arrival_s)) next = &label;
      }
      if (!next || next->arrival_s == kForever || next->arrival_s >= best_s) break;
      if (next->cell == robot_.goal && next->interval.end_s == kForever) {
        best_s = std::min(best_s, next->arrival_s + last_turn_s(*next));
      }
      next->settled = true;
      for (std::size_t step = 0; step < steps_.size(); ++step) leave(*next, step);
    }
    if (best_s == kForever) return std::nullopt;
    return best_s;
  }

 private:
  double turn_s(double from_deg, double to_deg) const {
    return robot_.turning ? between_deg(from_deg, to_deg) / robot_.turning->deg_per_s : 0;
  }
  double last_turn_s(const Label& label) const {
    const bool matters = robot_.turning && robot_.turning->goal_deg;
    return matters ? turn_s(headings_deg_[label.heading], *robot_.turning->goal_deg) : 0;
  }
  double reach(const MovingDisk& disk) const { return robot_.radius.value() + disk.radius; }

  bool is_forbidden(Cell from, Cell to) const {
    return std::any_of(forbidden_.begin(), forbidden_.end(), [&](const Forbidden& forbidden) {
      const double tolerated = contacts_ == Contacts::kAllowed ? kEdgeCells : -kEdgeCells;
      const double reach = forbidden.reach + (from == to ? 0 : robot_.extra_reach_cells);
      return intrusion_cells({forbidden.place, reach, forbidden.pardoned}, centre(from), centre(to)) >
             tolerated;
    });
  }

  void leave(const Label& from, std::size_t step) {
    const Cell to{from.cell.x + steps_[step].x, from.cell.y + steps_[step].y};
    const std::size_t heading = robot_.turning ? step : 0;
    const double ready_s = from.arrival_s + turn_s(headings_deg_[from.heading], headings_deg_[heading]) +
                           robot_.wait_before_move_s;
    auto& departures = departures_[map_.index(from.cell) * steps_.size() + step];
    if (!departures) departures = safe_departures(from.cell, to);
    if (departures->empty()) return;
    const Move move = move_of(from.cell, to);
    for (Label& target : labels_) {
      if (target.cell != to || target.heading != heading || target.settled) continue;
      const double first_s = std::max(ready_s, target.interval.begin_s - move.duration);
      const double last_s = std::min(from.interval.end_s, target.interval.end_s - move.duration);
      for (const Interval& departure : *departures) {
        const double departure_s = std::max(first_s, departure.begin_s);
        if (departure_s > std::min(last_s, departure.end_s)) continue;
        target.arrival_s = std::min(target.arrival_s, departure_s + move.duration);
        break;
      }
    }
  }

  Move move_of(Cell from, Cell to) const { return {Displacement(centre(from), centre(to)), robot_.speed}; }

  /// Times at which the robot may set out; none where the map or a start does not let it through.
  std::vector<Interval> safe_departures(Cell from, Cell to) const {
    if (!exactly_legal(map_, robot_.radius, to) || !exactly_clear(map_, robot_.radius, from, to)) return {};
    if (is_forbidden(from, to)) return {};
    std::vector<OpenInterval> unsafe;
    for (const MovingDisk& disk : disks_) {
      const double apart = reach(disk) + robot_.extra_reach_cells;
      if (!may_meet(centre(from), centre(to), disk, apart)) continue;
      add_unsafe(bisect_departures(move_of(from, to), disk, apart), contacts_, robot_.extra_time_s, unsafe);
    }
    return safe_between(unsafe);
  }

  const GridMap& map_;
  const std::vector<MovingDisk>& disks_;
  const LoneRobot& robot_;
  const std::vector<Forbidden>& forbidden_;
  Contacts contacts_;
  std::vector<Cell> steps_;
  std::vector<std::optional<std::vector<Interval>>> departures_;  ///< safe, by cell and step
  std::vector<double> headings_deg_;
  std::vector<Label> labels_;
};

}  // namespace

std::vector<Cell> mediant_neighbourhood(int k) {
  std::vector<Cell> steps = {{1, 0}, {0, 1}, {-1, 0}, {0, -1}};
  for (int split = 2; split < k; ++split) {
    std::vector<Cell> finer;
    for (std::size_t i = 0; i < steps.size(); ++i) {
      const Cell next = steps[(i + 1) % steps.size()];
      finer.push_back(steps[i]);
      finer.push_back({steps[i].x + next.x, steps[i].y + next.y});
    }
    steps = finer;
  }
  return steps;
}

double intrusion_cells(const Forbidden& forbidden, Vec2 from, Vec2 to) {
  const double length = norm(to - from);
  if (length == 0) {
    if (norm(forbidden.place - from) >= forbidden.reach - kTouchCells) return -forbidden.reach;
    return norm(forbidden.pardoned - from) - forbidden.reach;
  }
  const Within inside = within(forbidden.place, forbidden.reach - kTouchCells, from, to);
  if (inside.empty) return -forbidden.reach;
  const double begin = std::max(0.0, inside.begin);
  const double end = std::min(length, inside.end);
  const Within pardoned = within(forbidden.pardoned, forbidden.reach, from, to);
  if (pardoned.empty) return end - begin;
  return std::max(pardoned.begin - begin, end - pardoned.end);
}

std::optional<double> earliest_arrival_s(const GridMap& map, const std::vector<MovingDisk>& disks,
                                         const LoneRobot& robot, const std::vector<Forbidden>& forbidden,
                                         Contacts contacts) {
  return Search(map, disks, robot, forbidden, contacts).run();
}

}  // namespace sipplab
