// Plans of LaCAM: what it solves, against an exhaustive search; that they are valid; for how long the order
// keeps the starts safe. Its search and single steps: lacam.cpp.
#include <rapidcheck.h>

#include <algorithm>
#include <cstdlib>
#include <numeric>
#include <utility>

#include "planner/complete/complete_planner.hpp"
#include "planner/solve/plan.hpp"
#include "property_tests/support/crowds.hpp"
#include "property_tests/support/generators.hpp"
#include "property_tests/support/pebble_search.hpp"
#include "property_tests/support/property.hpp"
#include "sipplab/solve.hpp"
#include "sipplab/validator.hpp"

namespace sipplab::complete_planning_laws {
namespace {

/// Steps: far more than the cases here take, a few milliseconds each at most.
constexpr std::uint64_t kMostSteps = 20'000;

PlannerOptions options_of(const PlanCase& plan_case) {
  PlannerOptions options = plan_case.options;
  options.max_expansions = kMostSteps;
  return options;
}

PlanCase any_case_within_model() {
  PlanCase plan_case = within_complete_model(*any_case());
  classify_case(plan_case);
  note_case(plan_case);
  return plan_case;
}

/// Of each cell, the robots that come to it, one after the other.
std::vector<std::vector<AgentIndex>> visitors_of(const GridMap& map, const Solution& solution) {
  std::vector<std::vector<std::pair<double, AgentIndex>>> comings(map.cell_count());
  for (AgentIndex robot = 0; robot < solution.trajectories.size(); ++robot) {
    const Trajectory& trajectory = solution.trajectories[robot];
    comings[map.index(trajectory.start)].emplace_back(-1, robot);
    for (const TimedMotion& motion : trajectory.motions) {
      const Cell path{motion.to.x - motion.from.x, motion.to.y - motion.from.y};
      const std::int32_t cells = std::abs(path.x) + std::abs(path.y);
      for (std::int32_t i = 1; i <= cells; ++i) {
        const Cell cell{motion.from.x + path.x / cells * i, motion.from.y + path.y / cells * i};
        comings[map.index(cell)].emplace_back(motion.begin_s + (motion.end_s - motion.begin_s) * i / cells,
                                              robot);
      }
    }
  }
  std::vector<std::vector<AgentIndex>> visitors;
  for (auto& coming : comings) {
    std::sort(coming.begin(), coming.end());
    visitors.emplace_back();
    for (const auto& [time_s, robot] : coming) visitors.back().push_back(robot);
  }
  return visitors;
}

bool is_valid(const Instance& instance, const Solution& solution, double ssi_s,
              const std::vector<AgentIndex>& order) {
  ValidationOptions options;
  options.ssi_s = ssi_s;
  options.order = order;
  return validate(instance, solution, options).valid();
}

const PropertyRoom room("complete_planning", [] {
  bool passed = true;

  passed &= property("plan_complete (1): solves exactly what an exhaustive search solves", [] {
    const PlanCase plan_case = any_crowd();
    const CompleteResult result = plan_complete(plan_case.instance, PlannerOptions{});
    const bool solvable = is_solvable_by_pebbles(plan_case.instance);
    RC_CLASSIFY(solvable, "solvable");
    RC_ASSERT(result.status == (solvable ? LacamStatus::kSolved : LacamStatus::kUnsolvable));
  });

  passed &= property("plan_complete (2): every plan of a crowd is valid, its guarantee kept", [] {
    const PlanCase plan_case = any_crowd();
    const CompleteResult result = plan_complete(plan_case.instance, options_of(plan_case));
    RC_CLASSIFY(result.status == LacamStatus::kSolved, "solved");
    if (result.status != LacamStatus::kSolved) return;
    RC_ASSERT(is_valid(plan_case.instance, result.solution, result.ssi_kept_s, result.order));
  });

  passed &= property("plan_complete (2): every plan is valid, its guarantee kept", [] {
    const PlanCase plan_case = any_case_within_model();
    RC_ASSERT(!find_beyond_complete(plan_case.instance));
    const CompleteResult result = plan_complete(plan_case.instance, options_of(plan_case));
    RC_CLASSIFY(result.status == LacamStatus::kSolved, "solved");
    if (result.status != LacamStatus::kSolved) return;
    RC_ASSERT(result.ssi_kept_s <= plan_case.options.ssi_s);
    RC_ASSERT(is_valid(plan_case.instance, result.solution, result.ssi_kept_s, result.order));
  });

  passed &= property("plan_complete (2): no order keeps the starts safe for longer", [] {
    constexpr double kLongerS = 1e-3;
    const PlanCase plan_case = any_crowd();
    RC_PRE(plan_case.instance.agents.size() <= 5u);
    const CompleteResult result = plan_complete(plan_case.instance, options_of(plan_case));
    if (result.status != LacamStatus::kSolved) return;
    const bool all_of_it = result.ssi_kept_s == plan_case.options.ssi_s;
    RC_CLASSIFY(!all_of_it, "not kept to the end");
    if (all_of_it) return;
    std::vector<AgentIndex> order(plan_case.instance.agents.size());
    std::iota(order.begin(), order.end(), AgentIndex{0});
    do {
      RC_ASSERT(!is_valid(plan_case.instance, result.solution, result.ssi_kept_s + kLongerS, order));
    } while (std::next_permutation(order.begin(), order.end()));
  });

  passed &= property("plan_complete (2): of the orders that keep them safe as long, the first", [] {
    const PlanCase plan_case = any_crowd();
    RC_PRE(plan_case.instance.agents.size() <= 5u);
    const CompleteResult result = plan_complete(plan_case.instance, options_of(plan_case));
    if (result.status != LacamStatus::kSolved) return;
    std::vector<AgentIndex> order(plan_case.instance.agents.size());
    std::iota(order.begin(), order.end(), AgentIndex{0});
    RC_CLASSIFY(result.order != order, "not that of input");
    while (!is_valid(plan_case.instance, result.solution, result.ssi_kept_s, order)) {
      RC_ASSERT(std::next_permutation(order.begin(), order.end()));
    }
    RC_ASSERT(result.order == order);
  });

  passed &= property("plan_complete (2): no robot leaves a cell and comes back before anybody else came", [] {
    const PlanCase plan_case = any_crowd();
    const CompleteResult result = plan_complete(plan_case.instance, options_of(plan_case));
    if (result.status != LacamStatus::kSolved) return;
    for (const std::vector<AgentIndex>& visitors : visitors_of(plan_case.instance.map, result.solution)) {
      RC_ASSERT(std::adjacent_find(visitors.begin(), visitors.end()) == visitors.end());
    }
  });

  passed &= property("plan_complete (4): no plan for another objective costs less by this one", [] {
    const PlanCase plan_case = any_case_within_model();
    PlannerOptions options = options_of(plan_case);
    const std::vector<Objective> objectives = {{1, 0}, {0, 1}, {1, 4}};
    std::vector<CompleteResult> results;
    for (const Objective& objective : objectives) {
      options.objective = objective;
      results.push_back(plan_complete(plan_case.instance, options));
    }
    if (results.front().status != LacamStatus::kSolved) return;
    RC_CLASSIFY(results[0].solution != results[1].solution, "objectives differ in their plans");
    for (std::size_t i = 0; i < objectives.size(); ++i) {
      const auto cost = [&](const CompleteResult& result) {
        return objectives[i].flowtime_weight * flowtime_s(result.solution) +
               objectives[i].makespan_weight * makespan_s(result.solution);
      };
      for (const CompleteResult& other : results) RC_ASSERT(cost(results[i]) <= cost(other) + 1e-9);
    }
  });

  passed &= property("plan_complete: budgets of steps are kept by all of its plans together", [] {
    const PlanCase plan_case = any_case_within_model();
    PlannerOptions options = options_of(plan_case);
    const CompleteResult free = plan_complete(plan_case.instance, options);
    RC_PRE(free.steps_tried > 0u);
    options.max_expansions = *rc::gen::inRange<std::uint64_t>(0, free.steps_tried + 2);
    const CompleteResult limited = plan_complete(plan_case.instance, options);
    RC_ASSERT(limited.steps_tried <= options.max_expansions);
    if (options.max_expansions >= free.steps_tried) RC_ASSERT(limited.solution == free.solution);
    if (limited.status == LacamStatus::kSolved) RC_ASSERT(free.status == LacamStatus::kSolved);
  });

  passed &= property("plan_complete (3): the same case gives the same plan", [] {
    const PlanCase plan_case = any_case_within_model();
    const CompleteResult one = plan_complete(plan_case.instance, options_of(plan_case));
    const CompleteResult other = plan_complete(plan_case.instance, options_of(plan_case));
    RC_ASSERT(one.status == other.status);
    RC_ASSERT(one.solution == other.solution);
    RC_ASSERT(one.order == other.order);
    RC_ASSERT(one.ssi_kept_s == other.ssi_kept_s);
    RC_ASSERT(one.steps_tried == other.steps_tried);
  });

  passed &= property("a fallback plans what was not solved, and changes nothing else", [] {
    PlanCase plan_case = any_case_within_model();
    plan_case.options.max_expansions = std::min(plan_case.options.max_expansions, kMostSteps);
    const PlanResult without = plan(plan_case.instance, plan_case.options);
    plan_case.options.fallback = Fallback::kComplete;
    const PlanResult with = plan(plan_case.instance, plan_case.options);
    const bool needed = without.status != PlanStatus::kSolved;
    RC_CLASSIFY(needed, "needed");
    RC_CLASSIFY(needed && with.status == PlanStatus::kSolved, "saved");
    RC_ASSERT(with.made_by == (needed ? Method::kComplete : Method::kPrioritized));
    if (!needed) {
      RC_ASSERT(with.solution == without.solution);
      RC_ASSERT(with.ssi_kept_s == plan_case.options.ssi_s);
    } else if (with.status == PlanStatus::kSolved) {
      RC_ASSERT(with.tries() == without.tries() + 1);
      const CompleteResult complete = plan_complete(plan_case.instance, plan_case.options);
      RC_ASSERT(with.statistics.expansions == without.statistics.expansions + complete.steps_tried);
      RC_ASSERT(with.statistics.generations == without.statistics.generations + complete.configurations);
      RC_ASSERT(with.ssi_kept_s == complete.ssi_kept_s);
      RC_ASSERT(is_valid(plan_case.instance, with.solution, with.ssi_kept_s, with.order()));
    }
  });

  passed &= property("bodies, speeds and obstacles beyond the model are refused in one line", [] {
    const PlanCase plan_case = *any_case();
    const Instance& instance = plan_case.instance;
    const bool beyond = !instance.obstacles.empty() ||
                        std::any_of(instance.agents.begin(), instance.agents.end(), [&](const Agent& agent) {
                          return agent.radius_cells > kDefaultRadiusCells ||
                                 agent.speed_cells_per_s != instance.agents.front().speed_cells_per_s;
                        });
    RC_CLASSIFY(beyond, "beyond");
    MotionRules rules;
    rules.wait_before_move_s = *rc::gen::element(0.0, 0.0, 0.5);
    RC_ASSERT(find_beyond_complete(instance, rules).has_value() == (beyond || rules.wait_before_move_s > 0));
    rules = {true};
    RC_ASSERT(find_beyond_complete(instance, rules).has_value());
    const auto error = find_beyond_complete(instance);
    RC_ASSERT(error.has_value() == beyond);
    if (!error) return;
    RC_ASSERT(!error->what.empty() && !error->expected.empty());
    RC_ASSERT((error->what + error->expected).find('\n') == std::string::npos);
    PlannerOptions options;
    options.method = Method::kComplete;
    RC_ASSERT(plan(instance, options).status == PlanStatus::kFailed);
  });

  passed &= property("what the improvement of its plan says that it keeps, it keeps", [] {
    const PlanCase plan_case = any_crowd();
    PlannerOptions options = options_of(plan_case);
    options.method = Method::kComplete;
    options.improve = ImproveBudget{};
    options.improve->iterations = 3;
    const SolveResult result = solve(plan_case.instance, options);
    if (!result.improvement) return;
    RC_CLASSIFY(result.plan.ssi_kept_s < options.ssi_s, "not kept to the end");
    RC_ASSERT(result.improvement->log.keeps_guarantee);
    RC_ASSERT(result.ssi_kept_s() <= options.ssi_s);
    RC_ASSERT(is_valid(plan_case.instance, result.solution(), result.ssi_kept_s(), result.order()));
  });

  passed &= property("inflation does not go with ejection, improvement or the best plan", [] {
    const Instance instance = (*any_case()).instance;
    PlannerOptions options;
    const int kind = *rc::gen::inRange(0, 4);
    if (kind == 1) options.rescheduling = Rescheduling::kEjection;
    if (kind == 2) options.improve = ImproveBudget{};
    if (kind == 3) options.best = true;
    RC_ASSERT(!find_beyond(instance, options));
    (*rc::gen::arbitrary<bool>() ? options.rules.inflate_time_s : options.rules.inflate_distance_cells) = 0.5;
    RC_ASSERT(find_beyond(instance, options).has_value() == (kind > 0));
  });

  return passed;
});

}  // namespace
}  // namespace sipplab::complete_planning_laws
