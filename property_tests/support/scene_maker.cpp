// Random walks; see scene_maker.hpp.
#include "property_tests/support/scene_maker.hpp"

#include <algorithm>
#include <ostream>
#include <utility>

#include "planner/core/random.hpp"
#include "planner/io/case_codec.hpp"
#include "property_tests/support/case_maker.hpp"

namespace sipplab {
namespace {

/// Cells. Most motions are short, so that robots meet often; on wide maps some go across
/// all of it, far from the places where most of the others are looked for.
constexpr std::int32_t kStride = 3;
constexpr std::int32_t kWideSide = 24;
/// On wide maps, where each takes long.
constexpr std::uint64_t kMostLongMotions = 3;

std::int32_t near(Random& random, std::int32_t coordinate, std::int32_t side, std::int32_t stride) {
  const auto step =
      static_cast<std::int32_t>(random.below(2 * static_cast<std::uint64_t>(stride) + 1)) - stride;
  return std::clamp(coordinate + step, 0, side - 1);
}

Trajectory walk(Random& random, const GridMap& map, double speed, std::uint64_t motions,
                std::int32_t stride) {
  Trajectory trajectory;
  trajectory.start = draw_cell(random, map);
  for (std::uint64_t i = 0; i < motions; ++i) {
    const Cell from = trajectory.end();
    const double begin_s = trajectory.end_s();
    const Cell to = random.below(4) == 0 ? from
                                         : Cell{near(random, from.x, map.width(), stride),
                                                near(random, from.y, map.height(), stride)};
    const double duration_s = from == to ? 0.125 + draw_eighths(random, 2) : distance(from, to) / speed;
    trajectory.motions.push_back({begin_s, begin_s + duration_s, from, to});
  }
  return trajectory;
}

template <class Change>
void offer(const Scene& scene, std::vector<Scene>& simpler, const Change& change) {
  Scene changed = scene;
  change(changed);
  simpler.push_back(std::move(changed));
}

void print(std::ostream& out, const Trajectory& trajectory) {
  for (const TimedMotion& motion : trajectory.motions) {
    out << "    [" << motion.begin_s << ", " << motion.end_s << "] (" << motion.from.x << ", "
        << motion.from.y << ") -> (" << motion.to.x << ", " << motion.to.y << ")\n";
  }
}

}  // namespace

Scene make_scene(int size, std::uint64_t seed) {
  Random random(seed);
  Scene scene;
  const bool wide = random.below(5) == 0;
  const std::int32_t stride = wide ? kWideSide : kStride;
  const auto side = [&] {
    if (wide) return 8 + static_cast<std::int32_t>(random.below(kWideSide - 8));
    return 3 + static_cast<std::int32_t>(random.below(3 + static_cast<std::uint64_t>(size) / 5));
  };
  GridMap& map = scene.instance.map;
  map = GridMap(side(), side());
  if (random.below(3) == 0) {
    for (int i = 0; i < 3; ++i) map.set_blocked(draw_cell(random, map), true);
  }
  const bool mixed = random.below(2) == 0;
  const std::uint64_t robots = random.below(3 + static_cast<std::uint64_t>(size) / 10);
  const std::uint64_t most_motions = wide ? kMostLongMotions : 1 + static_cast<std::uint64_t>(size) / 10;
  for (std::uint64_t i = 0; i < robots; ++i) {
    Agent agent;
    agent.id = std::to_string(i);
    if (mixed) {
      agent.radius_cells = draw_radius(random);
      agent.speed_cells_per_s = draw_speed(random);
    }
    const Trajectory trajectory =
        walk(random, map, agent.speed_cells_per_s, random.below(most_motions + 1), stride);
    agent.start = trajectory.start;
    agent.goal = trajectory.end();
    scene.instance.agents.push_back(agent);
    scene.solution.trajectories.push_back(trajectory);
  }
  if (random.below(3) == 0) {
    DynamicObstacle obstacle;
    obstacle.id = "0";
    obstacle.radius_cells = draw_radius(random);
    obstacle.trajectory = walk(random, map, draw_speed(random), random.below(most_motions + 1), stride);
    scene.instance.obstacles.push_back(obstacle);
  }
  return scene;
}

std::vector<Scene> simpler_scenes(const Scene& scene) {
  std::vector<Scene> simpler;
  const std::size_t robots = scene.instance.agents.size();
  for (AgentIndex i = 0; i < robots; ++i) simpler.push_back(without_agent(scene, i));
  if (!scene.instance.obstacles.empty()) {
    offer(scene, simpler, [](Scene& it) { it.instance.obstacles.pop_back(); });
  }
  for (AgentIndex i = 0; i < robots; ++i) {
    if (scene.solution.trajectories[i].motions.empty()) continue;
    offer(scene, simpler, [&](Scene& it) {
      it.solution.trajectories[i].motions.pop_back();
      it.instance.agents[i].goal = it.solution.trajectories[i].end();
    });
  }
  for (AgentIndex i = 0; i < robots; ++i) {
    if (scene.instance.agents[i].radius_cells == kDefaultRadiusCells) continue;
    offer(scene, simpler, [&](Scene& it) { it.instance.agents[i].radius_cells = kDefaultRadiusCells; });
  }
  const GridMap& map = scene.instance.map;
  for (std::size_t i = 0; i < map.cell_count(); ++i) {
    if (!map.is_blocked(map.cell(i))) continue;
    offer(scene, simpler, [&](Scene& it) { it.instance.map.set_blocked(map.cell(i), false); });
  }
  return simpler;
}

std::ostream& operator<<(std::ostream& out, const Scene& scene) {
  out << '\n' << encode_case({scene.instance, {}});
  for (std::size_t i = 0; i < scene.solution.trajectories.size(); ++i) {
    out << "  walk of " << i << ":\n";
    print(out, scene.solution.trajectories[i]);
  }
  return out;
}

}  // namespace sipplab
