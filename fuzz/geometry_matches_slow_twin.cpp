// Claim: closed forms of unsafe times agree with distances and bisection, and line of sight
// with whole numbers. The robots of a case are moves that have no eyes for each other, its
// obstacles are disks on their way; nothing is planned.
#include <cmath>
#include <optional>
#include <string>
#include <vector>

#include "fuzz/support/case_input.hpp"
#include "fuzz/support/claims.hpp"
#include "fuzz/support/target.hpp"
#include "planner/grid/line_of_sight.hpp"
#include "property_tests/support/exact_line_of_sight.hpp"
#include "property_tests/support/unsafe_times.hpp"

namespace {

using namespace sipplab;
using fuzz::Claim;

/// Range for which the oracle's rounding is known: seconds, cells per second.
constexpr double kLatestS = 1e4;
constexpr double kFastest = 8;
/// Pairs of a move and a disk that one input may cost: a bisection takes 50 microseconds.
constexpr int kMostPairs = 12;

void check(const UnsafeTimes& times) {
  fuzz::count(fuzz::Event::kComparisons);
  const std::string flaw = find_flaw(times);
  fuzz::require(Claim::kClosedFormIsRight, flaw.empty(), flaw);
}

/// Obstacles' motions, and each robot on its straight move as soon as protection of starts
/// ends; those for whose range the oracle is made.
std::vector<MovingDisk> disks_of(const PlanCase& plan_case) {
  std::vector<MovingDisk> disks;
  const auto add = [&](const MovingDisk& disk) {
    if (disk.begin_s <= kLatestS && (disk.end_s <= kLatestS || disk.at_rest()) && disk.speed <= kFastest) {
      disks.push_back(disk);
    }
  };
  for (const DynamicObstacle& obstacle : plan_case.instance.obstacles) {
    for (const TimedMotion& motion : obstacle.trajectory.motions) {
      add(MovingDisk::moving(Displacement(centre(motion.from), centre(motion.to)), motion.begin_s,
                             motion.end_s, obstacle.radius_cells));
    }
    add(MovingDisk::resting(centre(obstacle.trajectory.end()), obstacle.trajectory.end_s(), kForever,
                            obstacle.radius_cells));
  }
  const double begin_s = std::isinf(plan_case.options.ssi_s) ? 0 : plan_case.options.ssi_s;
  for (const Agent& agent : plan_case.instance.agents) {
    if (agent.start == agent.goal) continue;
    const Displacement path(centre(agent.start), centre(agent.goal));
    add(MovingDisk::moving(path, begin_s, begin_s + path.length / agent.speed_cells_per_s,
                           agent.radius_cells));
  }
  return disks;
}

void check_unsafe_times(const PlanCase& plan_case) {
  const std::vector<MovingDisk> disks = disks_of(plan_case);
  int pairs = 0;
  for (const Agent& agent : plan_case.instance.agents) {
    if (agent.start == agent.goal || agent.speed_cells_per_s > kFastest) continue;
    const Move move(Displacement(centre(agent.start), centre(agent.goal)), agent.speed_cells_per_s);
    for (const MovingDisk& disk : disks) {
      if (++pairs > kMostPairs) return;
      check(departures_of(move, disk, agent.radius_cells + disk.radius));
      check(collisions_of(move.path.from, disk, agent.radius_cells + disk.radius));
    }
  }
}

/// Radii in eighths are what whole numbers can say.
std::optional<Fraction> in_eighths(double radius) {
  const double eighths = radius * 8;
  if (eighths != std::floor(eighths) || eighths < 1 || eighths > 99) return std::nullopt;
  return Fraction{static_cast<std::int64_t>(eighths), 8};
}

void check_sight(const PlanCase& plan_case) {
  const GridMap& map = plan_case.instance.map;
  if (plan_case.instance.agents.empty()) return;
  const auto radius = in_eighths(plan_case.instance.agents.front().radius_cells);
  if (!radius) return;
  const LineOfSight sight(map, radius->value());
  std::vector<Cell> legal;
  for (std::size_t i = 0; i < map.cell_count(); ++i) {
    const Cell cell = map.cell(i);
    fuzz::require(Claim::kSightIsExact, sight.is_legal(cell) == exactly_legal(map, *radius, cell),
                  "another cell is legal in whole numbers");
    if (sight.is_legal(cell)) legal.push_back(cell);
  }
  // From one cell to all others: a case and its mutants ask from all.
  if (legal.empty()) return;
  const Cell from = legal[plan_case.options.seed % legal.size()];
  for (const Cell to : legal) {
    const bool clear = sight.is_clear(from, to);
    fuzz::require(Claim::kSightIsExact, clear == exactly_clear(map, *radius, from, to),
                  "another path is clear in whole numbers");
    fuzz::require(Claim::kSightIsExact, clear == sight.is_clear(to, from), "the way back is not the same");
  }
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const auto plan_case = fuzz::read_case(data, size);
  if (!plan_case) return -1;
  check_unsafe_times(*plan_case);
  check_sight(*plan_case);
  return 0;
}
