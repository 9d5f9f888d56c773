// Times of single functions, on inputs drawn before the clock starts. Names follow the
// rooms: geometry/..., reservation/..., search/..., validator/....
#include <benchmark/benchmark.h>

#include <cstddef>
#include <cstdint>
#include <cstdio>
#include <string>
#include <utility>
#include <vector>

#include "bench/sweep/run_info.hpp"
#include "planner/core/random.hpp"
#include "planner/geometry/collision_interval.hpp"
#include "planner/grid/line_of_sight.hpp"
#include "planner/grid/static_distances.hpp"
#include "planner/reservation/reservation_table.hpp"
#include "planner/search/sipp_search.hpp"
#include "planner/solve/plan.hpp"
#include "sipplab/generator.hpp"
#include "sipplab/validator.hpp"

namespace sipplab {
namespace {

/// Inputs that a benchmark walks through again and again: enough to defeat branch
/// prediction, few enough to stay in the cache. A power of two.
constexpr std::size_t kInputs = 1024;
constexpr std::size_t kCrowd = 128;  ///< robots; the densest warehouse cell that is always solved

const char* const kMap = "warehouse";

Instance warehouse(std::size_t robots) {
  GeneratorOptions options;
  options.agents = robots;
  auto instance = generate_instance(parse_map_spec(kMap).value(), options);
  return std::move(instance.value());
}

Cell random_legal_cell(Random& random, const GridMap& map, const LineOfSight& line_of_sight) {
  while (true) {
    const Cell cell = map.cell(static_cast<std::size_t>(random.below(map.cell_count())));
    if (line_of_sight.is_legal(cell)) return cell;
  }
}

struct MovePair {
  Cell from;
  Cell to;
};

std::vector<MovePair> random_moves(const GridMap& map, const LineOfSight& line_of_sight) {
  Random random(1);
  std::vector<MovePair> moves;
  while (moves.size() < kInputs) {
    const MovePair move{random_legal_cell(random, map, line_of_sight),
                        random_legal_cell(random, map, line_of_sight)};
    if (move.from != move.to) moves.push_back(move);
  }
  return moves;
}

void line_of_sight(benchmark::State& state) {
  const GridMap map = warehouse_map();
  const LineOfSight lines(map, kDefaultRadiusCells);
  const std::vector<MovePair> moves = random_moves(map, lines);
  std::size_t next = 0;
  for ([[maybe_unused]] auto iteration : state) {
    const MovePair& move = moves[next++ % kInputs];
    benchmark::DoNotOptimize(lines.is_clear(move.from, move.to));
  }
}
BENCHMARK(line_of_sight)->Name("geometry/line_of_sight");

/// A mover of up to ten cells and a disk that crosses its neighbourhood.
struct Encounter {
  Move move;
  MovingDisk disk;
};

std::vector<Encounter> random_encounters() {
  Random random(2);
  const auto place = [&random] {
    constexpr std::uint64_t kSide = 10;
    return Vec2{static_cast<double>(random.below(kSide)), static_cast<double>(random.below(kSide))};
  };
  std::vector<Encounter> encounters;
  while (encounters.size() < kInputs) {
    const Displacement step(place(), place());
    const Displacement other(place(), place());
    if (step.length == 0 || other.length == 0) continue;
    const double begin_s = random.unit();
    encounters.push_back(
        {Move(step, 1), MovingDisk::moving(other, begin_s, begin_s + other.length, kDefaultRadiusCells)});
  }
  return encounters;
}

void unsafe_departures_of_a_move(benchmark::State& state) {
  const std::vector<Encounter> encounters = random_encounters();
  std::size_t next = 0;
  for ([[maybe_unused]] auto iteration : state) {
    const Encounter& encounter = encounters[next++ % kInputs];
    benchmark::DoNotOptimize(unsafe_departures(encounter.move, encounter.disk, 2 * kDefaultRadiusCells));
  }
}
BENCHMARK(unsafe_departures_of_a_move)->Name("geometry/unsafe_departures");

void quick_test_of_a_departure(benchmark::State& state) {
  const std::vector<Encounter> encounters = random_encounters();
  std::size_t next = 0;
  for ([[maybe_unused]] auto iteration : state) {
    const Encounter& encounter = encounters[next++ % kInputs];
    benchmark::DoNotOptimize(closeness(encounter.move, 0, encounter.disk, 2 * kDefaultRadiusCells));
  }
}
BENCHMARK(quick_test_of_a_departure)->Name("geometry/closeness");

/// The warehouse with a solved crowd in it; the last robot of the order is left out, so
/// that it can be planned again and again.
struct Crowd {
  Instance instance = warehouse(kCrowd);
  PlanResult result = plan(instance, PlannerOptions{});
  ReservationTable reservations{instance.map, kDefaultRadiusCells};
  AgentIndex left_out = 0;

  Crowd() {
    if (result.status != PlanStatus::kSolved) return;
    left_out = result.order().back();
    for (AgentIndex agent = 0; agent < instance.agents.size(); ++agent) {
      if (agent != left_out) reservations.add(result.solution.trajectories[agent], kDefaultRadiusCells);
    }
  }

