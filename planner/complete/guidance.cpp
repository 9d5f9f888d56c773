#include "planner/complete/guidance.hpp"

#include <algorithm>
#include <cstdlib>
#include <functional>
#include <utility>

namespace sipplab {
namespace {

/// How often each robot chooses its path. (Flowtime of the paper's warehouse with 128 robots, one to four
/// rounds: 4,810, 4,400, 4,420 s; of 1,000 robots in warehouse-10-20-10-2-1: 170,000, 167,000, 166,000 s.)
constexpr int kRounds = 2;

/// Costs while paths are chosen, in tenths of a step: of a move, and of each path against it.
constexpr std::uint32_t kStepCost = 10;
constexpr std::uint32_t kAgainstCost = 1;

std::size_t position_of(CellId cell, std::span<const CellId> among) {
  return static_cast<std::size_t>(std::find(among.begin(), among.end(), cell) - among.begin());
}

/// A queue of cells, cheapest first; ties by cell.
using Entry = std::pair<std::uint32_t, CellId>;
void push(std::vector<Entry>& heap, Entry entry) {
  heap.push_back(entry);
  std::push_heap(heap.begin(), heap.end(), std::greater<>());
}
Entry pop(std::vector<Entry>& heap) {
  std::pop_heap(heap.begin(), heap.end(), std::greater<>());
  const Entry entry = heap.back();
  heap.pop_back();
  return entry;
}

/// Paths that robots chose, counted by move.
class Traffic {
 public:
  explicit Traffic(const FreeGrid& grid)
      : grid_(grid), paths_(grid.size()), known_(grid.size()), seen_(grid.size(), 0), from_(grid.size()) {
    opposite_.resize(grid.size());
    for (CellId cell = 0; cell < grid.size(); ++cell) {
      const auto neighbours = grid.neighbours(cell);
      for (std::size_t i = 0; i < neighbours.size(); ++i) {
        opposite_[cell][i] = static_cast<std::uint8_t>(position_of(cell, grid.neighbours(neighbours[i])));
      }
    }
  }

  /// The path from start to goal that costs least around the others: A*.
  CellIds choose(CellId start, CellId goal) {
    ++search_;
    open_.clear();
    reach(start, 0, start, goal);
    while (open_.front().second != goal) {
      const auto [estimate, cell] = pop(open_);
      if (estimate != known_[cell] + least_cost(cell, goal)) continue;  // reached at less cost since
      const auto neighbours = grid_.neighbours(cell);
      for (std::size_t i = 0; i < neighbours.size(); ++i) {
        reach(neighbours[i], known_[cell] + cost(cell, i), cell, goal);
      }
    }
    CellIds path{goal};
    while (path.back() != start) path.push_back(from_[path.back()]);
    std::reverse(path.begin(), path.end());
    return path;
  }

  void count(const CellIds& path, std::int32_t times) {
    for (std::size_t i = 1; i < path.size(); ++i) {
      paths_[path[i - 1]][position_of(path[i], grid_.neighbours(path[i - 1]))] += times;
    }
  }

  MoveCosts costs() const {
    MoveCosts costs(grid_.size());
    for (CellId cell = 0; cell < grid_.size(); ++cell) {
      for (std::size_t i = 0; i < grid_.neighbours(cell).size(); ++i) {
        const std::uint32_t cost = kStepCost + kAgainstCost * against(cell, i);
        const std::uint32_t rounded = (2 * kFreeMoveCost * cost + kStepCost) / (2 * kStepCost);
        costs[cell][i] = static_cast<std::uint8_t>(std::min(rounded, kDearestMoveCost));
      }
    }
    return costs;
  }

 private:
  std::uint32_t against(CellId cell, std::size_t i) const {
    return static_cast<std::uint32_t>(paths_[grid_.neighbours(cell)[i]][opposite_[cell][i]]);
  }
  /// Of one more path: it meets those that come the other way, and so do those that go its way.
  std::uint32_t cost(CellId cell, std::size_t i) const {
    return kStepCost + kAgainstCost * against(cell, i) * (1 + static_cast<std::uint32_t>(paths_[cell][i]));
  }
  std::uint32_t least_cost(CellId cell, CellId goal) const {
    const Cell a = grid_.cell(cell);
    const Cell b = grid_.cell(goal);
    return kStepCost * static_cast<std::uint32_t>(std::abs(a.x - b.x) + std::abs(a.y - b.y));
  }
  void reach(CellId cell, std::uint32_t cost, CellId from, CellId goal) {
    if (seen_[cell] == search_ && known_[cell] <= cost) return;
    seen_[cell] = search_;
    known_[cell] = cost;
    from_[cell] = from;
    push(open_, {cost + least_cost(cell, goal), cell});
  }

