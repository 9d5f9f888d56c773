// Lattices of encounters; see encounters.hpp.
#include "property_tests/support/encounters.hpp"

#include <cstddef>
#include <ostream>
#include <tuple>

namespace sipplab {
namespace {

/// Cells along one side: mostly so few that paths cross, sometimes so many that paths are
/// almost parallel.
constexpr std::int32_t kNearSide = 6;
constexpr std::int32_t kFarSide = 60;
/// Seconds. A late time, at which a double resolves 2e-12 s.
constexpr double kLateS = 1e4;

rc::Gen<Cell> any_place() {
  return rc::gen::weightedOneOf<Cell>(
      {{4, any_cell(kNearSide, kNearSide)}, {1, any_cell(kFarSide, kFarSide)}});
}

}  // namespace

std::ostream& operator<<(std::ostream& out, Cell cell) {
  return out << "(" << cell.x << ", " << cell.y << ")";
}

rc::Gen<Cell> any_cell(std::int32_t width, std::int32_t height) {
  // At every size: rapidcheck narrows ranges when sizes are small.
  return rc::gen::resize(rc::kNominalSize, rc::gen::apply(
                                               [](std::int32_t x, std::int32_t y) {
                                                 return Cell{x, y};
                                               },
                                               rc::gen::inRange<std::int32_t>(0, width),
                                               rc::gen::inRange<std::int32_t>(0, height)));
}

rc::Gen<double> any_radius() {
  return rc::gen::resize(rc::kNominalSize,
                         any_of({0.5, 0.5, 0.5, 0.5, 0.25, 0.75, 1.0, 0.3, 0.4, 0.7, 1.5, 2.5, 0.001}));
}

rc::Gen<double> any_speed() {
  return rc::gen::resize(rc::kNominalSize, any_of({1.0, 1.0, 1.0, 1.0, 0.5, 2.0, 0.25, 1.5}));
}

rc::Gen<double> any_eighths(int limit) {
  return rc::gen::map(rc::gen::resize(rc::kNominalSize, rc::gen::inRange(0, 8 * limit + 1)),
                      [](int eighths) { return eighths / 8.0; });
}

Move Encounter::move() const { return {Displacement(centre(from), centre(to)), speed}; }

MovingDisk Encounter::obstacle() const {
  if (obstacle_from == obstacle_to) {
    return MovingDisk::resting(centre(obstacle_from), begin_s, begin_s + rest_s, obstacle_radius);
  }
  const Displacement path(centre(obstacle_from), centre(obstacle_to));
  return MovingDisk::moving(path, begin_s, begin_s + path.length / obstacle_speed, obstacle_radius);
}

std::ostream& operator<<(std::ostream& out, const Encounter& encounter) {
  out << encounter.from << " -> " << encounter.to << " radius " << encounter.radius << " speed "
      << encounter.speed << ", obstacle " << encounter.obstacle_from << " radius "
      << encounter.obstacle_radius << " from " << encounter.begin_s << " s ";
  if (encounter.obstacle_from == encounter.obstacle_to)
    return out << "resting for " << encounter.rest_s << " s";
  out << "-> " << encounter.obstacle_to;
  return out << " speed " << encounter.obstacle_speed;
}

rc::Gen<Encounter> any_encounter() {
  const auto any_pace = rc::gen::weightedOneOf<double>({{8, any_speed()}, {1, any_of({0.001, 100.0})}});
  const auto any_begin = rc::gen::apply([](double base_s, double eighths_s) { return base_s + eighths_s; },
                                        any_of({0.0, 0.0, kLateS}), any_eighths(2));
  const auto any_drawn = rc::gen::build<Encounter>(
      rc::gen::set(&Encounter::from, any_place()), rc::gen::set(&Encounter::to, any_place()),
      rc::gen::set(&Encounter::speed, any_pace), rc::gen::set(&Encounter::radius, any_radius()),
      rc::gen::set(&Encounter::obstacle_from, any_place()),
      rc::gen::set(&Encounter::obstacle_to, any_place()), rc::gen::set(&Encounter::obstacle_speed, any_pace),
      rc::gen::set(&Encounter::obstacle_radius, any_radius()), rc::gen::set(&Encounter::begin_s, any_begin),
      rc::gen::set(&Encounter::rest_s, any_of({1.0, 0.125, 7.5, kForever})));
  return rc::gen::map(rc::gen::pair(any_drawn, rc::gen::inRange(0, 8)), [](std::pair<Encounter, int> drawn) {
    Encounter& encounter = drawn.first;
    if (drawn.second == 1) encounter.obstacle_to = encounter.obstacle_from;
    if (drawn.second == 2) {  // the same way in the same direction
      encounter.obstacle_to = {encounter.obstacle_from.x + encounter.to.x - encounter.from.x,
                               encounter.obstacle_from.y + encounter.to.y - encounter.from.y};
    }
    if (encounter.to == encounter.from) encounter.to.x += 1;
    return encounter;
  });
}

rc::Gen<std::vector<Encounter>> any_encounters() {
  return rc::gen::container<std::vector<Encounter>>(any_encounter());
}

Trajectory Walk::trajectory() const {
  Trajectory trajectory{start, {}};
  if (begin_s > 0) trajectory.motions.push_back({0, begin_s, start, start});
  for (const Step& step : steps) {
    const Cell from = trajectory.end();
    const double now_s = trajectory.end_s();
    const double duration_s = step.to == from ? step.wait_s : distance(from, step.to) / step.speed;
    trajectory.motions.push_back({now_s, now_s + duration_s, from, step.to});
  }
  return trajectory;
}

std::ostream& operator<<(std::ostream& out, const Walk& walk) {
  out << "radius " << walk.radius << " at " << walk.start;
  for (const TimedMotion& motion : walk.trajectory().motions) {
    out << " until " << motion.end_s << " " << motion.to;
  }
  return out;
}

rc::Gen<Walk> any_walk(std::int32_t width, std::int32_t height) {
  const auto any_step = rc::gen::build<Walk::Step>(
      rc::gen::set(&Walk::Step::to, any_cell(width, height)), rc::gen::set(&Walk::Step::speed, any_speed()),
      rc::gen::set(&Walk::Step::wait_s, any_of({0.125, 0.5, 1.0, 2.0, 3.25})));
  const auto any_steps = rc::gen::mapcat(rc::gen::inRange<std::size_t>(0, 6), [any_step](std::size_t steps) {
    return rc::gen::container<std::vector<Walk::Step>>(steps, any_step);
  });
  return rc::gen::build<Walk>(rc::gen::set(&Walk::start, any_cell(width, height)),
                              rc::gen::set(&Walk::steps, any_steps),
                              rc::gen::set(&Walk::begin_s, any_of({0.0, 0.0, 0.5, 1.125, 4.0})),
                              rc::gen::set(&Walk::radius, any_radius()));
}

std::vector<MovingDisk> disks_of(const Trajectory& trajectory, double radius) {
  std::vector<MovingDisk> disks;
  for (const TimedMotion& motion : trajectory.motions) {
    disks.push_back(MovingDisk::moving(Displacement(centre(motion.from), centre(motion.to)), motion.begin_s,
                                       motion.end_s, radius));
  }
  disks.push_back(MovingDisk::resting(centre(trajectory.end()), trajectory.end_s(), kForever, radius));
  return disks;
}

}  // namespace sipplab
