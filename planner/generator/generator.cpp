// Robots placed at random: see generator.hpp.
#include "planner/generator/generator.hpp"

#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

#include "planner/core/tolerances.hpp"
#include "planner/generator/stream.hpp"
#include "planner/instance/reachability.hpp"
#include "planner/io/text.hpp"

namespace sipplab {
namespace {

/// Shuffles in which the robots are placed before giving up. Where bodies are larger
/// than cells, chance decides how many fit, and a new shuffle can do better.
constexpr int kPlacementAttempts = 50;

/// Cells of the largest component where a disk of this radius may stand, in
/// row-major order; of equally large ones the first.
std::vector<Cell> largest_component(const GridMap& map, double radius_cells) {
  const std::vector<std::uint32_t> labels = standing_components(map, radius_cells);
  std::vector<std::size_t> sizes(1, 0);
  for (const std::uint32_t label : labels) {
    if (label >= sizes.size()) sizes.resize(label + std::size_t{1}, 0);
    if (label != 0) ++sizes[label];
  }
  const auto largest =
      static_cast<std::uint32_t>(std::max_element(sizes.begin(), sizes.end()) - sizes.begin());
  std::vector<Cell> cells;
  for (std::size_t i = 0; i < labels.size(); ++i) {
    if (largest != 0 && labels[i] == largest) cells.push_back(map.cell(i));
  }
  return cells;
}

/// Places bodies one after the other, each on the first cell of a shuffled list that
/// leaves the others alone.
class Placement {
 public:
  Placement(const GridMap& map, double radius_cells) : map_(map), taken_(map.cell_count(), 0) {
    const double reach_cells = 2 * radius_cells - kTouchDepthCells;
    const auto most = static_cast<std::int32_t>(std::ceil(reach_cells));
    for (std::int32_t dy = -most; dy <= most; ++dy) {
      for (std::int32_t dx = -most; dx <= most; ++dx) {
        if (norm(centre({dx, dy})) < reach_cells || (dx == 0 && dy == 0)) overlapping_.push_back({dx, dy});
      }
    }
  }

  /// Fewer cells than wanted where no more fit.
  std::vector<Cell> place(const std::vector<Cell>& shuffled, std::size_t wanted) {
    std::fill(taken_.begin(), taken_.end(), 0);
    std::vector<Cell> placed;
    for (const Cell cell : shuffled) {
      if (placed.size() == wanted) break;
      if (taken_[map_.index(cell)] != 0) continue;
      placed.push_back(cell);
      for (const Cell offset : overlapping_) {
        const Cell other{cell.x + offset.x, cell.y + offset.y};
        if (map_.contains(other)) taken_[map_.index(other)] = 1;
      }
    }
    return placed;
  }

 private:
  const GridMap& map_;
  std::vector<Cell> overlapping_;    ///< offsets at which two bodies overlap
  std::vector<std::uint8_t> taken_;  ///< 1 where no further body can be
};

/// The best of several tries, ended by the first that places all.
std::vector<Cell> place_all(Placement& placement, std::vector<Cell> cells, std::size_t wanted,
                            Random& random) {
  std::vector<Cell> best;
  for (int attempt = 0; attempt < kPlacementAttempts && best.size() < wanted; ++attempt) {
    random.shuffle(cells);
    std::vector<Cell> placed = placement.place(cells, wanted);
    if (placed.size() > best.size()) best = std::move(placed);
    if (wanted > cells.size()) break;  // no shuffle can help
  }
  return best;
}

/// Lets no goal be its robot's own start. Starts are distinct and goals are, so
/// after an exchange with any other robot both have moved apart.
void part_goals_from_starts(const std::vector<Cell>& starts, std::vector<Cell>& goals,
                            const std::vector<Cell>& cells) {
  if (starts.size() == 1 && starts[0] == goals[0] && cells.size() > 1) {
    goals[0] = cells[0] == starts[0] ? cells[1] : cells[0];
    return;
  }
  for (std::size_t i = 0; i < starts.size() && starts.size() > 1; ++i) {
    if (starts[i] == goals[i]) std::swap(goals[i], goals[(i + 1) % goals.size()]);
  }
}

std::string too_many(std::size_t wanted, std::size_t placed, double radius_cells, const char* what) {
  return std::to_string(wanted) + " robots of radius " + format_real(radius_cells) +
         " do not fit on the map: " + what + " were found for " + std::to_string(placed) +
         ", expected fewer robots or a larger map";
}

}  // namespace

Expected<Instance, std::string> generate_instance(const GridMap& map, const GeneratorOptions& options) {
  if (!(options.radius_cells >= kMinRadiusCells && options.radius_cells <= kMaxRadiusCells)) {
    return Unexpected{std::string("radius out of range, expected 0.001 to 64 cells")};
  }
  if (!(options.speed_cells_per_s >= kMinSpeedCellsPerS && options.speed_cells_per_s <= kMaxSpeedCellsPerS)) {
    return Unexpected{std::string("speed out of range, expected 0.001 to 1000 cells per second")};
  }
  Random random = instance_stream(options.seed, options.index, StreamUse::kRobots);
  const std::vector<Cell> cells = largest_component(map, options.radius_cells);
  Placement placement(map, options.radius_cells);
  const std::vector<Cell> starts = place_all(placement, cells, options.agents, random);
  if (starts.size() < options.agents) {
    return Unexpected{too_many(options.agents, starts.size(), options.radius_cells, "starts")};
  }
  std::vector<Cell> goals = place_all(placement, cells, options.agents, random);
  if (goals.size() < options.agents) {
    return Unexpected{too_many(options.agents, goals.size(), options.radius_cells, "goals")};
  }
  part_goals_from_starts(starts, goals, cells);

  Instance instance;
  instance.map = map;
  for (std::size_t i = 0; i < options.agents; ++i) {
    Agent agent;
    agent.id = std::to_string(i);
    agent.start = starts[i];
    agent.goal = goals[i];
    agent.radius_cells = options.radius_cells;
    agent.speed_cells_per_s = options.speed_cells_per_s;
    instance.agents.push_back(std::move(agent));
  }
  return instance;
}

Expected<Instance, std::string> generate_instance(const MapSpec& spec, const GeneratorOptions& options) {
  const Expected<GridMap, std::string> map = make_map(spec, options.seed, options.index);
  if (!map) return Unexpected{map.error()};
  return generate_instance(*map, options);
}

}  // namespace sipplab
