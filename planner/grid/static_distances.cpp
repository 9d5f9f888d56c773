#include "planner/grid/static_distances.hpp"

#include <algorithm>
#include <bit>
#include <cstdlib>
#include <numbers>
#include <utility>

#include "planner/geometry/interval.hpp"
#include "planner/grid/neighbourhood.hpp"

namespace sipplab {
namespace {

/// Two lengths of ways that differ by less, in cells, differ by the rounding of their sums.
constexpr double kRoundingCells = 1e-9;

/// At most the length of the straight line between the two, in cells, and quick: of all norms with an
/// octagon for a circle the greatest of those.
double length_bound(Cell a, Cell b) {
  const std::int32_t x = std::abs(a.x - b.x);
  const std::int32_t y = std::abs(a.y - b.y);
  return std::max(static_cast<double>(std::max(x, y)), static_cast<double>(x + y) / std::numbers::sqrt2);
}

}  // namespace

StaticDistances::StaticDistances(const GridMap& map, const LineOfSight& line_of_sight, StepTable& steps,
                                 int k)
    : map_(map), is_open_(map.blocked_count() == 0), line_of_sight_(line_of_sight), table_(steps), k_(k) {
  for (const Cell step : neighbourhood(k)) {
    steps_.push_back({step, step.y * std::ptrdiff_t{map.width()} + step.x, norm(centre(step))});
  }
}

void StaticDistances::set_goal(Cell goal, Cell towards) {
  goal_ = goal;
  towards_ = towards;
  spread_ = nullptr;
}

StaticDistances::Spread& StaticDistances::spread_of_goal() {
  const std::size_t index = map_.index(goal_);
  if (const auto known = spreads_.find(index); known != spreads_.end()) return known->second;
  const bool is_full = (spreads_.size() + 1) * map_.cell_count() * sizeof(double) > kMostKeptBytes;
  // The new one takes the memory of one that is forgotten.
  auto reused = is_full && !spreads_.empty() ? spreads_.extract(spreads_.begin()) : Spreads::node_type{};
  if (reused) reused.key() = index;
  Spread& spread = reused ? spreads_.insert(std::move(reused)).position->second : spreads_[index];
  spread.towards = towards_;
  spread.least_f = length_bound(goal_, towards_);
  spread.cells.assign(map_.cell_count(), kForever);
  spread.cells[index] = 0;
  spread.level = 0;
  for (std::vector<Open>& bucket : spread.buckets) bucket.clear();
  spread.buckets[0].push_back({0, goal_});
  spread.open = 1;
  return spread;
}

double StaticDistances::searched_detour_cells(Cell cell) {
  if (spread_ == nullptr) spread_ = &spread_of_goal();
  Spread& spread = *spread_;
  const std::size_t index = map_.index(cell);
  const double ahead = length_bound(cell, spread.towards) - spread.least_f;
  while (spread.cells[index] + ahead >= static_cast<double>(spread.level) && spread.open > 0) grow(spread);
  const double detour = spread.cells[index] - neighbourhood_distance(cell, goal_, k_);
  return detour > kRoundingCells ? detour : 0;
}

void StaticDistances::grow(Spread& spread) const {
  std::vector<Open>& bucket = spread.buckets[spread.level % kBuckets];
  // Cells are queued behind those that lead to them, in the same bucket as well; one whose way gets
  // shorter afterwards is queued again.
  for (std::size_t i = 0; i < bucket.size(); ++i) {
    const auto [cells, cell] = bucket[i];
    const std::size_t index = map_.index(cell);
    if (cells > spread.cells[index]) continue;
    for (std::uint32_t clear = table_.clear_steps(cell, index); clear != 0; clear &= clear - 1) {
      const Step& step = steps_[static_cast<std::size_t>(std::countr_zero(clear))];
      double& known =
          spread.cells[static_cast<std::size_t>(static_cast<std::ptrdiff_t>(index) + step.index_offset)];
      const double there = cells + step.cells;
      if (there >= known) continue;
      known = there;
      const Cell next{cell.x + step.cell.x, cell.y + step.cell.y};
      // By a rounding f may fall along a way.
      const double f = there + length_bound(next, spread.towards) - spread.least_f;
      const std::size_t level = std::max(static_cast<std::size_t>(std::max(f, 0.0)), spread.level);
      spread.buckets[level % kBuckets].push_back({there, next});
      ++spread.open;
    }
  }
  spread.open -= bucket.size();
  bucket.clear();
  ++spread.level;
}

}  // namespace sipplab
