// Generated instances: problems that can be posed, of which each is another.
#include "sipplab/generator.hpp"

#include <rapidcheck.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <map>
#include <set>
#include <string>
#include <vector>

#include "planner/instance/reachability.hpp"
#include "property_tests/support/property.hpp"

namespace sipplab::generator_laws {
namespace {

GeneratorOptions any_options(std::size_t most_agents) {
  GeneratorOptions options;
  options.agents = *rc::gen::inRange<std::size_t>(0, most_agents + 1);
  options.seed = *rc::gen::arbitrary<std::uint64_t>();
  options.index = *rc::gen::inRange<std::uint64_t>(0, 1000);
  options.radii_cells = {*rc::gen::element(0.5, 0.25, 0.4, 0.75, 1.0, 1.5)};
  if (*rc::gen::inRange(0, 3) == 0) options.radii_cells = {0.3, 0.5, 0.9, 1.4};
  options.speeds_cells_per_s = {*rc::gen::element(1.0, 0.5, 2.0), 1.0};
  options.rotation_speeds = {0.5, 2};
  options.headings = *rc::gen::arbitrary<bool>();
  options.obstacles = *rc::gen::inRange<std::size_t>(0, 3);
  return options;
}

MapSpec any_random_map() {
  MapSpec spec;
  spec.kind = MapSpec::Kind::kRandom;
  spec.width = *rc::gen::inRange(1, 20);
  spec.height = *rc::gen::inRange(1, 20);
  spec.density = *rc::gen::inRange(0, 80) / 100.0;
  return spec;
}

/// Rooms or a maze.
MapSpec any_walled_map() {
  MapSpec spec;
  spec.kind = *rc::gen::element(MapSpec::Kind::kRooms, MapSpec::Kind::kMaze);
  spec.width = *rc::gen::inRange(1, 30);
  spec.height = *rc::gen::inRange(1, 30);
  spec.gap_cells = *rc::gen::inRange(1, 6);
  return spec;
}

/// The cells of the largest part of the map that four neighbours join; of equally large ones the one that
/// comes first, row by row.
std::set<Cell> largest_part(const GridMap& map) {
  std::set<Cell> seen;
  std::set<Cell> largest;
  for (std::size_t i = 0; i < map.cell_count(); ++i) {
    if (map.is_blocked(map.cell(i)) || seen.count(map.cell(i)) > 0) continue;
    std::set<Cell> part;
    std::vector<Cell> open = {map.cell(i)};
    while (!open.empty()) {
      const Cell here = open.back();
      open.pop_back();
      if (!map.contains(here) || map.is_blocked(here) || !part.insert(here).second) continue;
      for (const Cell by : {Cell{1, 0}, Cell{-1, 0}, Cell{0, 1}, Cell{0, -1}}) {
        open.push_back({here.x + by.x, here.y + by.y});
      }
    }
    seen.insert(part.begin(), part.end());
    if (part.size() > largest.size()) largest = part;
  }
  return largest;
}

/// Cells from a place to the nearest place on the map, its border included.
double cells_from(const GridMap& map, Cell place) {
  const double x = std::max({0.0, -0.5 - place.x, place.x - (map.width() - 0.5)});
  const double y = std::max({0.0, -0.5 - place.y, place.y - (map.height() - 0.5)});
  return std::hypot(x, y);
}

const PropertyRoom room("generator", [] {
  bool passed = true;

  passed &= property("a generated instance keeps all rules, and every goal can be reached", [] {
    const GeneratorOptions options = any_options(12);
    const auto instance = generate_instance(any_random_map(), options);
    RC_PRE(static_cast<bool>(instance));
    RC_ASSERT(instance->agents.size() == options.agents);
    RC_ASSERT(!find_error(*instance));
    RC_ASSERT(!find_unreachable_goal(*instance));
    RC_CLASSIFY(options.radii_cells.back() > 0.5, "wider than a cell");
    RC_ASSERT(instance->obstacles.size() == options.obstacles);
    RC_CLASSIFY(options.radii_cells.size() > 1, "several sizes");
    RC_CLASSIFY(options.obstacles > 0, "moving obstacles");
  });

  passed &= property("no robot is at its goal already where two fit on the map", [] {
    GeneratorOptions options = any_options(16);
    options.radii_cells = {0.5};
    MapSpec spec;
    spec.width = *rc::gen::inRange(2, 6);
    spec.height = *rc::gen::inRange(2, 6);
    const auto instance = generate_instance(spec, options);
    RC_PRE(static_cast<bool>(instance));
    for (const Agent& agent : instance->agents) RC_ASSERT(agent.start != agent.goal);
  });

  passed &= property("the share of blocked cells is what was asked for, rounded", [] {
    MapSpec spec = any_random_map();
    spec.kind = *rc::gen::element(MapSpec::Kind::kRandom, MapSpec::Kind::kCaves);
    const auto map = make_map(spec, *rc::gen::arbitrary<std::uint64_t>(), 0);
    RC_ASSERT(static_cast<bool>(map));
    const double wanted = spec.density * static_cast<double>(map->cell_count());
    RC_ASSERT(std::abs(static_cast<double>(map->blocked_count()) - wanted) <= 0.5 + 1e-9);
  });

  passed &= property("what is blocked in caves lies together", [] {
    MapSpec spec = any_random_map();
    spec.width = spec.height = 40;
    spec.density = *rc::gen::inRange(20, 60) / 100.0;
    const auto like_before = [&](MapSpec::Kind kind) {
      spec.kind = kind;
      const auto map = make_map(spec, *rc::gen::arbitrary<std::uint64_t>());
      int equal = 0;
      for (std::size_t i = 0; i < map->cell_count(); ++i) {
        const Cell cell = map->cell(i);
        equal += cell.x > 0 && map->is_blocked(cell) == map->is_blocked({cell.x - 1, cell.y});
        equal += cell.y > 0 && map->is_blocked(cell) == map->is_blocked({cell.x, cell.y - 1});
      }
      return equal / (2.0 * 39 * 40);
    };
    // Neighbours at random are of the same kind in half to two thirds of the cases.
    RC_ASSERT(like_before(MapSpec::Kind::kCaves) > 0.8);
    RC_ASSERT(like_before(MapSpec::Kind::kRandom) < 0.75);
  });

  passed &= property("walls are as far apart as was asked for, and every free cell can be reached", [] {
    const MapSpec spec = any_walled_map();
    const auto map = make_map(spec, *rc::gen::arbitrary<std::uint64_t>(), 0);
    RC_ASSERT(static_cast<bool>(map));
    RC_ASSERT(largest_part(*map).size() == map->cell_count() - map->blocked_count());
    const std::int32_t period = spec.gap_cells + 1;
    const auto count = [&](std::int32_t cells) { return (cells + period - 1) / period; };
    const std::size_t squares =
        static_cast<std::size_t>(count(spec.width)) * static_cast<std::size_t>(count(spec.height));
    std::size_t openings = 0;  // ways from one square to the next
    for (std::size_t i = 0; i < map->cell_count(); ++i) {
      const Cell cell = map->cell(i);
      const bool in_upright = cell.x % period == spec.gap_cells;
      const bool in_level = cell.y % period == spec.gap_cells;
      if (map->is_blocked(cell)) {
        RC_ASSERT(in_upright || in_level);
      } else if (in_upright || in_level) {
        RC_ASSERT(!(in_upright && in_level));
        // The first free cell of its wall.
        const Cell before = in_upright ? Cell{cell.x, cell.y - 1} : Cell{cell.x - 1, cell.y};
        openings += !map->contains(before) || map->is_blocked(before);
        if (spec.kind == MapSpec::Kind::kRooms) {
          RC_ASSERT((!map->contains(before) || map->is_blocked(before)));
        } else if (!map->contains(before) || map->is_blocked(before)) {
          const std::int32_t end = in_upright ? spec.height : spec.width;
          std::int32_t at = in_upright ? cell.y : cell.x;
          RC_ASSERT(at % period == 0);
          for (; at < end && at % period != spec.gap_cells; ++at) {
            RC_ASSERT(!map->is_blocked(in_upright ? Cell{cell.x, at} : Cell{at, cell.y}));
          }
        }
      }
    }
    RC_CLASSIFY(squares > 3, "four squares or more");
    RC_CLASSIFY(openings > squares - 1, "more ways than one");
    RC_ASSERT(openings >= squares - 1);
    // A maze has one way from each square to each other one.
    if (spec.kind == MapSpec::Kind::kMaze) RC_ASSERT(openings == squares - 1);
  });

  passed &= property("shelves are as many and as large as was asked for, with aisles around each", [] {
    const auto any_side = [] { return *rc::gen::inRange(1, 6); };
    const std::int32_t columns = any_side(), rows = any_side(), length = any_side(), width = any_side(),
                       gap = any_side();
    const auto spec =
        parse_map_spec("shelves:" + std::to_string(columns) + "x" + std::to_string(rows) + ":" +
                       std::to_string(length) + "x" + std::to_string(width) + ":" + std::to_string(gap));
    RC_ASSERT(spec && spec->kind == MapSpec::Kind::kShelves);
    const GridMap map = *make_map(*spec, 1);
    // The wall around it, and what is blocked inside, in rows that end where the next one begins.
    const std::size_t around = 2 * static_cast<std::size_t>(map.width() + map.height()) - 4;
    const auto shelves = static_cast<std::size_t>(columns * rows * length * width);
    RC_ASSERT(map.blocked_count() == around + shelves);
    RC_ASSERT(map.width() == 2 + 2 * (columns * length / 4) + columns * length + (columns - 1) * gap);
    RC_ASSERT(map.height() == 2 + rows * width + (rows + 1) * gap);
    int corners = 0;
    for (std::int32_t y = 1; y + 1 < map.height(); ++y) {
      for (std::int32_t x = 1; x + 1 < map.width(); ++x) {
        RC_ASSERT(map.is_blocked({x, y}) == map.is_blocked({map.width() - 1 - x, y}));
        RC_ASSERT(map.is_blocked({x, y}) == map.is_blocked({x, map.height() - 1 - y}));
        if (!map.is_blocked({x, y}) || (x > 1 && map.is_blocked({x - 1, y})) ||
            (y > 1 && map.is_blocked({x, y - 1}))) {
          continue;
        }
        ++corners;  // upper left
        for (std::int32_t dx = 0; dx < length; ++dx) {
          for (std::int32_t dy = 0; dy < width; ++dy) RC_ASSERT(map.is_blocked({x + dx, y + dy}));
        }
      }
    }
    // A quarter of fewer shelves is no space beside them.
    if (columns * length < 4) return;
    RC_ASSERT(corners == columns * rows);
    RC_ASSERT(largest_part(map).size() == map.cell_count() - map.blocked_count());
  });

  passed &= property("the same seed and index give the same instance, another index another", [] {
    GeneratorOptions options = any_options(0);
    options.radii_cells = {0.5};
    options.agents = 20;
    MapSpec spec = any_random_map();
    spec.kind = *rc::gen::element(MapSpec::Kind::kRandom, MapSpec::Kind::kCaves, MapSpec::Kind::kRooms,
                                  MapSpec::Kind::kMaze);
    spec.width = 30;
    spec.height = 30;
    spec.density = 0.2;
    spec.gap_cells = *rc::gen::inRange(1, 8);
    const auto instance = generate_instance(spec, options);
    const auto again = generate_instance(spec, options);
    RC_ASSERT(instance && again && *instance == *again);
    std::set<std::string> hashes{content_hash(*instance)};
    constexpr std::uint64_t kOthers = 3;
    for (std::uint64_t i = 1; i <= kOthers; ++i) {
      GeneratorOptions other = options;
      other.index += i;
      hashes.insert(content_hash(*generate_instance(spec, other)));
    }
    RC_ASSERT(hashes.size() == kOthers + 1);
  });

  passed &= property("robots are on the first of the largest parts of the map, at any speed and heading", [] {
    GeneratorOptions options = any_options(8);
    options.radii_cells = {*rc::gen::element(0.5, 0.3)};
    MapSpec spec = any_random_map();
    spec.density = *rc::gen::inRange(30, 75) / 100.0;
    const auto instance = generate_instance(spec, options);
    RC_PRE(static_cast<bool>(instance));
    const std::set<Cell> part = largest_part(instance->map);
    RC_ASSERT(options.agents <= part.size());
    for (const Agent& agent : instance->agents) {
      RC_ASSERT(part.count(agent.start) > 0);
      RC_ASSERT(part.count(agent.goal) > 0);
    }
    // What else is drawn leaves places as they are.
    GeneratorOptions others = options;
    others.speeds_cells_per_s = {0.5};
    others.headings = !options.headings;
    others.obstacles = 3 - options.obstacles;
    const auto same = generate_instance(spec, others);
    RC_ASSERT(static_cast<bool>(same));
    for (std::size_t i = 0; i < instance->agents.size(); ++i) {
      RC_ASSERT(same->agents[i].start == instance->agents[i].start);
      RC_ASSERT(same->agents[i].goal == instance->agents[i].goal);
      RC_ASSERT(same->agents[i].radius_cells == instance->agents[i].radius_cells);
      RC_ASSERT(same->agents[i].speed_cells_per_s == 0.5);
    }
  });

  passed &= property("so many robots as there are cells fit", [] {
    GeneratorOptions options = any_options(0);
    options.radii_cells = {*rc::gen::element(0.5, 0.3)};
    const auto map = make_map(any_random_map(), options.seed);
    RC_ASSERT(static_cast<bool>(map));
    options.agents = largest_part(*map).size();
    RC_ASSERT(static_cast<bool>(generate_instance(*map, options)));
    ++options.agents;
    RC_ASSERT(!generate_instance(*map, options));
  });

  passed &= property("where chance decides how many fit, it is tried again", [] {
    // Of nine cells where such a body can stand four are far enough apart; one shuffle in five finds them.
    GeneratorOptions options = any_options(0);
    options.radii_cells = {0.75};
    options.agents = 4;
    const auto instance = generate_instance(GridMap(5, 5), options);
    RC_ASSERT(static_cast<bool>(instance));
    RC_ASSERT(!find_error(*instance));
    ++options.agents;
    RC_ASSERT(!generate_instance(GridMap(5, 5), options));
  });

  passed &= property("one large robot finds its place among small ones", [] {
    GeneratorOptions options = any_options(0);
    options.radii_cells = {1.5, 0.5};
    options.agents = *rc::gen::inRange<std::size_t>(2, 7);
    const GridMap map(5, 3);
    const auto instance = generate_instance(map, options);
    // A lone large one leaves six cells, and there it is always three high.
    GridMap wide(64, 8);
    const auto drawn = generate_instance(wide, options);
    RC_PRE(static_cast<bool>(drawn));
    const auto large = std::count_if(drawn->agents.begin(), drawn->agents.end(),
                                     [](const Agent& agent) { return agent.radius_cells == 1.5; });
    RC_PRE(large == 1);
    RC_ASSERT(static_cast<bool>(instance));
    RC_ASSERT(!find_error(*instance));
  });

  passed &= property("sizes, speeds and headings are drawn from all that is asked for, equally likely", [] {
    GeneratorOptions options = any_options(0);
    options.agents = 300;
    options.radii_cells = {0.1, 0.2, 0.3};
    options.speeds_cells_per_s = {1, 2, 3};
    options.rotation_speeds = {0.5, 1, 2};
    options.headings = true;
    const auto instance = generate_instance(GridMap(24, 24), options);
    RC_ASSERT(static_cast<bool>(instance));
    std::map<double, int> radii;
    std::map<double, int> speeds;
    std::map<double, int> rotations;
    int with_goal_heading = 0;
    for (const Agent& agent : instance->agents) {
      ++radii[agent.radius_cells];
      ++speeds[agent.speed_cells_per_s];
      ++rotations[agent.rotation_speed];
      with_goal_heading += agent.goal_heading_deg.has_value();
      for (const double heading_deg : {agent.start_heading_deg, agent.goal_heading_deg.value_or(0)}) {
        RC_ASSERT(std::floor(heading_deg) == heading_deg);
        RC_ASSERT(heading_deg >= 0 && heading_deg < 360);
      }
    }
    for (const auto& counts : {radii, speeds, rotations}) {
      RC_ASSERT(counts.size() == 3u);
      for (const auto& [value, count] : counts) RC_ASSERT(count > 50);  // 100 are expected, 8 more or less
    }
    RC_ASSERT(with_goal_heading > 90 && with_goal_heading < 210);
  });

  passed &= property("obstacles come from outside, cross at the speeds asked for, and leave for good", [] {
    GeneratorOptions options = any_options(3);
    options.obstacles = 4;
    options.speeds_cells_per_s = *rc::gen::element(std::vector<double>{0.5, 2, 3}, std::vector<double>{0.25});
    const auto instance = generate_instance(any_random_map(), options);
    RC_PRE(static_cast<bool>(instance));
    const double widest = *std::max_element(options.radii_cells.begin(), options.radii_cells.end());
    for (const DynamicObstacle& obstacle : instance->obstacles) {
      const Trajectory& trajectory = obstacle.trajectory;
      RC_ASSERT(std::count(options.radii_cells.begin(), options.radii_cells.end(), obstacle.radius_cells) >
                0);
      for (const Cell place : {trajectory.start, trajectory.end()}) {
        RC_ASSERT(cells_from(instance->map, place) >= obstacle.radius_cells + widest);
      }
      RC_ASSERT(trajectory.motions.front().is_wait());
      const double wait_s = trajectory.motions.front().end_s;
      RC_ASSERT(wait_s >= 1 && wait_s <= 16 && std::floor(wait_s) == wait_s);
      bool crosses = false;
      std::set<double> speeds;
      for (std::size_t i = 1; i < trajectory.motions.size(); ++i) {
        const TimedMotion& motion = trajectory.motions[i];
        crosses = crosses || instance->map.contains(motion.to);
        const double speed = distance(motion.from, motion.to) / (motion.end_s - motion.begin_s);
        speeds.insert(std::round(speed * 1e6) / 1e6);
      }
      RC_ASSERT(crosses);
      RC_ASSERT(speeds.size() == 1u);
      RC_ASSERT(std::count(options.speeds_cells_per_s.begin(), options.speeds_cells_per_s.end(),
                           *speeds.begin()) > 0);
    }
  });

  passed &= property("a map's text gives its size and share, and what is none is one line", [] {
    const int width = *rc::gen::inRange(1, 60);
    const int height = *rc::gen::inRange(1, 60);
    const int hundredths = *rc::gen::element(0, 20, 99, 100, -1, 101, 55);
    const std::string size = std::to_string(width) + "x" + std::to_string(height);
    const auto empty = parse_map_spec("empty:" + size);
    RC_ASSERT(empty && empty->kind == MapSpec::Kind::kEmpty);
    RC_ASSERT(empty->width == width && empty->height == height);
    const std::string density = std::to_string(hundredths / 100.0);
    const auto random = parse_map_spec("random:" + size + ":" + density);
    RC_ASSERT(random.has_value() == (hundredths >= 0 && hundredths < 100));
    if (!random) {
      RC_ASSERT(random.error().find('\n') == std::string::npos);
      return;
    }
    RC_ASSERT(random->width == width && random->height == height);
    RC_ASSERT(std::abs(random->density - hundredths / 100.0) < 1e-6);
  });

  return passed;
});

}  // namespace
}  // namespace sipplab::generator_laws
