// Robots placed at random: see generator.hpp.
#include "sipplab/generator.hpp"

#include <algorithm>
#include <cmath>
#include <functional>
#include <map>
#include <optional>
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

/// Robots of one size, and the cells where they may start and end.
struct SizeClass {
  double radius_cells = 0;
  std::vector<std::size_t> robots;  ///< by position among all
  std::vector<Cell> cells;
};

/// Of the radii drawn, the largest first: those are the hardest to place.
std::vector<SizeClass> size_classes(const GridMap& map, const std::vector<Agent>& agents) {
  std::map<double, std::vector<std::size_t>, std::greater<>> robots_of;
  for (std::size_t i = 0; i < agents.size(); ++i) robots_of[agents[i].radius_cells].push_back(i);
  std::vector<SizeClass> classes;
  for (auto& [radius_cells, robots] : robots_of) {
    classes.push_back({radius_cells, std::move(robots), largest_component(map, radius_cells)});
  }
  return classes;
}

/// Places bodies one after the other, each on the first cell of a shuffled list that
/// leaves the others alone.
class Placement {
 public:
  Placement(const GridMap& map, std::vector<SizeClass> classes) : map_(map), classes_(std::move(classes)) {
    for (const SizeClass& placed : classes_) {
      for (const SizeClass& other : classes_) {
        overlapping_.push_back(offsets_within(placed.radius_cells + other.radius_cells - kTouchDepthCells));
      }
    }
    taken_.resize(classes_.size());
  }

  /// The best of several tries, ended by the first that places all: where each robot is,
  /// by position among all; nothing for those that no place was found for.
  std::vector<std::optional<Cell>> place_all(std::size_t robots, Random& random) {
    std::vector<std::optional<Cell>> best(robots);
    std::size_t most = 0;
    std::vector<SizeClass> shuffled = classes_;
    for (int attempt = 0; attempt < kPlacementAttempts && most < robots; ++attempt) {
      for (SizeClass& size : shuffled) random.shuffle(size.cells);
      std::vector<std::optional<Cell>> placed(robots);
      const std::size_t count = place(shuffled, placed);
      if (count > most) best = std::move(placed);
      most = std::max(most, count);
      if (is_hopeless()) break;
    }
    return best;
  }

 private:
  /// Offsets at which two centres are nearer than the reach, the same place included.
  static std::vector<Cell> offsets_within(double reach_cells) {
    std::vector<Cell> offsets;
    const auto most = static_cast<std::int32_t>(std::ceil(reach_cells));
    for (std::int32_t dy = -most; dy <= most; ++dy) {
      for (std::int32_t dx = -most; dx <= most; ++dx) {
        if (norm(centre({dx, dy})) < reach_cells || (dx == 0 && dy == 0)) offsets.push_back({dx, dy});
      }
    }
    return offsets;
  }

  /// Whether no shuffle can help.
  bool is_hopeless() const {
    return std::any_of(classes_.begin(), classes_.end(),
                       [](const SizeClass& size) { return size.robots.size() > size.cells.size(); });
  }

  /// How many were placed.
  std::size_t place(const std::vector<SizeClass>& shuffled, std::vector<std::optional<Cell>>& placed) {
    for (std::vector<std::uint8_t>& cells : taken_) cells.assign(map_.cell_count(), 0);
    std::size_t count = 0;
    for (std::size_t size = 0; size < shuffled.size(); ++size) {
      auto robot = shuffled[size].robots.begin();
      for (const Cell cell : shuffled[size].cells) {
        if (robot == shuffled[size].robots.end()) break;
        if (taken_[size][map_.index(cell)] != 0) continue;
        placed[*robot++] = cell;
        ++count;
        take(size, cell);
      }
    }
    return count;
  }

