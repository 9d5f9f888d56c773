// Improvement of plans of unit moves: what it gives is right for disks, never worse than what it was given,
// and depends on no clock; its search is exact.
#include <rapidcheck.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>
#include <optional>

#include "planner/complete/complete_planner.hpp"
#include "planner/improve/objective.hpp"
#include "planner/reservation/reservation_table.hpp"
#include "planner/retime/retime.hpp"
#include "planner/retime/steps.hpp"
#include "planner/search/sipp_search.hpp"
#include "planner/solve/improve_stages.hpp"
#include "planner/unit_moves/improve_unit_moves.hpp"
#include "planner/unit_moves/replica.hpp"
#include "planner/unit_moves/route_search.hpp"
#include "property_tests/support/assert_valid.hpp"
#include "property_tests/support/generators.hpp"
#include "property_tests/support/pebble_search.hpp"
#include "property_tests/support/property.hpp"
#include "property_tests/support/shown.hpp"

namespace sipplab::unit_moves_laws {
namespace {

/// Steps of LaCAM: far more than the cases here take.
constexpr std::uint64_t kMostSteps = 20'000;

/// Robots on up to half of the cells of a small map, which drive anywhere: most first plans can be improved.
PlanCase make_crowd(std::uint64_t seed) {
  Random random(seed);
  constexpr std::int32_t kLeastSide = 4;
  constexpr std::uint64_t kSides = 6;
  PlanCase plan_case;
  GridMap& map = plan_case.instance.map;
  map = GridMap(kLeastSide + static_cast<std::int32_t>(random.below(kSides)),
                kLeastSide + static_cast<std::int32_t>(random.below(kSides)));
  std::vector<std::size_t> starts(map.cell_count());
  std::iota(starts.begin(), starts.end(), std::size_t{0});
  std::vector<std::size_t> goals = starts;
  random.shuffle(starts);
  random.shuffle(goals);
  constexpr std::array<double, 3> kRadii = {0.5, 0.4, 0.25};
  const double radius_cells = kRadii[random.below(kRadii.size())];
  const std::size_t robots = 2 + random.below(map.cell_count() / 2 - 1);
  for (std::size_t i = 0; i < robots; ++i) {
    Agent agent;
    agent.start = map.cell(starts[i]);
    agent.goal = map.cell(goals[i]);
    agent.radius_cells = radius_cells;
    plan_case.instance.agents.push_back(agent);
  }
  return plan_case;
}

struct Planned {
  PlanCase plan_case;
  CompleteResult result;
  PlannerOptions options;
};

/// A case that LaCAM solved, and a few iterations for it.
Planned any_planned() {
  const bool is_crowd = *rc::gen::arbitrary<bool>();
  Planned planned{
      is_crowd ? make_crowd(*rc::gen::arbitrary<std::uint64_t>()) : within_complete_model(*any_case()),
      {},
      {}};
  classify_case(planned.plan_case);
  note_case(planned.plan_case);
  planned.options = planned.plan_case.options;
  planned.options.max_expansions = kMostSteps;
  planned.result = plan_complete(planned.plan_case.instance, planned.options);
  RC_PRE(planned.result.status == LacamStatus::kSolved && !planned.plan_case.instance.agents.empty());
  planned.options.objective =
      *rc::gen::element(Objective{1, 0}, Objective{0, 1}, Objective{1, 1}, Objective{1, 20});
  planned.options.improve = ImproveBudget{};
  planned.options.improve->iterations = *rc::gen::inRange<std::uint64_t>(0, 60);
  planned.options.seed = *rc::gen::arbitrary<std::uint64_t>();
  return planned;
}

UnitImprovement improved(const Planned& planned) {
  std::optional<UnitImprovement> result =
      improve_unit_moves(planned.plan_case.instance, planned.result.solution, planned.options);
  RC_PRE(result.has_value());
  RC_CLASSIFY(result->log.improvements > 0, "improved");
  RC_CLASSIFY(result->log.improvements > 2, "improved more than twice");
  return std::move(*result);
}

PlanResult plan_of(const Planned& planned) {
  PlanResult plan;
  plan.status = PlanStatus::kSolved;
  plan.made_by = Method::kComplete;
  plan.solution = planned.result.solution;
  plan.trace.push_back({planned.result.order, std::nullopt, {}});
  plan.ssi_s = planned.options.ssi_s;
  plan.ssi_kept_s = planned.result.ssi_kept_s;
  return plan;
}

/// Routes of a plan of unit moves, at the earliest ticks.
struct Routes {
  Routes(const Instance& instance, const Solution& solution)
      : grid(instance.map),
        moves(grid, std::clamp(2 * largest_radius_cells(instance), kMinRadiusCells, 1.0)) {
    const std::optional<Visits> visits = unit_visits(instance, grid, solution);
    RC_ASSERT(visits.has_value());
    const std::vector<std::int64_t> ticks =
        unit_ticks(grid, *visits, std::clamp(2 * largest_radius_cells(instance), kMinRadiusCells, 1.0));
    RC_PRE(ticks.size() == visits->size());
    for (RobotId robot = 0; robot < visits->robots(); ++robot) {
      Route& route = routes.emplace_back();
      for (VisitId id = visits->first_of(robot); id != kNoVisit; id = (*visits)[id].after) {
        route.push_back({(*visits)[id].cell, static_cast<Tick>(ticks[id])});
      }
      starts.push_back(route.front().cell);
      goals.push_back(route.back().cell);
    }
  }

