// Large neighbourhood search: what it gives is never worse than what it was given, as right,
// keeps the same guarantee, and depends on no clock.
#include "sipplab/improve.hpp"

#include <rapidcheck.h>

#include <algorithm>
#include <atomic>
#include <chrono>
#include <cmath>
#include <numeric>
#include <thread>

#include "planner/core/attempts.hpp"
#include "planner/grid/neighbourhood.hpp"
#include "planner/improve/replica.hpp"
#include "planner/improve/static_times.hpp"
#include "planner/improve/tighten.hpp"
#include "planner/solve/plan.hpp"
#include "property_tests/support/assert_valid.hpp"
#include "property_tests/support/generators.hpp"
#include "property_tests/support/property.hpp"
#include "property_tests/support/shown.hpp"
#include "sipplab/prioritized_planner.hpp"

namespace sipplab::improvement_laws {
namespace {

/// Of sums of arrivals.
constexpr double kRoundingS = 1e-9;

struct Planned {
  PlanCase plan_case;
  PlanResult result;
};

/// A case that is solved, by ejection in half of them.
Planned any_planned() {
  Planned planned{*any_case(), {}};
  PlannerOptions& options = planned.plan_case.options;
  options.max_restarts = std::min<std::uint64_t>(options.max_restarts, 40);
  if (*rc::gen::arbitrary<bool>()) options.rescheduling = Rescheduling::kEjection;
  classify_case(planned.plan_case);
  note_case(planned.plan_case);
  planned.result = plan(planned.plan_case.instance, options);
  RC_PRE(planned.result.status == PlanStatus::kSolved);
  return planned;
}

/// Those of the plan, with a few iterations of improvement.
PlannerOptions any_improve_options(PlannerOptions options) {
  options.objective = *rc::gen::element(Objective{1, 0}, Objective{0, 1}, Objective{1, 1}, Objective{1, 20});
  options.improve = ImproveBudget{};
  options.improve->iterations = *rc::gen::inRange<std::uint64_t>(0, 40);
  options.seed = *rc::gen::arbitrary<std::uint64_t>();
  return options;
}

ImproveResult improved(const Planned& planned, const PlannerOptions& options) {
  ImproveResult result =
      improve(planned.plan_case.instance, planned.result.solution, planned.result.order(), options);
  RC_CLASSIFY(result.log.improvements > 0, "improved");
  RC_CLASSIFY(result.log.improvements > 1, "improved more than once");
  return result;
}

PlanCost cost_of(const Solution& solution) { return {flowtime_s(solution), makespan_s(solution)}; }

/// Attempts until one makes the plan better; some cases are too easy for that.
constexpr std::uint64_t kMostAttempts = 50;

/// A plan, and what attempts on it have in common.
struct Attempts {
  explicit Attempts(Planned given_plan)
      : planned(std::move(given_plan)),
        planner(single_agent_planner(planned.plan_case.instance, planned.plan_case.options)),
        plan(planned.plan_case.instance, 0, *planner),
        objective(*rc::gen::element(Objective{1, 0}, Objective{0, 1}, Objective{1, 20})),
        times_s(planned.plan_case.instance.agents.size()),
        round{planned.plan_case.instance, objective, roulette, times_s, given().trajectories, {}, {}} {
    RC_PRE(!planned.plan_case.instance.agents.empty());
    for (const AgentIndex agent : planned.result.order()) plan.insert(agent, given().trajectories[agent]);
    round.cost = sipplab::cost_of(planned.plan_case.instance, plan);
  }

  const Solution& given() const { return planned.result.solution; }

  /// Those of some that make the plan better.
  std::vector<Attempt> better() {
    std::vector<Attempt> found;
    const auto seed = *rc::gen::arbitrary<std::uint64_t>();
    for (std::uint64_t i = 0; i < kMostAttempts; ++i) {
      Attempt attempt = try_neighbourhood(round, plan, Random(seed + i));
      if (attempt.is_better) found.push_back(std::move(attempt));
    }
    return found;
  }