  /// A body of this size is at the cell now.
  void take(std::size_t size, Cell cell) {
    for (std::size_t other = 0; other < classes_.size(); ++other) {
      for (const Cell offset : overlapping_[size * classes_.size() + other]) {
        const Cell near{cell.x + offset.x, cell.y + offset.y};
        if (map_.contains(near)) taken_[other][map_.index(near)] = 1;
      }
    }
  }

  const GridMap& map_;
  std::vector<SizeClass> classes_;
  std::vector<std::vector<Cell>> overlapping_;    ///< by size placed, then the other size
  std::vector<std::vector<std::uint8_t>> taken_;  ///< by size: 1 if no such body can be
};

/// Lets no goal be its robot's own start. Starts are distinct and goals are, so
/// after an exchange with any other robot both have moved apart.
void part_goals_from_starts(const SizeClass& size, std::vector<Agent>& agents) {
  const std::vector<Cell>& cells = size.cells;
  if (agents.size() == 1 && agents[0].start == agents[0].goal && cells.size() > 1) {
    agents[0].goal = cells[0] == agents[0].start ? cells[1] : cells[0];
    return;
  }
  const std::vector<std::size_t>& robots = size.robots;
  for (std::size_t i = 0; i < robots.size() && robots.size() > 1; ++i) {
    Agent& agent = agents[robots[i]];
    if (agent.start == agent.goal) std::swap(agent.goal, agents[robots[(i + 1) % robots.size()]].goal);
  }
}

std::string too_many(const std::vector<SizeClass>& classes, std::size_t wanted, std::size_t placed,
                     const char* what) {
  std::string radii = format_real(classes.back().radius_cells);
  if (classes.size() > 1) radii += " to " + format_real(classes.front().radius_cells);
  return std::to_string(wanted) + " robots of radius " + radii + " do not fit on the map: " + what +
         " were found for " + std::to_string(placed) + ", expected fewer robots or a larger map";
}

/// Whether there are values, all of them within the range.
bool are_in_range(const std::vector<double>& values, double least, double most) {
  return !values.empty() && std::all_of(values.begin(), values.end(),
                                        [&](double value) { return value >= least && value <= most; });
}

double draw(const std::vector<double>& values, Random& random) {
  if (values.size() == 1) return values[0];
  return values[static_cast<std::size_t>(random.below(values.size()))];
}

/// Whole degrees.
double draw_heading_deg(Random& random) { return static_cast<double>(random.below(360)); }

/// Robots that are nowhere yet. One thing after the other is drawn for all of them, so that
/// what is asked of speeds leaves the sizes alone.
std::vector<Agent> draw_bodies(const GeneratorOptions& options) {
  Random random = instance_stream(options.seed, options.index, StreamUse::kBodies);
  std::vector<Agent> agents(options.agents);
  for (std::size_t i = 0; i < agents.size(); ++i) agents[i].id = std::to_string(i);
  for (Agent& agent : agents) agent.radius_cells = draw(options.radii_cells, random);
  for (Agent& agent : agents) agent.speed_cells_per_s = draw(options.speeds_cells_per_s, random);
  if (!options.headings) return agents;
  for (Agent& agent : agents) {
    agent.rotation_speed = draw(options.rotation_speeds, random);
    agent.start_heading_deg = draw_heading_deg(random);
    if (random.below(2) == 0) agent.goal_heading_deg = draw_heading_deg(random);
  }
  return agents;
}

/// A cell so far beyond one of the four borders that a body there touches none on the map.
Cell draw_cell_outside(const GridMap& map, std::int32_t far, Random& random) {
  const auto draw_below = [&random](std::int32_t bound) {
    return static_cast<std::int32_t>(random.below(static_cast<std::uint64_t>(bound)));
  };
  switch (random.below(4)) {
    case 0:
      return {-far, draw_below(map.height())};
    case 1:
      return {map.width() - 1 + far, draw_below(map.height())};
    case 2:
      return {draw_below(map.width()), -far};
    default:
      return {draw_below(map.width()), map.height() - 1 + far};
  }
}