  FreeGrid grid;
  UnitMoves moves;
  std::vector<Route> routes;
  std::vector<CellId> starts;
  std::vector<CellId> goals;
};

std::vector<Route> routes_of(const Timetable& plan) {
  std::vector<Route> routes;
  for (RobotId robot = 0; robot < plan.robots(); ++robot) routes.push_back(plan.route(robot));
  return routes;
}

UnitCost cost_of(const std::vector<Route>& routes) {
  UnitCost cost;
  for (const Route& route : routes) {
    cost.flowtime += route.back().arrival;
    cost.makespan = std::max(cost.makespan, route.back().arrival);
  }
  return cost;
}

double seconds(Tick tick, const Agent& agent) {
  return static_cast<double>(tick) / kTicksPerMove / agent.speed_cells_per_s;
}

Trajectory trajectory_of(const Routes& plan, const Route& route, const Agent& agent) {
  Trajectory trajectory{plan.grid.cell(route.front().cell), {}};
  for (std::size_t i = 1; i < route.size(); ++i) {
    const Cell from = plan.grid.cell(route[i - 1].cell);
    const double begin_s = seconds(route[i].arrival - kMoveTicks, agent);
    if (begin_s > trajectory.end_s()) trajectory.motions.push_back({trajectory.end_s(), begin_s, from, from});
    trajectory.motions.push_back(
        {trajectory.end_s(), seconds(route[i].arrival, agent), from, plan.grid.cell(route[i].cell)});
  }
  return trajectory;
}

const PropertyRoom room("unit_moves", [] {
  bool passed = true;

  passed &= property("improve_unit_moves (1): never worse than what it was given, and as it says", [] {
    const Planned planned = any_planned();
    const Objective& objective = planned.options.objective;
    const UnitImprovement result = improved(planned);
    const PlanCost before{flowtime_s(planned.result.solution), makespan_s(planned.result.solution)};
    const PlanCost after{flowtime_s(result.solution), makespan_s(result.solution)};
    RC_ASSERT(!is_better(objective, before, after));
    RC_ASSERT(result.log.iterations <= planned.options.improve->iterations);
    for (const ProgressPoint& point : result.log.curve) RC_ASSERT(!is_better(objective, point.cost, after));
    RC_ASSERT(result.log.curve.front().cost.flowtime_s == before.flowtime_s);
    RC_ASSERT(result.log.curve.back().cost.flowtime_s == after.flowtime_s);
    RC_ASSERT(result.log.curve.back().cost.makespan_s == after.makespan_s);
  });

  passed &= property("improve_unit_moves (1): not worse than a plan in which small robots follow closer", [] {
    // All are taken for the largest.
    Planned planned;
    planned.plan_case = at_full_size([] { return make_crowd(*rc::gen::arbitrary<std::uint64_t>()); });
    for (Agent& agent : planned.plan_case.instance.agents) {
      agent.radius_cells = *rc::gen::element(0.125, 0.25, 0.5);
    }
    note_case(planned.plan_case);
    planned.options.max_expansions = kMostSteps;
    planned.result = plan_complete(planned.plan_case.instance, planned.options);
    RC_PRE(planned.result.status == LacamStatus::kSolved);
    const auto closer = retime(planned.plan_case.instance, planned.result.solution);
    RC_PRE(closer && !closer->solution.trajectories.empty());
    planned.options.improve = ImproveBudget{};
    planned.options.improve->iterations = *rc::gen::inRange<std::uint64_t>(0, 20);
    const std::optional<UnitImprovement> result =
        improve_unit_moves(planned.plan_case.instance, closer->solution, planned.options);
    RC_CLASSIFY(!result, "given up");
    if (result) RC_ASSERT(flowtime_s(result->solution) <= flowtime_s(closer->solution));
  });

  passed &= property("improve_unit_moves (2): valid for disks, and of unit moves", [] {
    const Planned planned = any_planned();
    const Instance& instance = planned.plan_case.instance;
    const UnitImprovement result = improved(planned);
    assert_valid(instance, result.solution, {result.order.kept_s, result.order.order, {}});
    RC_ASSERT(unit_visits(instance, FreeGrid(instance.map), result.solution).has_value());
  });

  passed &= property("improve_unit_moves (3): the same number of iterations gives the same plan", [] {
    Planned planned = any_planned();
    const UnitImprovement one = improved(planned);
    planned.options.threads = *rc::gen::inRange(1U, 4U);
    const UnitImprovement same = improved(planned);
    RC_ASSERT(one.solution == same.solution);
    RC_ASSERT(one.order.order == same.order.order);
    RC_ASSERT(one.log.improvements == same.log.improvements);
    RC_ASSERT(one.statistics.expansions == same.statistics.expansions);
  });

  passed &= property("improve_unit_moves (3): the attempts of a round are different ones", [] {
    Planned planned;
    planned.plan_case = at_full_size([] { return make_crowd(*rc::gen::arbitrary<std::uint64_t>()); });
    note_case(planned.plan_case);
    RC_PRE(planned.plan_case.instance.agents.size() >= 6u);
    planned.options.max_expansions = kMostSteps;
    planned.result = plan_complete(planned.plan_case.instance, planned.options);
    RC_PRE(planned.result.status == LacamStatus::kSolved);
    planned.options.improve = ImproveBudget{};
    std::vector<std::uint64_t> work;
    for (std::uint64_t iterations = 0; iterations <= 8; ++iterations) {  // a round has eight
      planned.options.improve->iterations = iterations;
      const UnitImprovement some = improved(planned);
      RC_PRE(some.log.iterations == iterations);
      work.push_back(some.statistics.expansions);
    }
    bool differ = false;
    for (std::size_t k = 2; k < work.size(); ++k) {
      differ = differ || work[k] - work[k - 1] != work[1] - work[0];
    }
    RC_ASSERT(differ);
  });

  passed &= property(
      "an attempt leaves the plan as it was; taken over it costs what is said, as far as allowed", [] {
        const Planned planned = any_planned();
        const Routes plan(planned.plan_case.instance, planned.result.solution);
        SharedDistances distances(plan.grid, plan.starts, plan.goals);
        UnitWorker worker(plan.moves, distances, plan.routes);
        const Objective& objective = planned.options.objective;
        const Roulette<kUnitWays> paths;
        std::vector<Route> routes = plan.routes;
        UnitCost cost = cost_of(routes);
        const double slack = *rc::gen::element(1.0, 1.05, 1.3);
        const auto seed = *rc::gen::arbitrary<std::uint64_t>();
        constexpr std::uint64_t kAttempts = 20;
        for (std::uint64_t i = 0; i < kAttempts; ++i) {
          const double before = value(objective, cost);
          const UnitAttempt attempt =
              worker.attempt({objective, paths, cost, slack * before}, Random(seed + i));
          RC_ASSERT(routes_of(worker.plan()) == routes);
          if (!attempt.is_accepted) continue;
          std::vector<Route> changed = routes;
          for (std::size_t k = 0; k < attempt.robots.size(); ++k)
            changed[attempt.robots[k]] = attempt.found[k];
          const double after = value(objective, cost_of(changed));
          RC_ASSERT(after <= slack * before);
          RC_ASSERT(attempt.gain == std::max(before - after, 0.0));
          RC_CLASSIFY(after < before, "better");
          RC_CLASSIFY(cost_of(changed).makespan < cost.makespan, "less makespan");
          // Meanwhile less may be allowed than in the attempt.
          const double worst = *rc::gen::element(slack * before, before, before - 1);
          const bool is_taken = !worker.take_over({objective, paths, cost, worst}, attempt, cost).empty();
          RC_ASSERT(is_taken == (after <= worst));
          if (is_taken) routes = changed;
          RC_ASSERT(routes_of(worker.plan()) == routes);
          RC_ASSERT(cost.flowtime == cost_of(routes).flowtime);
          RC_ASSERT(cost.makespan == cost_of(routes).makespan);
        }
      });

  passed &= property("after an attempt by unit moves that a limit cut short nothing is taken over", [] {
    const Planned planned = any_planned();
    const Routes plan(planned.plan_case.instance, planned.result.solution);
    SharedDistances distances(plan.grid, plan.starts, plan.goals);
    const SearchLimits limits;
    UnitReplica replica(plan.moves, distances, planned.options.objective, limits);
    replica.begin(plan.routes);
    const auto seed = *rc::gen::arbitrary<std::uint64_t>();
    UnitAttempt accepted;
    for (std::uint64_t i = 0; i < 20 && !accepted.is_accepted; ++i) {
      accepted = replica.attempt(Random(seed + i));
    }
    RC_PRE(accepted.is_accepted);
    const bool is_cut_short = *rc::gen::arbitrary<bool>();
    UnitAttempt before = accepted;
    before.was_cut_short = is_cut_short;
    before.is_accepted = false;
    replica.settle(before);
    replica.settle(accepted);
    RC_ASSERT((routes_of(replica.plan()) == plan.routes) == is_cut_short);
  });

  passed &= property(
      "where unit moves gain nothing more the search goes elsewhere; the best plan is the result",
      [] {
        constexpr std::size_t kMostRobots = 12;
        // Ticks are rounded up: at most so many stops, 4,096 to a second.
        constexpr double kRoundingS = kMostRobots * 50 / 4096.0;
        Planned planned;
        planned.plan_case = at_full_size([] {
          for (auto seed = *rc::gen::arbitrary<std::uint64_t>();; ++seed) {
            PlanCase crowd = make_crowd(seed);
            const std::size_t robots = crowd.instance.agents.size();
            if (robots <= kMostRobots && 3 * robots > crowd.instance.map.cell_count()) return crowd;
          }
        });
        note_case(planned.plan_case);
        const std::vector<Agent>& agents = planned.plan_case.instance.agents;
        planned.options.max_expansions = kMostSteps;
        planned.result = plan_complete(planned.plan_case.instance, planned.options);
        RC_PRE(planned.result.status == LacamStatus::kSolved);
        double least_s = 0;  // the map is empty
        for (const Agent& agent : agents) {
          least_s += std::abs(agent.start.x - agent.goal.x) + std::abs(agent.start.y - agent.goal.y);
        }
        // The first look is after 80 iterations a robot, and each search elsewhere takes as many and more.
        // That no better plan was lost is asserted by the search.
        planned.options.objective =
            *rc::gen::element(Objective{1, 0}, Objective{0, 1}, Objective{1, 1}, Objective{1, 20});
        planned.options.improve = ImproveBudget{};
        planned.options.improve->iterations = agents.size() * *rc::gen::inRange<std::uint64_t>(165, 440);
        const UnitImprovement one = improved(planned);
        RC_CLASSIFY(one.log.iterations > agents.size() * 160 + 64, "elsewhere");
        RC_ASSERT(static_cast<double>(one.log.iterations) >=
                      0.8 * static_cast<double>(planned.options.improve->iterations) ||
                  flowtime_s(one.solution) <= least_s + kRoundingS);
        const std::vector<ProgressPoint>& curve = one.log.curve;
        for (std::size_t i = 1; i < curve.size(); ++i) {
          RC_ASSERT(!is_better(planned.options.objective, curve[i - 1].cost, curve[i].cost));
        }
        assert_valid(planned.plan_case.instance, one.solution, {one.order.kept_s, one.order.order, {}});
        planned.options.threads = *rc::gen::inRange(1U, 4U);
        const UnitImprovement same = improved(planned);
        RC_ASSERT(same.solution == one.solution);
        RC_ASSERT(same.log.improvements == one.log.improvements);
      },
      kCasesOfWorlds / 4);

  passed &= property(
      "a replica that wanders takes over plans that are worse by a share, and rolls back to the best", [] {
        const Planned planned = any_planned();
        const Objective& objective = planned.options.objective;
        const Routes plan(planned.plan_case.instance, planned.result.solution);
        SharedDistances distances(plan.grid, plan.starts, plan.goals);
        const SearchLimits limits;
        UnitReplica replica(plan.moves, distances, objective, limits);
        replica.begin(plan.routes);
        const double before = value(objective, replica.best());
        const auto share = *rc::gen::element(0.0, 0.05, 0.5);
        replica.wander(share);
        const auto seed = *rc::gen::arbitrary<std::uint64_t>();
        UnitWorker worker(plan.moves, distances, plan.routes);
        const UnitAttempt first = worker.attempt(
            {objective, Roulette<kUnitWays>(), replica.cost(), before + share * before}, Random(seed));
        RC_ASSERT(replica.attempt(Random(seed)).is_accepted == first.is_accepted);
        std::vector<Route> routes = plan.routes;
        double worst = before;
        double least = before;
        for (std::uint64_t i = 0; i < 60; ++i) {
          const UnitAttempt attempt = replica.attempt(Random(seed + i));
          replica.settle(attempt);
          for (std::size_t k = 0; attempt.is_accepted && k < attempt.robots.size(); ++k) {
            routes[attempt.robots[k]] = attempt.found[k];
          }
          RC_ASSERT(routes_of(replica.plan()) == routes);
          worst = std::max(worst, value(objective, replica.cost()));
          least = std::min(least, value(objective, replica.cost()));
        }
        RC_ASSERT(worst <= before + share * before);
        RC_CLASSIFY(worst > before, "worse");
        RC_CLASSIFY(worst > 1.05 * before, "much worse");
        const bool stays = *rc::gen::arbitrary<bool>();
        if (stays) replica.stay();
        replica.roll_back();
        if (stays) {
          RC_ASSERT(routes_of(replica.plan()) == routes);
        } else {
          RC_ASSERT(value(objective, cost_of(routes_of(replica.plan()))) == least);
        }
        RC_ASSERT(value(objective, replica.best()) == value(objective, replica.cost()));
      });

  passed &= property("unit moves go on where their last gains are ten times those of cutting corners", [] {
    constexpr std::uint64_t kIterations = 8500;  // and 1,500 are left
    const auto gain_s = *rc::gen::inRange(0, 1000);
    const auto corners_s = *rc::gen::inRange(0, 100);
    const Objective objective = *rc::gen::element(Objective{1, 0}, Objective{0, 1}, Objective{1, 20});
    const auto cost = [](double seconds) { return PlanCost{seconds, seconds}; };
    constexpr double kEndS = 2000;
    const auto since = *rc::gen::inRange<std::uint64_t>(0, 7000);
    ImprovementLog log;
    log.curve = {{0, 0, cost(9 * kEndS)},
                 {1, since, cost(kEndS + gain_s)},
                 {2, *rc::gen::inRange<std::uint64_t>(7001, kIterations), cost(kEndS + gain_s / 2.0)},
                 {3, kIterations, cost(kEndS)}};
    const bool goes_on = unit_moves_go_on(objective, log, cost(kEndS - corners_s));
    const double expected_s = gain_s * 1500.0 / static_cast<double>(kIterations - since);
    RC_PRE(std::abs(expected_s - 10 * corners_s) > 1e-6);
    RC_ASSERT(goes_on == (expected_s > 10 * corners_s));
    RC_CLASSIFY(goes_on, "they go on");
  });

  passed &= property("improvement in stages counts the work of both", [] {
    Planned planned = any_planned();
    const Instance& instance = planned.plan_case.instance;
    PlannerOptions& options = planned.options;
    const PlanResult given = plan_of(planned);
    const auto work = [&](std::uint64_t iterations) {
      options.improve->iterations = iterations;
      return improve_in_stages(instance, given, options, {}).statistics.expansions;
    };
    // Unit moves have most of the iterations, more than half of them in any case.
    const std::uint64_t before = work(0);
    const std::uint64_t after = work(20);
    options.improve->iterations = 10;
    RC_ASSERT(after >= before + improved(planned).statistics.expansions);
  });

  passed &= property(
      "improvement that goes on is no worse than what was begun, with its corners cut",
      [] {
        Planned planned = any_planned();
        const Instance& instance = planned.plan_case.instance;
        const UnitImprovement begun = improved(planned);
        planned.options.improve->iterations += 1;  // without iterations no corners are cut
        const PlanCost tightened = tightened_cost(instance, begun, planned.options);
        const ImproveResult result = improve_in_stages(instance, plan_of(planned), planned.options, begun);
        RC_ASSERT(!is_better(planned.options.objective, tightened, result.log.curve.back().cost));
        assert_valid(instance, result.solution, {result.ssi_kept_s, result.order.value_or(PriorityOrder{})});
      },
      kCasesOfWorlds / 2);

  passed &= property("a search by unit moves arrives when SIPP over the same disks does", [] {
    const Planned planned = any_planned();
    const Instance& instance = planned.plan_case.instance;
    // Bodies of different sizes are all taken for the largest.
    RC_PRE(std::all_of(instance.agents.begin(), instance.agents.end(), [&](const Agent& agent) {
      return agent.radius_cells == instance.agents.front().radius_cells;
    }));
    const Routes plan(instance, planned.result.solution);
    const auto robot = static_cast<RobotId>(*rc::gen::inRange<std::size_t>(0, instance.agents.size()));
    const Agent& agent = instance.agents[robot];
    SharedDistances distances(plan.grid, plan.starts, plan.goals);
    Timetable others(plan.moves, plan.routes.size());
    ReservationTable reservations(instance.map, askers_of(instance));
    for (RobotId other = 0; other < plan.routes.size(); ++other) {
      if (other == robot) continue;
      RC_ASSERT(others.fits(plan.routes[other]));
      others.insert(other, plan.routes[other]);
      reservations.add(trajectory_of(plan, plan.routes[other], agent), agent.radius_cells);
    }
    const Tick before = plan.routes[robot].back().arrival;
    const auto found = RouteSearch(plan.moves, distances).find(robot, others, before, kMostSteps);
    RC_ASSERT(found.has_value());
    RC_ASSERT(others.fits(*found));
    const Tick arrival = found->back().arrival;
    RC_CLASSIFY(arrival < before, "earlier than before");
    RC_CLASSIFY(arrival > distances.least_arrival(robot), "around others");
    SippOptions by_steps;
    by_steps.any_angle = false;
    SearchStatistics statistics;
    const auto exact = SippSearch(instance, by_steps).plan(robot, reservations, {}, statistics);
    RC_ASSERT(static_cast<bool>(exact));
    // Lags are rounded up to ticks, and a queue has buckets of a sixteenth of a move.
    const double tolerance_s = seconds(kMoveTicks / 16 + static_cast<Tick>(found->size()), agent);
    RC_ASSERT(exact->arrival_s() <= seconds(arrival, agent) + 1e-6);
    RC_ASSERT(seconds(arrival, agent) <= exact->arrival_s() + tolerance_s);
  });

  return passed;
});

}  // namespace
}  // namespace sipplab::unit_moves_laws
