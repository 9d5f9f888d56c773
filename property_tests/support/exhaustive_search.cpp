// Label setting over cells and safe intervals; see exhaustive_search.hpp.
#include "property_tests/support/exhaustive_search.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>

#include "property_tests/support/distance_oracle.hpp"

namespace sipplab {
namespace {

/// Seconds by which unsafe spans shrink at contacts and grow where a motion ends, so that
/// slots of zero width survive rounding and motions leave no gaps. Larger than any
/// rounding, smaller than any true difference on the lattices of the tests.
constexpr double kSlotS = 1e-8;

/// Unsafe times that the spans found by bisection give.
void add_unsafe(const BisectedSpan& span, Contacts contacts, std::vector<OpenInterval>& unsafe) {
  if (span.empty) return;
  const bool allowed = contacts == Contacts::kAllowed;
  unsafe.push_back({allowed && span.contact_begin ? span.begin_s + kSlotS : span.begin_s - kSlotS,
                    allowed && span.contact_end ? span.end_s - kSlotS : span.end_s + kSlotS});
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

/// Cells. At the very edge of what is pardoned a way may be judged either way.
constexpr double kEdgeCells = 1e-6;

/// Where along the endless line through both, in cells from `from`, it is within reach of a
/// place. Empty where the way itself never is; REQUIRES: the way has a length.
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

struct Label {
  Cell cell;
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
        steps_(mediant_neighbourhood(robot.connectedness)) {
    for (std::size_t i = 0; i < map.cell_count(); ++i) {
      const Cell cell = map.cell(i);
      if (!exactly_legal(map, robot.radius, cell) || is_forbidden(cell, cell)) continue;
      std::vector<OpenInterval> unsafe;
      for (const MovingDisk& disk : disks) {
        add_unsafe(bisect_collision(centre(cell), disk, reach(disk)), contacts_, unsafe);
      }
      for (const Interval& interval : safe_between(unsafe)) {
        const bool at_start = cell == robot.start && interval.contains(0);
        labels_.push_back({cell, interval, at_start ? 0 : kForever, false});
      }
    }
  }

  std::optional<double> run() {
    while (true) {
      Label* next = nullptr;
      for (Label& label : labels_) {
        if (!label.settled && (!next || label.arrival_s < next->arrival_s)) next = &label;
      }
      if (!next || next->arrival_s == kForever) return std::nullopt;
      if (next->cell == robot_.goal && next->interval.end_s == kForever) return next->arrival_s;
      next->settled = true;
      for (const Cell step : steps_) leave(*next, {next->cell.x + step.x, next->cell.y + step.y});
    }
  }

 private:
  double reach(const MovingDisk& disk) const { return robot_.radius.value() + disk.radius; }

  bool is_forbidden(Cell from, Cell to) const {
    return std::any_of(forbidden_.begin(), forbidden_.end(), [&](const Forbidden& forbidden) {
      const double tolerated = contacts_ == Contacts::kAllowed ? kEdgeCells : -kEdgeCells;
      return intrusion_cells(forbidden, centre(from), centre(to)) > tolerated;
    });
  }

  void leave(const Label& from, Cell to) {
    if (!exactly_legal(map_, robot_.radius, to) || !exactly_clear(map_, robot_.radius, from.cell, to)) return;
    if (is_forbidden(from.cell, to)) return;
    const Move move(Displacement(centre(from.cell), centre(to)), robot_.speed);
    std::vector<OpenInterval> unsafe;
    for (const MovingDisk& disk : disks_)
      add_unsafe(bisect_departures(move, disk, reach(disk)), contacts_, unsafe);
    const std::vector<Interval> departures = safe_between(unsafe);
    for (Label& target : labels_) {
      if (target.cell != to || target.settled) continue;
      const double first_s = std::max(from.arrival_s, target.interval.begin_s - move.duration);
      const double last_s = std::min(from.interval.end_s, target.interval.end_s - move.duration);
      for (const Interval& departure : departures) {
        const double departure_s = std::max(first_s, departure.begin_s);
        if (departure_s > std::min(last_s, departure.end_s)) continue;
        target.arrival_s = std::min(target.arrival_s, departure_s + move.duration);
        break;
      }
    }
  }

  const GridMap& map_;
  const std::vector<MovingDisk>& disks_;
  const LoneRobot& robot_;
  const std::vector<Forbidden>& forbidden_;
  Contacts contacts_;
  std::vector<Cell> steps_;
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