  Attempt first_better() {
    const auto seed = *rc::gen::arbitrary<std::uint64_t>();
    for (std::uint64_t i = 0; i < kMostAttempts; ++i) {
      Attempt attempt = try_neighbourhood(round, plan, Random(seed + i));
      if (attempt.is_better) return attempt;
    }
    return {};
  }

  Planned planned;
  std::unique_ptr<SingleAgentPlanner> planner;
  PartialPlan plan;
  Objective objective;
  RuleRoulette roulette;
  std::vector<double> times_s;
  Round round;
};

/// Straight sections between all cells at which a disk may be, shortest paths by Floyd and Warshall.
class AllPaths {
 public:
  AllPaths(const GridMap& map, const LineOfSight& line_of_sight)
      : cells_(map.cell_count()), paths_(cells_ * cells_, kForever) {
    for (std::size_t a = 0; a < cells_; ++a) {
      for (std::size_t b = 0; b < cells_; ++b) {
        if (!line_of_sight.is_legal(map.cell(a)) || !line_of_sight.is_legal(map.cell(b))) continue;
        if (line_of_sight.is_clear(map.cell(a), map.cell(b))) at(a, b) = distance(map.cell(a), map.cell(b));
      }
    }
    for (std::size_t k = 0; k < cells_; ++k) {
      for (std::size_t a = 0; a < cells_; ++a) {
        for (std::size_t b = 0; b < cells_; ++b) at(a, b) = std::min(at(a, b), at(a, k) + at(k, b));
      }
    }
  }
  double& at(std::size_t a, std::size_t b) { return paths_[a * cells_ + b]; }