  /// False, with the reason in `state`, if there is no crowd to measure in.
  bool ready(benchmark::State& state) const {
    if (result.status == PlanStatus::kSolved) return true;
    state.SkipWithError("the crowd was not solved");
    return false;
  }
};

/// Planned once for all benchmarks.
Crowd& the_crowd() {
  static Crowd crowd;
  return crowd;
}

void safe_intervals(benchmark::State& state) {
  Crowd& crowd = the_crowd();
  if (!crowd.ready(state)) return;
  const LineOfSight lines(crowd.instance.map, kDefaultRadiusCells);
  const std::vector<MovePair> moves = random_moves(crowd.instance.map, lines);
  std::size_t next = 0;
  for ([[maybe_unused]] auto iteration : state) {
    benchmark::DoNotOptimize(
        crowd.reservations.safe_intervals(moves[next++ % kInputs].from, kDefaultRadiusCells).size());
  }
}
BENCHMARK(safe_intervals)->Name("reservation/safe_intervals");

void earliest_departure(benchmark::State& state) {
  Crowd& crowd = the_crowd();
  if (!crowd.ready(state)) return;
  const LineOfSight lines(crowd.instance.map, kDefaultRadiusCells);
  std::vector<Move> clear;
  for (const MovePair& ends : random_moves(crowd.instance.map, lines)) {
    if (!lines.is_clear(ends.from, ends.to)) continue;
    clear.emplace_back(Displacement(centre(ends.from), centre(ends.to)), kDefaultSpeedCellsPerS);
  }
  constexpr double kUntilS = 100;  // past the end of all motion
  std::size_t next = 0;
  for ([[maybe_unused]] auto iteration : state) {
    const Move& move = clear[next++ % clear.size()];
    benchmark::DoNotOptimize(crowd.reservations.earliest_departure(move, kDefaultRadiusCells, 0, kUntilS));
  }
}
BENCHMARK(earliest_departure)->Name("reservation/earliest_departure");

/// One goal and one far cell after the other: nothing is known of the goal yet.
void static_distance(benchmark::State& state) {
  const GridMap map = warehouse_map();
  const LineOfSight lines(map, kDefaultRadiusCells);
  constexpr int kOctile = 3;
  StepTable steps(lines, map.cell_count(), kOctile);
  const std::vector<MovePair> moves = random_moves(map, lines);
  std::size_t next = 0;
  for ([[maybe_unused]] auto iteration : state) {
    StaticDistances distances(map, lines, steps, kOctile);
    const MovePair& ends = moves[next++ % kInputs];
    distances.set_goal(ends.to, ends.from);
    benchmark::DoNotOptimize(distances.excess_cells(ends.from));
  }
}
BENCHMARK(static_distance)->Name("grid/static_distance");

void search_once(benchmark::State& state, const Instance& instance, AgentIndex agent,
                 ReservationTable& reservations, const SippOptions& options = {}) {
  SippSearch search(instance, options);
  SearchStatistics statistics;
  for ([[maybe_unused]] auto iteration : state) {
    const auto trajectory = search.plan(agent, reservations, SearchLimits{}, statistics);
    if (!trajectory) {
      state.SkipWithError("no trajectory");
      return;
    }
  }
  state.counters["expansions"] =
      benchmark::Counter(static_cast<double>(statistics.expansions), benchmark::Counter::kAvgIterations);
}

void search_in_an_empty_world(benchmark::State& state) {
  const Instance instance = warehouse(1);
  ReservationTable reservations(instance.map, kDefaultRadiusCells);
  search_once(state, instance, 0, reservations);
}
BENCHMARK(search_in_an_empty_world)->Name("search/empty")->Unit(benchmark::kMicrosecond);

void search_in_a_crowd(benchmark::State& state, const SippOptions& options) {
  Crowd& crowd = the_crowd();
  if (crowd.ready(state)) search_once(state, crowd.instance, crowd.left_out, crowd.reservations, options);
}

/// Argument: 1 with the map's distances in the heuristic, 0 for the plain twin.
void search_with_static_distances(benchmark::State& state) {
  SippOptions options;
  options.static_distances = state.range(0) != 0;
  search_in_a_crowd(state, options);
}
BENCHMARK(search_with_static_distances)
    ->Name("search/crowded")
    ->ArgName("static_distances")
    ->Arg(1)
    ->Arg(0)
    ->Unit(benchmark::kMicrosecond);

/// Argument: 1 with the path pulled tight at the end.
void weighted_search(benchmark::State& state) {
  constexpr double kTurningWeight = 1.5;  // large enough to leave needless turning points
  SippOptions options;
  options.weight = kTurningWeight;
  options.elastic = state.range(0) != 0;
  search_in_a_crowd(state, options);
}
BENCHMARK(weighted_search)
    ->Name("search/weighted")
    ->ArgName("elastic")
    ->Arg(1)
    ->Arg(0)
    ->Unit(benchmark::kMicrosecond);

void validate_a_plan(benchmark::State& state) {
  const Crowd& crowd = the_crowd();
  if (!crowd.ready(state)) return;
  const ValidationOptions options{kDefaultSsi, crowd.result.order()};
  for ([[maybe_unused]] auto iteration : state) {
    if (!validate(crowd.instance, crowd.result.solution, options).valid()) {
      state.SkipWithError("invalid plan");
      return;
    }
  }
}
BENCHMARK(validate_a_plan)->Name("validator/128_robots")->Unit(benchmark::kMicrosecond);

}  // namespace
}  // namespace sipplab

int main(int argc, char** argv) {
  benchmark::Initialize(&argc, argv);
  if (benchmark::ReportUnrecognizedArguments(argc, argv)) return 2;
  const std::string reason = sipplab::bench::unfit_for_timing();
  if (!reason.empty())
    std::fprintf(stderr, "WARNING: %s: these times are not worth comparing\n", reason.c_str());
  benchmark::RunSpecifiedBenchmarks();
  return 0;
}