  const FreeGrid& grid_;
  std::vector<std::array<std::int32_t, 4>> paths_;  ///< by cell and neighbour: chosen paths that move so
  std::vector<std::array<std::uint8_t, 4>>
      opposite_;  ///< by cell and neighbour: its place among the neighbour's
  // The current search.
  std::uint32_t search_ = 0;
  std::vector<std::uint32_t> known_;
  std::vector<std::uint32_t> seen_;
  CellIds from_;
  std::vector<Entry> open_;
};

}  // namespace

MoveCosts traffic_costs(const FreeGrid& grid, const CellIds& starts, const CellIds& goals,
                        const TimeLimits& limits) {
  Traffic traffic(grid);
  std::vector<CellIds> paths(starts.size());
  for (int round = 0; round < kRounds; ++round) {
    for (std::size_t robot = 0; robot < starts.size() && !limits.is_over(); ++robot) {
      traffic.count(paths[robot], -1);
      paths[robot] = traffic.choose(starts[robot], goals[robot]);
      traffic.count(paths[robot], 1);
    }
  }
  return traffic.costs();
}

GuidedDistances::GuidedDistances(const FreeGrid& grid, const CellIds& goals, const MoveCosts& costs)
    : grid_(grid),
      costs_to_(costs.size()),
      codes_(goals.size() * grid.size(), kUnknown),
      searches_(goals.size()) {
  for (CellId cell = 0; cell < grid.size(); ++cell) {
    const auto neighbours = grid.neighbours(cell);
    for (std::size_t i = 0; i < neighbours.size(); ++i) {
      costs_to_[cell][i] = costs[neighbours[i]][position_of(cell, grid.neighbours(neighbours[i]))];
    }
  }
  for (std::size_t robot = 0; robot < goals.size(); ++robot) {
    codes_[robot * grid.size() + goals[robot]] = 1;
    searches_[robot] = {1, {goals[robot]}};
  }
}

/// Goes on until the cost is known, and then for as many cells as it took to begin again.
int GuidedDistances::search(RobotId robot, CellId wanted) {
  std::uint8_t* const codes = &codes_[robot * grid_.size()];
  auto& [cost, rim] = searches_[robot];
  for (const CellId cell : rim) {
    const std::uint32_t below = (cost + kModulus + 1 - codes[cell]) % kModulus;
    look_beyond(cell, cost - below, codes);
  }
  const std::size_t begun = rim.size();
  for (std::size_t empty = 0; empty < queued_.size() && (codes[wanted] == kUnknown || rim.size() < 2 * begun);
       ++cost) {
    CellIds& cells = queued_[cost % queued_.size()];
    empty = cells.empty() ? empty + 1 : 0;
    for (const CellId cell : cells) {
      if (codes[cell] != kUnknown) continue;
      codes[cell] = static_cast<std::uint8_t>(1 + cost % kModulus);
      rim.push_back(cell);
      look_beyond(cell, cost, codes);
    }
    cells.clear();
  }
  for (CellIds& cells : queued_) cells.clear();
  std::erase_if(rim, [&](CellId cell) {
    const auto neighbours = grid_.neighbours(cell);
    return std::all_of(neighbours.begin(), neighbours.end(),
                       [&](CellId next) { return codes[next] != kUnknown; });
  });
  return codes[wanted];
}

void GuidedDistances::look_beyond(CellId cell, std::uint32_t cost, const std::uint8_t* codes) {
  const auto neighbours = grid_.neighbours(cell);
  for (std::size_t i = 0; i < neighbours.size(); ++i) {
    if (codes[neighbours[i]] != kUnknown) continue;
    queued_[(cost + costs_to_[cell][i]) % queued_.size()].push_back(neighbours[i]);
  }
}

}  // namespace sipplab
