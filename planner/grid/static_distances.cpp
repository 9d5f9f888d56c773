#include "planner/grid/static_distances.hpp"

#include <algorithm>
#include <bit>
#include <cmath>
#include <utility>

#include "planner/grid/neighbourhood.hpp"
#include "sipplab/geometry.hpp"

namespace sipplab {
namespace {

/// Cells. Path lengths that differ by less differ only by the rounding of their sums.
constexpr double kRoundingCells = 1e-9;

/// Cells. The largest radius for which a step to one of eight neighbours is clear if and only if all cells
/// that it touches are free.
constexpr double kCellRadius = 0.5;

constexpr int kOctile = 3;

}  // namespace

StaticDistances::StaticDistances(const GridMap& map, const LineOfSight& line_of_sight, StepTable& steps,
                                 int k)
    : map_(map),
      is_open_(map.blocked_count() == 0),
      line_of_sight_(line_of_sight),
      table_(steps),
      k_(k),
      is_canonical_(k == kOctile && line_of_sight.radius_cells() <= kCellRadius) {
  for (const Cell step : neighbourhood(k)) {
    steps_.push_back({step, step.y * std::ptrdiff_t{map.width()} + step.x,
                      static_cast<Length>(std::ldexp(norm(centre(step)), kCellBits))});
  }
}

void StaticDistances::set_goal(Cell goal) {
  goal_ = goal;
  spread_ = nullptr;
}

StaticDistances::Spread& StaticDistances::spread_of_goal() {
  const std::size_t index = map_.index(goal_);
  if (const auto known = spreads_.find(index); known != spreads_.end()) return known->second;
  constexpr std::size_t kBytes = sizeof(Length) + sizeof(std::uint32_t);
  const bool is_full = (spreads_.size() + 1) * map_.cell_count() * kBytes > kMostKeptBytes;
  // The new spread takes the memory of a discarded one.
  auto reused = is_full && !spreads_.empty() ? spreads_.extract(spreads_.begin()) : Spreads::node_type{};
  if (reused) reused.key() = index;
  Spread& spread = reused ? spreads_.insert(std::move(reused)).position->second
                          : spreads_.try_emplace(index, arena_).first->second;
  spread.lengths.assign(map_.cell_count(), kFar);
  spread.steps.assign(map_.cell_count(), 0);
  spread.lengths[index] = 0;
  spread.steps[index] = UINT32_MAX;
  spread.level = 0;
  for (ArenaVector<Cell>& bucket : spread.buckets) bucket.clear();
  spread.buckets[0].push_back(goal_);
  spread.open = 1;
  return spread;
}

double StaticDistances::searched_excess_cells(Cell cell) {
  if (spread_ == nullptr) spread_ = &spread_of_goal();
  const Length& length = spread_->lengths[map_.index(cell)];
  while (length >> kCellBits >= spread_->level && spread_->open > 0) grow(*spread_);
  if (length == kFar) return kForever;
  const double excess =
      std::ldexp(static_cast<double>(length), -kCellBits) - neighbourhood_distance(cell, goal_, k_);
  return excess > kRoundingCells ? excess : 0;
}

std::uint32_t StaticDistances::followers(std::size_t step, std::uint32_t clear_before) const {
  if (!is_canonical_) return UINT32_MAX;
  constexpr std::size_t kStraight = 4;  // each of the other four lies between two of these
  const auto bit = [](std::size_t i) { return std::uint32_t{1} << i; };
  if (step >= kStraight) return bit(step) | bit(step - kStraight) | bit((step + 1) % kStraight);
  // Straight on; also to a side, if the path by a diagonal or by that side first was blocked.
  const std::size_t left = (step + 3) % kStraight;
  const std::size_t right = (step + 1) % kStraight;
  std::uint32_t steps = bit(step);
  if ((clear_before & bit(left)) == 0) steps |= bit(left) | bit(kStraight + left);
  if ((clear_before & bit(right)) == 0) steps |= bit(right) | bit(kStraight + step);
  return steps;
}

void StaticDistances::grow(Spread& spread) const {
  ArenaVector<Cell>& bucket = spread.buckets[spread.level % kBuckets];
  for (const Cell cell : bucket) {
    const std::size_t index = map_.index(cell);
    const Length length = spread.lengths[index];
    if (length >> kCellBits != spread.level) continue;  // found to be nearer and already expanded
    const std::uint32_t clear = table_.clear_steps(cell, index);
    for (std::uint32_t left = clear & std::exchange(spread.steps[index], 0); left != 0; left &= left - 1) {
      const auto i = static_cast<std::size_t>(std::countr_zero(left));
      const Step& step = steps_[i];
      const auto next = static_cast<std::size_t>(static_cast<std::ptrdiff_t>(index) + step.index_offset);
      const Length there = length + step.length;
      Length& known = spread.lengths[next];
      if (there > known) continue;
      std::uint32_t& steps = spread.steps[next];
      if (there == known) {
        steps |= followers(i, clear);
        continue;
      }
      const bool is_queued = known >> kCellBits == there >> kCellBits;
      known = there;
      steps = followers(i, clear);
      if (is_queued) continue;
      spread.buckets[(there >> kCellBits) % kBuckets].push_back({cell.x + step.cell.x, cell.y + step.cell.y});
      ++spread.open;
    }
  }
  spread.open -= bucket.size();
  bucket.clear();
  ++spread.level;
}

}  // namespace sipplab
