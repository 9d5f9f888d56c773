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
void add_unsafe(const BisectedSpan& span, std::vector<OpenInterval>& unsafe) {
  if (span.empty) return;
  unsafe.push_back({span.contact_begin ? span.begin_s + kSlotS : span.begin_s - kSlotS,
                    span.contact_end ? span.end_s - kSlotS : span.end_s + kSlotS});
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

struct Label {
  Cell cell;
  Interval interval;
  double arrival_s = kForever;
  bool settled = false;
};

class Search {
 public:
  Search(const GridMap& map, const std::vector<MovingDisk>& disks, const LoneRobot& robot)
      : map_(map), disks_(disks), robot_(robot), steps_(mediant_neighbourhood(robot.connectedness)) {
    for (std::size_t i = 0; i < map.cell_count(); ++i) {
      const Cell cell = map.cell(i);
      if (!exactly_legal(map, robot.radius, cell)) continue;
      std::vector<OpenInterval> unsafe;
      for (const MovingDisk& disk : disks) {
        add_unsafe(bisect_collision(centre(cell), disk, reach(disk)), unsafe);
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

  void leave(const Label& from, Cell to) {
    if (!exactly_legal(map_, robot_.radius, to) || !exactly_clear(map_, robot_.radius, from.cell, to)) return;
    const Move move(Displacement(centre(from.cell), centre(to)), robot_.speed);
    std::vector<OpenInterval> unsafe;
    for (const MovingDisk& disk : disks_) add_unsafe(bisect_departures(move, disk, reach(disk)), unsafe);
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

std::optional<double> earliest_arrival_s(const GridMap& map, const std::vector<MovingDisk>& disks,
                                         const LoneRobot& robot) {
  return Search(map, disks, robot).run();
}

}  // namespace sipplab
