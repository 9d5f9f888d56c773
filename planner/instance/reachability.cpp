// Which goals can be reached: see reachability.hpp.
#include "planner/instance/reachability.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <string>

#include "planner/core/tolerances.hpp"

namespace sipplab {
namespace {

/// The unit squares that a disk somewhere in cell (0, 0) overlaps, row by row.
struct Footprint {
  struct RowSpan {
    std::int32_t dy = 0;
    std::int32_t first_dx = 0;
    std::int32_t last_dx = 0;

    friend auto operator<=>(const RowSpan&, const RowSpan&) = default;
  };
  std::vector<RowSpan> rows;

  friend bool operator<(const Footprint& a, const Footprint& b) { return a.rows < b.rows; }
};

/// How far the point `from` is from the interval [cell - 0.5, cell + 0.5] on one axis.
double gap(double from, std::int32_t cell) {
  return std::max(0.0, std::abs(static_cast<double>(cell) - from) - 0.5);
}

/// Squares whose distance from `position` (an offset from the centre of cell (0, 0),
/// in cells) is below the radius by more than touching.
Footprint footprint(Vec2 position, double radius_cells) {
  Footprint result;
  const double reach = radius_cells - kTouchDepthCells;
  const auto most = static_cast<std::int32_t>(std::ceil(radius_cells)) + 1;
  for (std::int32_t dy = -most; dy <= most; ++dy) {
    Footprint::RowSpan span{dy, most + 1, -most - 1};
    for (std::int32_t dx = -most; dx <= most; ++dx) {
      if (norm({gap(position.x, dx), gap(position.y, dy)}) >= reach) continue;
      span.first_dx = std::min(span.first_dx, dx);
      span.last_dx = std::max(span.last_dx, dx);
    }
    if (span.first_dx <= span.last_dx) result.rows.push_back(span);
  }
  return result;
}

/// Answers in constant time whether a span of a row is free; cells outside of the
/// grid count as blocked, which keeps bodies inside.
class RowSums {
 public:
  explicit RowSums(const GridMap& map) : map_(map), stride_(static_cast<std::size_t>(map.width()) + 1) {
    blocked_before_.assign(stride_ * static_cast<std::size_t>(map.height()), 0);
    for (std::int32_t y = 0; y < map.height(); ++y) {
      const std::size_t row = stride_ * static_cast<std::size_t>(y);
      for (std::int32_t x = 0; x < map.width(); ++x) {
        const std::size_t at = row + static_cast<std::size_t>(x);
        blocked_before_[at + 1] =
            static_cast<std::uint16_t>(blocked_before_[at] + (map.is_blocked({x, y}) ? 1 : 0));
      }
    }
  }

  bool is_free(Cell cell, const Footprint& footprint) const {
    for (const Footprint::RowSpan& span : footprint.rows) {
      const std::int32_t y = cell.y + span.dy;
      const std::int32_t first_x = cell.x + span.first_dx;
      const std::int32_t last_x = cell.x + span.last_dx;
      if (y < 0 || y >= map_.height() || first_x < 0 || last_x >= map_.width()) return false;
      const std::size_t row = stride_ * static_cast<std::size_t>(y);
      if (blocked_before_[row + static_cast<std::size_t>(last_x) + 1] !=
          blocked_before_[row + static_cast<std::size_t>(first_x)]) {
        return false;
      }
    }
    return true;
  }

 private:
  static_assert(GridMap::kMaxSide <= UINT16_MAX, "a row's count of blocked cells fits 16 bits");

