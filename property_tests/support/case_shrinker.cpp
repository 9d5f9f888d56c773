// Simpler cases; see case_shrinker.hpp.
#include "property_tests/support/case_shrinker.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <optional>
#include <string>
#include <utility>

#include "planner/options/option_table.hpp"

namespace sipplab {
namespace {

class Shrinker {
 public:
  explicit Shrinker(const PlanCase& from) : from_(from) {}

  std::vector<PlanCase> run() {
    fewer_robots();
    fewer_obstacles();
    smaller_map();
    fewer_blocked_cells();
    plainer_bodies();
    plainer_options();
    return std::move(simpler_);
  }

 private:
  /// Keeps what `change` makes of the case, if it is a case.
  template <class Change>
  void offer(const Change& change) {
    PlanCase changed = from_;
    change(changed);
    if (find_error(changed.instance)) return;
    for (std::size_t i = 0; i < changed.instance.agents.size(); ++i)
      changed.instance.agents[i].id = std::to_string(i);
    simpler_.push_back(std::move(changed));
  }

  void fewer_robots() {
    const auto robots = static_cast<std::ptrdiff_t>(from_.instance.agents.size());
    for (std::ptrdiff_t count = robots / 2; count >= 1; count /= 2) {
      for (std::ptrdiff_t first = 0; first + count <= robots; first += count) {
        offer([&](PlanCase& it) {
          auto& agents = it.instance.agents;
          agents.erase(agents.begin() + first, agents.begin() + first + count);
        });
      }
    }
    if (robots == 1) offer([](PlanCase& it) { it.instance.agents.clear(); });
  }

  void fewer_obstacles() {
    for (std::size_t i = 0; i < from_.instance.obstacles.size(); ++i) {
      offer([&](PlanCase& it) {
        it.instance.obstacles.erase(it.instance.obstacles.begin() + static_cast<std::ptrdiff_t>(i));
      });
      if (from_.instance.obstacles[i].trajectory.motions.empty()) continue;
      offer([&](PlanCase& it) { it.instance.obstacles[i].trajectory.motions.pop_back(); });
    }
  }

  void smaller_map() {
    for (const Cell cut : {Cell{1, 0}, Cell{0, 1}}) {
      for (const Cell shift : {Cell{0, 0}, cut}) {
        if (auto cropped = crop(cut, shift)) simpler_.push_back(std::move(*cropped));
      }
    }
  }

  /// A map smaller by `cut`, with everything moved up and left by `shift`.
  std::optional<PlanCase> crop(Cell cut, Cell shift) const {
    const GridMap& old_map = from_.instance.map;
    if (old_map.width() <= cut.x || old_map.height() <= cut.y) return std::nullopt;
    PlanCase cropped = from_;
    GridMap map(old_map.width() - cut.x, old_map.height() - cut.y);
    for (std::size_t i = 0; i < map.cell_count(); ++i) {
      const Cell cell = map.cell(i);
      map.set_blocked(cell, old_map.is_blocked({cell.x + shift.x, cell.y + shift.y}));
    }
    cropped.instance.map = std::move(map);
    const auto move = [&](Cell& cell) { cell = {cell.x - shift.x, cell.y - shift.y}; };
    for (Agent& agent : cropped.instance.agents) {
      move(agent.start);
      move(agent.goal);
    }
    for (DynamicObstacle& obstacle : cropped.instance.obstacles) {
      move(obstacle.trajectory.start);
      for (TimedMotion& motion : obstacle.trajectory.motions) {
        move(motion.from);
        move(motion.to);
      }
    }
    if (find_error(cropped.instance)) return std::nullopt;
    return cropped;
  }

  void fewer_blocked_cells() {
    const GridMap& map = from_.instance.map;
    if (map.blocked_count() > 1) {
      offer(
          [](PlanCase& it) { it.instance.map = GridMap(it.instance.map.width(), it.instance.map.height()); });
    }
    for (std::size_t i = 0; i < map.cell_count(); ++i) {
      if (map.is_blocked(map.cell(i)))
        offer([&](PlanCase& it) { it.instance.map.set_blocked(map.cell(i), false); });
    }
  }

  void plainer_bodies() {
    for (std::size_t i = 0; i < from_.instance.agents.size(); ++i) {
      const Agent& agent = from_.instance.agents[i];
      if (agent.radius_cells != kDefaultRadiusCells) {
        offer([&](PlanCase& it) { it.instance.agents[i].radius_cells = kDefaultRadiusCells; });
      }
      if (agent.speed_cells_per_s != kDefaultSpeedCellsPerS) {
        offer([&](PlanCase& it) { it.instance.agents[i].speed_cells_per_s = kDefaultSpeedCellsPerS; });
      }
      if (agent.start_heading_deg != 0)
        offer([&](PlanCase& it) { it.instance.agents[i].start_heading_deg = 0; });
      if (agent.goal_heading_deg)
        offer([&](PlanCase& it) { it.instance.agents[i].goal_heading_deg.reset(); });
      if (agent.rotation_speed != kDefaultRotationSpeed) {
        offer([&](PlanCase& it) { it.instance.agents[i].rotation_speed = kDefaultRotationSpeed; });
      }
      if (agent.goal != agent.start) offer([&](PlanCase& it) { it.instance.agents[i].goal = agent.start; });
    }
  }

  void plainer_options() {
    PlannerOptions plain;
    plain.rescheduling = Rescheduling::kNone;
    plain.order = InitialOrder::kFifo;
    plain.any_angle = false;
    plain.seed = 0;
    plain.ssi_s = 0;
    for (const Option& option : option_rows()) {
      const std::string text = option.get(plain);
      if (option.group == OptionGroup::kLimits || option.get(from_.options) == text) continue;
      offer([&](PlanCase& it) { option.set(it.options, text); });
    }
    const double ssi_s = from_.options.ssi_s;
    if (std::isinf(ssi_s)) offer([](PlanCase& it) { it.options.ssi_s = 8; });
    if (ssi_s != std::floor(ssi_s)) offer([&](PlanCase& it) { it.options.ssi_s = std::floor(ssi_s); });
    if (from_.options.connectedness > 2) offer([](PlanCase& it) { --it.options.connectedness; });
  }

  const PlanCase& from_;
  std::vector<PlanCase> simpler_;
};

}  // namespace

std::vector<PlanCase> simpler_cases(const PlanCase& plan_case) { return Shrinker(plan_case).run(); }

}  // namespace sipplab