 private:
  std::size_t cells_;
  std::vector<double> paths_;
};

/// Cases that plan many times.
constexpr int kFewer = kCasesOfWorlds / 20;

/// Rounding of sums of a few dozen lengths.
constexpr double kRoundingCells = 1e-9;

const PropertyRoom room("improvement", [] {
  bool passed = true;

  passed &= property("tightened_cost: what improve begins with", [] {
    const Planned planned = any_planned();
    PlannerOptions options = any_improve_options(planned.plan_case.options);
    options.improve->iterations += 1;  // without iterations the plan stays as it is
    const std::vector<ProgressPoint> curve = improved(planned, options).log.curve;
    const auto first_try = std::find_if(curve.begin(), curve.end(),
                                        [](const ProgressPoint& point) { return point.iteration > 0; });
    const PlanCost begun = std::prev(first_try)->cost;
    const PlanCost tightened =
        tightened_cost(planned.plan_case.instance, planned.result.solution, planned.result.order(), options);
    RC_CLASSIFY(tightened.flowtime_s < curve.front().cost.flowtime_s, "gains something");
    // A pass that gains less than the rounding of sums is not noted.
    RC_ASSERT(std::abs(tightened.flowtime_s - begun.flowtime_s) <= kRoundingS);
    RC_ASSERT(std::abs(tightened.makespan_s - begun.makespan_s) <= kRoundingS);
  });

  passed &= property("improve (1): never worse than what it was given, and as it says", [] {
    const Planned planned = any_planned();
    const PlannerOptions options = any_improve_options(planned.plan_case.options);
    const ImproveResult result = improved(planned, options);
    const PlanCost before = cost_of(planned.result.solution);
    const PlanCost after = cost_of(result.solution);
    RC_ASSERT(!is_better(options.objective, before, after));
    RC_ASSERT(result.log.iterations <= options.improve->iterations);
    RC_ASSERT(result.log.curve.front().cost.flowtime_s == before.flowtime_s);
    RC_ASSERT(result.log.curve.back().cost.flowtime_s == after.flowtime_s);
    RC_ASSERT(result.log.curve.back().cost.makespan_s == after.makespan_s);
    for (std::size_t i = 1; i + 1 < result.log.curve.size(); ++i) {
      RC_ASSERT(is_better(options.objective, result.log.curve[i].cost, result.log.curve[i - 1].cost));
    }
  });

  passed &= property("an attempt is taken over where it gains something, and a second time it does not", [] {
    Attempts attempts(any_planned());
    const Attempt attempt = attempts.first_better();
    RC_ASSERT(attempts.plan.solution() == attempts.given());
    RC_PRE(attempt.is_better);
    PlanCost cost = attempts.round.cost;
    RC_ASSERT(take_over(attempts.round, attempt, {}, attempts.plan, cost));
    RC_ASSERT(is_better(attempts.objective, cost, attempts.round.cost));
    const Solution better = attempts.plan.solution();
    RC_ASSERT(!take_over(attempts.round, attempt, {}, attempts.plan, cost));
    RC_ASSERT(attempts.plan.solution() == better);
  });

  passed &= property(
      "attempts on one plan are taken over after each other where they fit",
      [] {
        Attempts attempts(any_planned());
        PlanCost cost = attempts.round.cost;
        std::vector<AgentIndex> changed;
        std::size_t taken = 0;
        std::size_t refused = 0;
        for (const Attempt& attempt : attempts.better()) {
          if (std::find_first_of(changed.begin(), changed.end(), attempt.robots.begin(),
                                 attempt.robots.end()) != changed.end()) {
            continue;
          }
          if (!take_over(attempts.round, attempt, changed, attempts.plan, cost)) {
            ++refused;
            continue;
          }
          changed.insert(changed.end(), attempt.robots.begin(), attempt.robots.end());
          ++taken;
        }
        const Solution solution = attempts.plan.solution();
        RC_ASSERT(std::abs(flowtime_s(solution) - cost.flowtime_s) < 1e-6);
        assert_valid(attempts.planned.plan_case.instance, solution, {0, attempts.planned.result.order()});
        RC_CLASSIFY(taken > 1, "several");
        RC_CLASSIFY(refused > 0, "one was refused");
      },
      kCasesOfWorlds / 2);

  passed &= property("an attempt that a limit ends says so, and leaves the plan as it was", [] {
    Attempts attempts(any_planned());
    const std::atomic<bool> stop{true};
    Round over = attempts.round;
    over.limits.stop = &stop;
    const auto seed = *rc::gen::arbitrary<std::uint64_t>();
    const Attempt free = try_neighbourhood(attempts.round, attempts.plan, Random(seed));
    const Attempt ended = try_neighbourhood(over, attempts.plan, Random(seed));
    RC_ASSERT(ended.robots == free.robots);
    RC_ASSERT(!free.was_cut_short);
    if (ended.found.size() < free.found.size()) RC_ASSERT(ended.was_cut_short);
    if (ended.was_cut_short) RC_ASSERT(!ended.is_better);
    RC_CLASSIFY(ended.was_cut_short, "cut short");
    RC_ASSERT(attempts.plan.solution() == attempts.given());
  });

  passed &= property("after an attempt that a limit cut short nothing is taken over", [] {
    Attempts attempts(any_planned());
    const Round& round = attempts.round;
    const Givens givens{round.instance, round.objective, round.fastest_s, round.fastest_paths, round.limits};
    Replica replica(givens, 0, *attempts.planner);
    for (const AgentIndex agent : attempts.planned.result.order()) {
      replica.plan().insert(agent, attempts.given().trajectories[agent]);
    }
    replica.set_cost(round.cost);
    const Attempt better = attempts.first_better();
    RC_PRE(better.is_better);
    const bool is_cut_short = *rc::gen::arbitrary<bool>();
    Attempt before;
    before.was_cut_short = is_cut_short;
    RC_ASSERT(!replica.settle(before));
    RC_ASSERT(replica.settle(better) == !is_cut_short);
    RC_ASSERT((replica.plan().solution() == attempts.given()) == is_cut_short);
  });

  passed &= property("by steps, no attempt that would be better is given up for its bounds", [] {
    Planned planned{*any_case(), {}};
    PlannerOptions& options = planned.plan_case.options;
    options.any_angle = false;
    options.weight = 1;
    options.rescheduling = Rescheduling::kEjection;
    options.max_restarts = 40;
    const Instance& instance = planned.plan_case.instance;
    note_case(planned.plan_case);
    planned.result = plan(instance, options);
    RC_PRE(planned.result.status == PlanStatus::kSolved);
    RC_PRE(instance.agents.size() >= 2u);
    const std::unique_ptr<SingleAgentPlanner> planner = single_agent_planner(instance, options);
    PartialPlan plan(instance, 0, *planner);
    const Solution& given = planned.result.solution;
    for (const AgentIndex agent : planned.result.order()) plan.insert(agent, given.trajectories[agent]);
    const Objective objective = *rc::gen::element(Objective{1, 0}, Objective{0, 1}, Objective{1, 1},
                                                  Objective{1, 20}, Objective{3, 1});
    const RuleRoulette roulette;
    std::vector<double> solo_cells;
    for (const Agent& agent : instance.agents) {
      solo_cells.push_back(distance(agent.start, agent.goal));  // not used over a neighbourhood
    }
    const std::vector<double> times_s = static_times_s(instance, false, options.connectedness, solo_cells);
    const PlanCost cost{flowtime_s(given), makespan_s(given)};
    const Round round{instance, objective, roulette, times_s, given.trajectories, cost, {}};
    const auto seed = *rc::gen::arbitrary<std::uint64_t>();
    constexpr std::uint64_t kAttempts = 6;
    for (std::uint64_t i = 0; i < kAttempts; ++i) {
      const Attempt attempt = try_neighbourhood(round, plan, Random(seed + i));
      RC_ASSERT(plan.solution() == given);
      // The same robots in the same sequence, without bounds.
      std::vector<PartialPlan::Taken> taken;
      for (const AgentIndex robot : attempt.robots) taken.push_back(plan.take_out(robot));
      std::vector<AgentIndex> entered;
      for (const AgentIndex robot : attempt.robots) {
        SearchStatistics work;
        auto found = plan.find(robot, {}, work);
        if (!found) break;
        plan.insert(robot, std::move(*found));
        entered.push_back(robot);
      }
      PlanCost now;
      if (entered.size() == attempt.robots.size()) now = cost_of(plan.solution());
      const bool is_better_unbound =
          entered.size() == attempt.robots.size() && sipplab::is_better(objective, now, cost);
      for (const AgentIndex robot : entered) plan.take_out(robot);
      for (PartialPlan::Taken& one : taken) plan.put_back(std::move(one));
      RC_CLASSIFY(is_better_unbound, "better");
      // What gains no more than rounding may go either way.
      const double value = objective.of(cost.flowtime_s, cost.makespan_s);
      const double gain = value - objective.of(now.flowtime_s, now.makespan_s);
      if (is_better_unbound && gain > kRoundingCells) RC_ASSERT(attempt.is_better);
      if (!attempt.is_better) continue;
      RC_ASSERT(is_better_unbound);
      RC_ASSERT(std::abs(attempt.gain - gain) <= kRoundingCells * (1 + value));
    }
  });

  passed &= property("improve (2)(3): valid, and it keeps the guarantee where it was kept", [] {
    const Planned planned = any_planned();
    const PlannerOptions options = any_improve_options(planned.plan_case.options);
    const ImproveResult result = improved(planned, options);
    RC_ASSERT(result.order.has_value());
    RC_ASSERT(result.log.keeps_guarantee);
    assert_valid(planned.plan_case.instance, result.solution, {options.ssi_s, *result.order, options.rules});
  });

  passed &= property("improve (2)(3): a guarantee that was not made is made only where it holds", [] {
    const Planned planned = any_planned();
    PlannerOptions options = any_improve_options(planned.plan_case.options);
    options.ssi_s = *rc::gen::element(1.0, 2.5, 5.0, kInfiniteSsi);
    const ImproveResult result = improved(planned, options);
    RC_CLASSIFY(!result.order, "in no order");
    assert_valid(planned.plan_case.instance, result.solution, {});
    if (result.order)
      assert_valid(planned.plan_case.instance, result.solution,
                   {options.ssi_s, *result.order, options.rules});
  });

  passed &= property("improve (4): the same number of iterations gives the same plan", [] {
    const Planned planned = any_planned();
    PlannerOptions options = any_improve_options(planned.plan_case.options);
    const ImproveResult one = improved(planned, options);
    const ImproveResult same = improved(planned, options);
    RC_ASSERT(one.solution == same.solution);
    RC_ASSERT(one.order == same.order);
    RC_ASSERT(one.statistics.expansions == same.statistics.expansions);
    options.improve->iterations += *rc::gen::inRange<std::uint64_t>(0, 20);
    const ImproveResult longer = improved(planned, options);
    for (std::size_t i = 0; i + 1 < one.log.curve.size(); ++i) {
      RC_ASSERT(longer.log.curve[i].iteration == one.log.curve[i].iteration);
      RC_ASSERT(longer.log.curve[i].cost.flowtime_s == one.log.curve[i].cost.flowtime_s);
    }
  });

  passed &= property(
      "improve (4): the attempts of a round are different ones",
      [] {
        // In one plan they may take as much work as each other by chance, in some plans hardly.
        bool differ = false;
        int plans = 0;
        for (int i = 0; i < 12; ++i) {
          PlanCase plan_case = *any_case_of(CaseFamily::kDense);
          PlannerOptions& options = plan_case.options;
          options.rescheduling = Rescheduling::kEjection;
          options.max_restarts = 40;
          options.improve = ImproveBudget{};
          const PlanResult result = plan(plan_case.instance, options);
          if (result.status != PlanStatus::kSolved || plan_case.instance.agents.size() < 4) continue;
          std::vector<std::uint64_t> work;
          std::uint64_t& iterations = options.improve->iterations;
          for (iterations = 0; iterations <= 4; ++iterations) {  // a round has four
            const ImproveResult some = improve(plan_case.instance, result.solution, result.order(), options);
            if (some.log.iterations == iterations) work.push_back(some.statistics.expansions);
          }
          if (work.size() < 5) continue;  // optimal before
          ++plans;
          for (std::size_t k = 2; k < work.size(); ++k) {
            differ = differ || work[k] - work[k - 1] != work[1] - work[0];
          }
        }
        RC_PRE(plans >= 3);
        RC_ASSERT(differ);
      },
      kFewer);

  passed &= property("attempts find kAttemptsAhead unsettled, in order, on any number of threads", [] {
    struct Made {
      std::uint64_t number = 0;
      std::size_t found_settled = 0;
    };
    const auto workers = *rc::gen::inRange<std::size_t>(1, 5);
    const auto count = *rc::gen::inRange<std::uint64_t>(0, 50);
    const auto seed = *rc::gen::arbitrary<std::uint64_t>();
    std::vector<std::vector<std::uint64_t>> settled(workers);
    const std::vector<Made> made = attempt_and_settle<Made>(
        workers, count,
        [&](std::size_t worker, std::uint64_t number) {
          std::this_thread::sleep_for(std::chrono::microseconds(Random(seed + number).below(50)));
          return Made{number, settled[worker].size()};
        },
        [&](std::size_t worker, const Made& attempt) { settled[worker].push_back(attempt.number); });
    std::vector<std::uint64_t> numbers(count);
    std::iota(numbers.begin(), numbers.end(), 0U);
    for (const std::vector<std::uint64_t>& of_worker : settled) RC_ASSERT(of_worker == numbers);
    RC_ASSERT(made.size() == count);
    for (std::uint64_t number = 0; number < count; ++number) {
      RC_ASSERT(made[number].number == number);
      RC_ASSERT(made[number].found_settled == number + 1 - std::min(kAttemptsAhead, number + 1));
    }
  });

  passed &= property("improve (4): any number of threads gives the same plan", [] {
    const Planned planned = any_planned();
    PlannerOptions options = any_improve_options(planned.plan_case.options);
    const ImproveResult one = improved(planned, options);
    options.threads = *rc::gen::inRange(2U, 5U);
    const ImproveResult several = improved(planned, options);
    RC_ASSERT(one.solution == several.solution);
    RC_ASSERT(one.order == several.order);
    RC_ASSERT(one.log.improvements == several.log.improvements);
    RC_ASSERT(one.statistics.expansions == several.statistics.expansions);
  });

  passed &= property("a search that is stopped at once gives back what it was given", [] {
    const Planned planned = any_planned();
    PlannerOptions options = any_improve_options(planned.plan_case.options);
    const std::atomic<bool> stop{true};
    options.stop = &stop;
    const ImproveResult result = improved(planned, options);
    RC_ASSERT(result.solution == planned.result.solution);
    RC_ASSERT(result.log.iterations == 0u);
  });

  passed &= property("the lower bound is below every plan", [] {
    const Planned planned = any_planned();
    const ImproveResult result = improved(planned, any_improve_options(planned.plan_case.options));
    RC_ASSERT(result.log.bound.flowtime_s <= flowtime_s(result.solution) + kRoundingCells);
    RC_ASSERT(result.log.bound.makespan_s <= makespan_s(result.solution) + kRoundingCells);
  });

  passed &= property("static times are those of the shortest of all paths", [] {
    const PlanCase plan_case = *any_case();
    const Instance& instance = plan_case.instance;
    RC_PRE(!instance.agents.empty() && instance.map.cell_count() <= 100);
    note_case(plan_case);
    const Agent& agent = instance.agents.front();
    const LineOfSight line_of_sight(instance.map, agent.radius_cells);
    AllPaths paths(instance.map, line_of_sight);
    const double shortest = paths.at(instance.map.index(agent.start), instance.map.index(agent.goal));
    RC_PRE(shortest < kForever);
    RC_CLASSIFY(shortest > distance(agent.start, agent.goal), "round a corner");
    const double longest = shortest * *rc::gen::element(1.0, 1.1, 2.0);
    const double found =
        shortest_any_angle_cells(instance.map, line_of_sight, agent.start, agent.goal, longest);
    RC_ASSERT(std::abs(found - shortest) <= kRoundingCells);
  });

  passed &=
      property("static times over a neighbourhood: no longer than any plan, no shorter than straight", [] {
        PlanCase plan_case = *any_case();
        plan_case.options.any_angle = false;
        plan_case.options.weight = 1;
        const Instance& instance = plan_case.instance;
        RC_PRE(!instance.agents.empty());
        note_case(plan_case);
        Instance alone = instance;
        alone.agents.resize(1);
        alone.obstacles.clear();
        const PlanResult result = plan(alone, plan_case.options);
        RC_PRE(result.status == PlanStatus::kSolved);
        const Agent& agent = alone.agents.front();
        const LineOfSight line_of_sight(alone.map, agent.radius_cells);
        const double cells = shortest_grid_cells(alone.map, line_of_sight, agent.start, agent.goal,
                                                 plan_case.options.connectedness);
        RC_CLASSIFY(cells > distance(agent.start, agent.goal), "longer than straight");
        // Without others SIPP on a grid is optimal.
        RC_ASSERT(std::abs(cells / agent.speed_cells_per_s - makespan_s(result.solution)) <=
                  kRoundingCells / agent.speed_cells_per_s);
      });

  return passed;
});

}  // namespace
}  // namespace sipplab::improvement_laws
