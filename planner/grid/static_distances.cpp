#include "planner/grid/static_distances.hpp"

#include <algorithm>
#include <bit>
#include <cmath>
#include <utility>

#include "planner/grid/neighbourhood.hpp"
#include "sipplab/error.hpp"
#include "sipplab/geometry.hpp"

namespace sipplab {
namespace {

/// Cells. Path lengths that differ by less differ only by the rounding of their sums.
constexpr double kRoundingCells = 1e-9;

constexpr int kOctile = 3;

/// All of eight steps. In other neighbourhoods all steps are followed, and any of the bits stands for them.
constexpr std::uint64_t kAllSteps = 0xff;

/// Units of Length for each cell, and a little less: estimates by rounded lengths stay consistent.
constexpr double kConsistent = 4194304.0 * (1 - 0x1p-20);

}  // namespace

StaticDistances::StaticDistances(const GridMap& map, const LineOfSight& line_of_sight, StepTable& steps,
                                 int k)
    : map_(map),
      is_open_(map.blocked_count() == 0),
      line_of_sight_(line_of_sight),
      table_(steps),
      k_(k),
      is_canonical_(k == kOctile && line_of_sight.radius_cells() <= StepTable::kCellRadius) {
  for (const Cell step : neighbourhood(k)) {
    steps_.push_back({step, step.y * std::ptrdiff_t{map.width()} + step.x,
                      static_cast<Length>(norm(centre(step)) / kCellsPerUnit)});
  }
}

void StaticDistances::set_goal(Cell goal, Cell towards) {
  goal_ = goal;
  towards_ = towards;
  spread_ = nullptr;
}

inline std::size_t StaticDistances::estimate(const Spread& spread, Cell cell, Length length) const {
  const double rest = neighbourhood_distance(cell, spread.towards, k_) * kConsistent;
  return static_cast<std::size_t>((length + static_cast<Length>(rest)) >> kCellBits);
}

inline std::uint32_t StaticDistances::followers(std::size_t step, std::uint32_t clear_before) const {
  if (!is_canonical_) return static_cast<std::uint32_t>(kAllSteps);
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

StaticDistances::Spread& StaticDistances::spread_of_goal() {
  const std::size_t index = map_.index(goal_);
  if (const auto known = spreads_.find(index); known != spreads_.end()) return known->second;
  const bool is_full = (spreads_.size() + 1) * map_.cell_count() * sizeof(Known) > kMostKeptBytes;
  // The new spread takes the memory of a discarded one.
  auto reused = is_full && !spreads_.empty() ? spreads_.extract(spreads_.begin()) : Spreads::node_type{};
  if (reused) reused.key() = index;
  Spread& spread = reused ? spreads_.insert(std::move(reused)).position->second
                          : spreads_.try_emplace(index, arena_).first->second;
  spread.known.assign(map_.cell_count(), Known{});
  spread.known[index].length = 0;
  spread.known[index].pending = kAllSteps;
  for (ArenaVector<Cell>& bucket : spread.buckets) bucket.clear();
  spread.towards = towards_;
  spread.level = estimate(spread, goal_, 0);
  spread.buckets[spread.level % kBuckets].push_back(goal_);
  spread.open = 1;
  return spread;
}

double StaticDistances::searched_excess_cells(Cell cell) {
  if (spread_ == nullptr) spread_ = &spread_of_goal();
  const Known& known = spread_->known[map_.index(cell)];
  while ((known.length == kFar || estimate(*spread_, cell, known.length) >= spread_->level) &&
         spread_->open > 0) {
    grow(*spread_);
  }
  if (known.length == kFar) return kForever;
  const double excess =
      static_cast<double>(known.length) * kCellsPerUnit - neighbourhood_distance(cell, goal_, k_);
  return excess > kRoundingCells ? excess : 0;
}

const StaticDistances::Step& StaticDistances::step_to_goal(Cell cell) const {
  const std::size_t index = map_.index(cell);
  const Length length = spread_->known[index].length;
  const auto leads_on = [&](const Step& step) {
    const auto next = static_cast<std::size_t>(static_cast<std::ptrdiff_t>(index) + step.index_offset);
    return spread_->known[next].length + step.length == length;
  };
  std::uint32_t clear = table_.clear_steps(cell, index);
  while (clear != 0) {
    const Step& step = steps_[static_cast<std::size_t>(std::countr_zero(clear))];
    if (leads_on(step)) return step;
    clear &= clear - 1;
  }
  PLANNER_ASSERT(false);
  return steps_[0];
}

Cell StaticDistances::turning_point(Cell cell) {
  if (searched_excess_cells(cell) == kForever) return cell;
  Cell seen = cell;
  Cell at = cell;
  for (const Step* before = nullptr; at != goal_;) {
    const Step& step = step_to_goal(at);
    if (before != nullptr && before != &step) {
      if (!line_of_sight_.is_clear(cell, at)) break;
      seen = at;
    }
    before = &step;
    at = {at.x + step.cell.x, at.y + step.cell.y};
  }
  return seen;
}

void StaticDistances::grow(Spread& spread) const {
  ArenaVector<Cell>& bucket = spread.buckets[spread.level % kBuckets];
  while (!bucket.empty()) {
    const Cell cell = bucket.back();
    bucket.pop_back();
    --spread.open;
    const std::size_t index = map_.index(cell);
    Known& known = spread.known[index];
    const std::uint32_t clear = table_.clear_steps(cell, index);
    const auto pending = static_cast<std::uint32_t>(known.pending);
    known.followed = (known.followed | pending) & kAllSteps;
    known.pending = 0;
    for (std::uint32_t left = clear & (is_canonical_ || pending == 0 ? pending : UINT32_MAX); left != 0;
         left &= left - 1) {
      const auto i = static_cast<std::size_t>(std::countr_zero(left));
      const Step& step = steps_[i];
      Known& next =
          spread.known[static_cast<std::size_t>(static_cast<std::ptrdiff_t>(index) + step.index_offset)];
      const Length there = known.length + step.length;
      if (there > next.length) continue;
      const bool is_queued = next.pending != 0 && there == next.length;
      if (there < next.length) {
        next.length = there & kFar;
        next.pending = next.followed = 0;
      }
      next.pending = (next.pending | (followers(i, clear) & ~next.followed)) & kAllSteps;
      if (is_queued || next.pending == 0) continue;
      const Cell place{cell.x + step.cell.x, cell.y + step.cell.y};
      spread.buckets[estimate(spread, place, there) % kBuckets].push_back(place);
      ++spread.open;
    }
  }
  ++spread.level;
}

}  // namespace sipplab