std::vector<DynamicObstacle> draw_obstacles(const GridMap& map, const GeneratorOptions& options) {
  constexpr std::uint64_t kMostWaitS = 16;
  constexpr std::uint64_t kMostCellsOnTheWay = 3;
  Random random = instance_stream(options.seed, options.index, StreamUse::kObstacles);
  const double widest = *std::max_element(options.radii_cells.begin(), options.radii_cells.end());
  std::vector<DynamicObstacle> obstacles(options.obstacles);
  for (std::size_t i = 0; i < obstacles.size(); ++i) {
    DynamicObstacle& obstacle = obstacles[i];
    obstacle.id = std::to_string(i);
    obstacle.radius_cells = draw(options.radii_cells, random);
    const double speed_cells_per_s = draw(options.speeds_cells_per_s, random);
    const auto far = static_cast<std::int32_t>(std::ceil(obstacle.radius_cells + widest)) + 1;
    Trajectory& trajectory = obstacle.trajectory;
    trajectory.start = draw_cell_outside(map, far, random);
    const auto wait_s = static_cast<double>(1 + random.below(kMostWaitS));
    trajectory.motions.push_back({0, wait_s, trajectory.start, trajectory.start});
    const auto go = [&](Cell to) {
      const Cell from = trajectory.end();
      if (to == from) return;
      const double begin_s = trajectory.end_s();
      trajectory.motions.push_back({begin_s, begin_s + distance(from, to) / speed_cells_per_s, from, to});
    };
    for (std::uint64_t left = 1 + random.below(kMostCellsOnTheWay); left > 0; --left) {
      go(map.cell(static_cast<std::size_t>(random.below(map.cell_count()))));
    }
    go(draw_cell_outside(map, far, random));
  }
  return obstacles;
}

}  // namespace

Expected<Instance, std::string> generate_instance(const GridMap& map, const GeneratorOptions& options) {
  if (!are_in_range(options.radii_cells, kMinRadiusCells, kMaxRadiusCells)) {
    return Unexpected{std::string("radius out of range, expected 0.001 to 64 cells")};
  }
  if (!are_in_range(options.speeds_cells_per_s, kMinSpeedCellsPerS, kMaxSpeedCellsPerS)) {
    return Unexpected{std::string("speed out of range, expected 0.001 to 1000 cells per second")};
  }
  if (!are_in_range(options.rotation_speeds, kMinRotationSpeed, kMaxRotationSpeed)) {
    return Unexpected{
        std::string("rotation speed out of range, expected 0.001 to 1000 half turns per second")};
  }
  Instance instance;
  instance.map = map;
  instance.agents = draw_bodies(options);
  const std::vector<SizeClass> classes = size_classes(map, instance.agents);
  Random random = instance_stream(options.seed, options.index, StreamUse::kRobots);
  Placement placement(map, classes);
  for (const auto& [what, cell] : {std::pair{"starts", &Agent::start}, std::pair{"goals", &Agent::goal}}) {
    const std::vector<std::optional<Cell>> places = placement.place_all(options.agents, random);
    for (std::size_t i = 0; i < places.size(); ++i) {
      if (!places[i]) {
        const auto placed = std::count_if(places.begin(), places.end(),
                                          [](const std::optional<Cell>& place) { return place.has_value(); });
        return Unexpected{too_many(classes, options.agents, static_cast<std::size_t>(placed), what)};
      }
      instance.agents[i].*cell = *places[i];
    }
  }
  for (const SizeClass& size : classes) part_goals_from_starts(size, instance.agents);
  instance.obstacles = draw_obstacles(map, options);
  return instance;
}

Expected<Instance, std::string> generate_instance(const MapSpec& spec, const GeneratorOptions& options) {
  const Expected<GridMap, std::string> map = make_map(spec, options.seed, options.index);
  if (!map) return Unexpected{map.error()};
  return generate_instance(*map, options);
}

}  // namespace sipplab
