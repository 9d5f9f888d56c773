// Claim: closed forms of unsafe times agree with distances and bisection, and line of sight
// with whole numbers. The robots of a case are moves that have no eyes for each other, its
// obstacles are disks on their way; nothing is planned.
#include <algorithm>
#include <cmath>
#include <optional>
#include <vector>

#include "fuzz/support/case_input.hpp"
#include "fuzz/support/claims.hpp"
#include "fuzz/support/target.hpp"
#include "planner/core/tolerances.hpp"
#include "planner/geometry/collision_interval.hpp"
#include "planner/grid/line_of_sight.hpp"
#include "property_tests/support/distance_oracle.hpp"
#include "property_tests/support/exact_line_of_sight.hpp"

namespace {

using namespace sipplab;
using fuzz::Claim;

/// Slacks from the end of an interval at which the verdict has to be that of its inside: an
/// end is off by one slack, rounding included by two.
constexpr double kSlacksInside = 4;
/// How far from an end the times near it are checked, in seconds.
constexpr double kBesideS[] = {1e-8, 1e-6, 1e-4, 1e-2, 0.25};
/// Times that are looked at all over a span.
constexpr int kSpread = 12;
/// Range for which the oracle's rounding is known: seconds, cells per second.
constexpr double kLatestS = 1e4;
constexpr double kFastest = 8;
/// Pairs of a move and a disk that one input may cost: a bisection takes 50 microseconds.
constexpr int kMostPairs = 12;

/// One interval and the distances that it has to agree with.
struct Question {
  OpenInterval unsafe;
  BisectedSpan bisected;
  double first_s;  ///< nothing can overlap before ...
  double last_s;   ///< ... nor after, possibly kForever
  double reach;
  double slack_s;
  double rounding_cells;
  double rounding_s;
};

void require_right(bool condition, const char* detail) {
  fuzz::require(Claim::kClosedFormIsRight, condition, detail);
}

std::vector<double> times_to_ask(const Question& question) {
  const double last_s = question.last_s == kForever ? question.bisected.deepest_s + 10 : question.last_s;
  std::vector<double> times{question.bisected.deepest_s};
  for (int i = 0; i <= kSpread; ++i) {
    times.push_back(question.first_s - 1 + (last_s + 2 - question.first_s) * i / kSpread);
  }
  for (const double end_s :
       {question.unsafe.begin_s, question.unsafe.end_s, question.bisected.begin_s, question.bisected.end_s}) {
    if (end_s == kForever) continue;
    times.push_back(end_s);
    for (const double beside_s : kBesideS) {
      times.push_back(end_s - beside_s);
      times.push_back(end_s + beside_s);
    }
  }
  return times;
}

/// An end that is not where the obstacle's motion ends is a contact.
template <class Distance>
void check_end(const Question& question, double end_s, double motion_end_s, const Distance& distance) {
  if (end_s == kForever) return require_right(motion_end_s == kForever, "endless without a reason");
  if (std::abs(end_s - motion_end_s) <= 2 * question.slack_s + question.rounding_s) return;
  const double off = distance(end_s) - question.reach;
  require_right(std::abs(off) <= kPermittedDepthCells + question.rounding_cells, "an end that is no contact");
}

template <class Distance>
void check_question(const Question& question, const Distance& distance) {
  fuzz::count(fuzz::Event::kComparisons);
  const OpenInterval& unsafe = question.unsafe;
  if (question.bisected.least_cells > question.reach - kTouchDepthCells / 2) {
    require_right(unsafe.empty(), "unsafe, though the two only touch");
  }
  const double inside_s = kSlacksInside * question.slack_s + question.rounding_s;
  for (const double time_s : times_to_ask(question)) {
    const double apart = distance(time_s);
    if (!unsafe.contains(time_s)) {
      require_right(apart >= question.reach - kPermittedDepthCells - question.rounding_cells,
                    "overlap at a time that is called safe");
    } else if (time_s > unsafe.begin_s + inside_s && time_s < unsafe.end_s - inside_s) {
      require_right(apart < question.reach + question.rounding_cells,
                    "apart at a time that is called unsafe");
    }
  }
  if (unsafe.empty()) return;
  check_end(question, unsafe.begin_s, question.first_s, distance);
  check_end(question, unsafe.end_s, question.last_s, distance);
}

void check_departures(const Move& move, const MovingDisk& disk, double reach) {
  const double latest_s = (disk.end_s == kForever ? disk.begin_s : disk.end_s) + move.duration;
  const Question question{unsafe_departures(move, disk, reach),
                          bisect_departures(move, disk, reach),
                          disk.begin_s - move.duration,
                          disk.end_s,
                          reach,
                          kContactSlackCells / std::max(move.speed, disk.speed),
                          rounding_cells(latest_s, move.speed + disk.speed),
                          time_rounding_s(latest_s)};
  check_question(question, [&](double departure_s) {
    return closest_approach(leg_of(move, departure_s), leg_of(disk));
  });
}

void check_collisions(Vec2 place, const MovingDisk& disk, double reach) {
  const double latest_s = disk.end_s == kForever ? disk.begin_s : disk.end_s;
  const Question question{collision_interval(place, disk, reach),
                          bisect_collision(place, disk, reach),
                          disk.begin_s,
                          disk.end_s,
                          reach,
                          disk.at_rest() ? kContactSlackCells : kContactSlackCells / disk.speed,
                          rounding_cells(latest_s, disk.speed),
                          time_rounding_s(latest_s)};
  check_question(question, [&](double time_s) { return distance_at(place, disk, time_s); });
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
    const Displacement way(centre(agent.start), centre(agent.goal));
    add(MovingDisk::moving(way, begin_s, begin_s + way.length / agent.speed_cells_per_s, agent.radius_cells));
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
      check_departures(move, disk, agent.radius_cells + disk.radius);
      check_collisions(move.way.from, disk, agent.radius_cells + disk.radius);
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
                  "another way is clear in whole numbers");
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