  const GridMap& map_;
  std::size_t stride_;
  std::vector<std::uint16_t> blocked_before_;  ///< per row, in the cells left of x
};

/// A cell that may be entered and has no number yet.
constexpr std::uint32_t kUnlabelled = UINT32_MAX;

/// Numbers the components of the kUnlabelled cells, joined over 4 or 8 neighbours,
/// from 1 on in row-major order of their first cells; what is 0 stays 0.
void label_components(std::vector<std::uint32_t>& labels, std::size_t width, bool diagonals) {
  const std::size_t height = labels.size() / width;
  std::vector<std::size_t> stack;
  std::uint32_t label = 0;
  for (std::size_t first = 0; first < labels.size(); ++first) {
    if (labels[first] != kUnlabelled) continue;
    labels[first] = ++label;
    stack.push_back(first);
    while (!stack.empty()) {
      const std::size_t x = stack.back() % width;
      const std::size_t y = stack.back() / width;
      stack.pop_back();
      for (std::size_t ny = y - (y > 0 ? 1 : 0); ny <= std::min(y + 1, height - 1); ++ny) {
        for (std::size_t nx = x - (x > 0 ? 1 : 0); nx <= std::min(x + 1, width - 1); ++nx) {
          if (!diagonals && nx != x && ny != y) continue;
          const std::size_t next = ny * width + nx;
          if (labels[next] != kUnlabelled) continue;
          labels[next] = label;
          stack.push_back(next);
        }
      }
    }
  }
}

std::vector<std::uint32_t> standing_components(const GridMap& map, const RowSums& sums,
                                               const Footprint& body) {
  std::vector<std::uint32_t> labels(map.cell_count(), 0);
  for (std::size_t i = 0; i < labels.size(); ++i) {
    if (sums.is_free(map.cell(i), body)) labels[i] = kUnlabelled;
  }
  label_components(labels, static_cast<std::size_t>(map.width()), false);
  return labels;
}

/// Small squares along one side of a cell, for curves that leave the lattice.
constexpr std::int32_t kParts = 4;
/// Small squares in all; beyond that the question stays open, to save seconds and gigabytes. Maps of
/// 1,000 x 1,000 cells are within.
constexpr std::size_t kMaxSmallSquares = std::size_t{1} << 24;

/// Components of the small squares in which some point might have clearance r: those whose centre has r minus
/// half their diagonal. Diagonal neighbours are joined, so a curve of the disk's centre never leaves a
/// component. Empty when the map is too large for this.
std::vector<std::uint32_t> wandering_components(const GridMap& map, const RowSums& sums,
                                                double radius_cells) {
  constexpr auto kPartsPerCell = static_cast<std::size_t>(kParts) * static_cast<std::size_t>(kParts);
  if (map.cell_count() > kMaxSmallSquares / kPartsPerCell) return {};
  constexpr double kSide = 1.0 / kParts;
  constexpr double kHalfDiagonal = kSide * 0.70710678118654757;

  std::vector<Footprint> footprints;
  const auto offset = [](std::int32_t part) { return (static_cast<double>(part) + 0.5) * kSide - 0.5; };
  for (std::int32_t part_y = 0; part_y < kParts; ++part_y) {
    for (std::int32_t part_x = 0; part_x < kParts; ++part_x) {
      footprints.push_back(footprint({offset(part_x), offset(part_y)}, radius_cells - kHalfDiagonal));
    }
  }
  const auto parts = static_cast<std::size_t>(kParts);
  const std::size_t width = static_cast<std::size_t>(map.width()) * parts;
  std::vector<std::uint32_t> labels(map.cell_count() * kPartsPerCell, 0);
  for (std::size_t i = 0; i < labels.size(); ++i) {
    const std::size_t x = i % width;
    const std::size_t y = i / width;
    const Cell cell{static_cast<std::int32_t>(x / parts), static_cast<std::int32_t>(y / parts)};
    if (sums.is_free(cell, footprints[(y % parts) * parts + x % parts])) labels[i] = kUnlabelled;
  }
  label_components(labels, width, true);
  return labels;
}

/// Label of the small square down and right of a cell's centre.
std::uint32_t label_at_centre(const std::vector<std::uint32_t>& labels, const GridMap& map, Cell cell) {
  const auto parts = static_cast<std::size_t>(kParts);
  const std::size_t x = static_cast<std::size_t>(cell.x) * parts + parts / 2;
  const std::size_t y = static_cast<std::size_t>(cell.y) * parts + parts / 2;
  return labels[y * static_cast<std::size_t>(map.width()) * parts + x];
}

std::string text_of(Cell cell) {
  std::string text = "(";
  text += std::to_string(cell.x);
  text += ", ";
  text += std::to_string(cell.y);
  return text += ')';
}

}  // namespace

std::vector<std::uint32_t> standing_components(const GridMap& map, double radius_cells) {
  return standing_components(map, RowSums(map), footprint({0, 0}, radius_cells));
}

std::optional<InstanceError> find_unreachable_goal(const Instance& instance) {
  const GridMap& map = instance.map;
  const RowSums sums(map);
  // Radii that reach the same squares have the same components, so that a thousand
  // different radii cost a handful of searches.
  std::map<Footprint, std::vector<std::uint32_t>> standing;
  std::map<double, std::vector<std::uint32_t>> wandering;
  for (AgentIndex i = 0; i < instance.agents.size(); ++i) {
    const Agent& agent = instance.agents[i];
    const Footprint body = footprint({0, 0}, agent.radius_cells);
    auto found = standing.find(body);
    if (found == standing.end()) found = standing.emplace(body, standing_components(map, sums, body)).first;
    const std::vector<std::uint32_t>& labels = found->second;
    if (labels[map.index(agent.start)] == labels[map.index(agent.goal)]) continue;

    if (agent.radius_cells > 0.5 + kTouchDepthCells) {
      auto known = wandering.find(agent.radius_cells);
      if (known == wandering.end()) {
        known =
            wandering.emplace(agent.radius_cells, wandering_components(map, sums, agent.radius_cells)).first;
      }
      if (known->second.empty() || label_at_centre(known->second, map, agent.start) ==
                                       label_at_centre(known->second, map, agent.goal)) {
        continue;
      }
    }
    return InstanceError{i, std::nullopt,
                         "agent " + agent.id + ": goal " + text_of(agent.goal) +
                             " cannot be reached from start " + text_of(agent.start),
                         "free space between them that is wide enough for the robot"};
  }
  return std::nullopt;
}

}  // namespace sipplab
