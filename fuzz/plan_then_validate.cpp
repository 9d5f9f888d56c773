// Claim: whatever the case, the planner's answer is right. Every plan passes the validator
// and keeps its start-safe intervals; what holds between two runs of the planner holds. The
// input is the text of a case; every law of planner and validator that one instance allows
// is checked, none that need not hold.
#include <algorithm>
#include <cmath>
#include <optional>
#include <string>
#include <vector>

#include "fuzz/support/case_input.hpp"
#include "fuzz/support/claims.hpp"
#include "fuzz/support/target.hpp"
#include "planner/improve/static_times.hpp"
#include "planner/instance/reachability.hpp"
#include "planner/solve/plan.hpp"
#include "property_tests/support/steps_between.hpp"
#include "property_tests/support/symmetry.hpp"
#include "sipplab/validator.hpp"

namespace {

using namespace sipplab;
using fuzz::Claim;
using fuzz::count;
using fuzz::Event;
using fuzz::require;

/// Seconds. Rounding of sums of square roots.
constexpr double kRoundingS = 1e-9;

ValidationOptions guarantees_of(const PlanCase& plan_case, const PlanResult& result) {
  ValidationOptions options;
  options.ssi_s = plan_case.options.ssi_s;
  options.rules = plan_case.options.rules;
  options.order = result.order();
  return options;
}

bool same(const PlanResult& a, const PlanResult& b) {
  return a.status == b.status && a.solution == b.solution &&
         a.statistics.expansions == b.statistics.expansions &&
         a.statistics.generations == b.statistics.generations &&
         std::equal(a.trace.begin(), a.trace.end(), b.trace.begin(), b.trace.end(),
                    [](const Try& one, const Try& other) {
                      return one.order == other.order && one.failed == other.failed;
                    });
}

void count_outcome(const PlanCase& plan_case, const PlanResult& result) {
  count(result.status == PlanStatus::kSolved   ? Event::kSolved
        : result.status == PlanStatus::kFailed ? Event::kFailed
                                               : Event::kLimited);
  if (result.tries() < 2) return;
  count(Event::kRescheduled);
  if (plan_case.options.rescheduling == Rescheduling::kEjection) return;
  count(plan_case.options.rescheduling == Rescheduling::kDeterministic ? Event::kDeterministic
                                                                       : Event::kRandom);
}

void check_plan(const PlanCase& plan_case, const PlanResult& result) {
  const Instance& instance = plan_case.instance;
  const ValidationReport report = validate(instance, result.solution, guarantees_of(plan_case, result));
  require(Claim::kPlanIsValid, report.valid(), report.valid() ? "" : report.violations.front().message);
  require(Claim::kPlanIsCertified, certify(instance, result.solution).collisions == 0,
          "two bodies of a valid plan are proven to overlap");
  double latest_s = 0;
  double sum_s = 0;
  for (const Trajectory& trajectory : result.solution.trajectories) {
    const double arrival_s = trajectory.motions.empty() ? 0 : trajectory.motions.back().end_s;
    latest_s = std::max(latest_s, arrival_s);
    sum_s += arrival_s;
  }
  require(
      Claim::kCostsAreArrivals,
      makespan_s(result.solution) == latest_s && std::abs(flowtime_s(result.solution) - sum_s) <= kRoundingS,
      "makespan or flowtime is not what the trajectories say");
}

/// The agents in their priority order, so that fifo is that order.
PlanCase in_order(const PlanCase& plan_case, const PriorityOrder& order) {
  PlanCase sorted = plan_case;
  for (std::size_t i = 0; i < order.size(); ++i)
    sorted.instance.agents[i] = plan_case.instance.agents[order[i]];
  sorted.options.order = InitialOrder::kFifo;
  sorted.options.rescheduling = Rescheduling::kNone;
  return sorted;
}

PlanResult plan_of(const PlanCase& plan_case) { return plan(plan_case.instance, plan_case.options); }

void check_final_order(const PlanCase& plan_case, const PlanResult& result) {
  PlanCase sorted = in_order(plan_case, result.order());
  const PlanResult replayed = plan_of(sorted);
  bool the_same = replayed.status == PlanStatus::kSolved;
  for (std::size_t i = 0; the_same && i < result.order().size(); ++i) {
    the_same = replayed.solution.trajectories[i] == result.solution.trajectories[result.order()[i]];
  }
  require(Claim::kFinalOrderExplainsPlan, the_same, "planned again in the final order, trajectories differ");
  if (plan_case.options.ssi_s != 0 || sorted.instance.agents.empty()) return;
  sorted.instance.agents.pop_back();
  Solution expected = replayed.solution;
  expected.trajectories.pop_back();
  const PlanResult others = plan_of(sorted);
  require(Claim::kLastRobotAtZero, others.status == PlanStatus::kSolved && others.solution == expected,
          "without the robot of the lowest priority, others move differently");
}

/// What one plan without re-scheduling says about the same case with it, and about the
/// goal of the last robot.
void check_without_rescheduling(const PlanCase& plan_case, const PlanResult& result) {
  PlanCase changed = plan_case;
  changed.options.rescheduling = Rescheduling::kNone;
  const bool was_off = plan_case.options.rescheduling == Rescheduling::kNone;
  const PlanResult off = was_off ? result : plan_of(changed);
  if (off.status != PlanStatus::kSolved) return;
  if (!was_off)
    require(Claim::kReschedulingLosesNone, same(off, result), "re-scheduling changed what was solved");
  if (changed.options.order != InitialOrder::kFifo || changed.instance.agents.empty()) return;
  Agent& last = changed.instance.agents.back();
  last.goal = last.start;
  if (find_error(changed.instance)) return;
  const PlanResult after = plan_of(changed);
  if (after.status != PlanStatus::kSolved) return;
  for (AgentIndex i = 0; i + 1 < changed.instance.agents.size(); ++i) {
    require(Claim::kLastGoalIsFree, after.solution.trajectories[i] == off.solution.trajectories[i],
            "the last robot's goal changed the path of another");
  }
}

void check_budgets(const PlanCase& plan_case, const PlanResult& result) {
  require(Claim::kBudgetIsKept,
          result.statistics.expansions <= plan_case.options.max_expansions &&
              result.tries() <= plan_case.options.max_restarts + 1,
          "more expansions or restarts than allowed");
  if (result.statistics.expansions == 0) return;
  PlanCase less = plan_case;
  less.options.max_expansions = result.statistics.expansions / 2;
  const PlanResult limited = plan_of(less);
  require(
      Claim::kBudgetIsKept,
      limited.status == PlanStatus::kLimit && limited.statistics.expansions <= less.options.max_expansions,
      "half of the expansions are not a limit");
}

/// One robot, first to plan, and nothing that moves: all is known. Radius up to one half.
void check_lone_robot(const PlanCase& plan_case) {
  PlanCase lone = plan_case;
  lone.instance.obstacles.clear();
  if (lone.instance.agents.empty()) return;
  lone.instance.agents.resize(1);
  const Agent& agent = lone.instance.agents[0];
  if (agent.radius_cells > kDefaultRadiusCells) return;
  const PlanResult result = plan_of(lone);
  if (result.status == PlanStatus::kLimit) return;
  const auto steps = steps_between(lone.instance.map, agent.start, agent.goal);
  require(Claim::kLoneRobotIsExact, (result.status == PlanStatus::kSolved) == steps.has_value(),
          "solved, unlike breadth-first search");
  if (!steps) return;
  const double path_cells = result.solution.trajectories[0].arrival_s() * agent.speed_cells_per_s;
  const double rounding_cells = kRoundingS * (1 + agent.speed_cells_per_s);
  require(Claim::kLoneRobotIsExact, path_cells >= distance(agent.start, agent.goal) - rounding_cells,
          "shorter than the straight line");
  if (!lone.options.rules.is_plain()) return;  // turns and delays come on top
  const double weight = lone.options.weight;
  require(Claim::kLoneRobotIsExact, path_cells <= weight * *steps + rounding_cells,
          "longer than breadth-first search");
  const LineOfSight sight(lone.instance.map, agent.radius_cells);
  const double grid_cells =
      shortest_grid_cells(lone.instance.map, sight, agent.start, agent.goal, lone.options.connectedness);
  require(Claim::kLoneRobotIsExact, path_cells <= weight * grid_cells + rounding_cells,
          "longer than the shortest path over the neighbourhood");
  require(Claim::kLoneRobotIsExact, lone.options.any_angle || path_cells >= grid_cells - rounding_cells,
          "shorter than the shortest path over the neighbourhood");
}

/// The verdict on a plan, seen from elsewhere and with one robot less.
void check_verdict(const PlanCase& plan_case, const PlanResult& result) {
  const Scene scene{plan_case.instance, result.solution};
  const ValidationOptions options = guarantees_of(plan_case, result);
  const auto valid = [&](const Scene& seen, double slower = 1) {
    ValidationOptions changed = options;
    changed.ssi_s *= slower;
    changed.rules.wait_before_move_s *= slower;
    changed.rules.inflate_time_s *= slower;
    return validate(seen.instance, seen.solution, changed).valid();
  };
  require(Claim::kVerdictIsInvariant, valid(rotated(scene)), "invalid after a quarter turn");
  require(Claim::kVerdictIsInvariant, valid(reflected(scene)), "invalid in a mirror");
  require(Claim::kVerdictIsInvariant, valid(slowed(scene, 2), 2), "invalid at half the speed");
  if (scene.instance.agents.empty()) return;
  const AgentIndex gone = plan_case.options.seed % scene.instance.agents.size();
  const Scene fewer = without_agent(scene, gone);
  ValidationOptions without = options;
  without.order = without_agent(options.order, gone);
  require(Claim::kVerdictIsInvariant, validate(fewer.instance, fewer.solution, without).valid(),
          "invalid without one robot");
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const std::optional<PlanCase> plan_case = fuzz::read_case(data, size);
  if (!plan_case) return -1;
  const PlanResult result = plan_of(*plan_case);
  count_outcome(*plan_case, result);
  const bool solved = result.status == PlanStatus::kSolved;
  require(Claim::kResultIsWhole,
          result.tries() >= 1 && result.solution.trajectories.size() ==
                                     (solved ? plan_case->instance.agents.size() : std::size_t{0}),
          "a plan for some robots only");
  require(Claim::kUnreachableIsUnsolved, !solved || !find_unreachable_goal(plan_case->instance),
          "solved with a goal that cannot be reached");
  if (solved) check_plan(*plan_case, result);
  check_lone_robot(*plan_case);
  // Laws that need more plans take turns, so that twice as many cases are seen. The seed
  // decides, which stays the same while a case is made smaller.
  switch (plan_case->options.seed % 5) {
    case 0:
      require(Claim::kSameInputSamePlan, same(result, plan_of(*plan_case)),
              "planned again, something differs");
      break;
    case 1:
      check_budgets(*plan_case, result);
      break;
    case 2:
      if (solved) check_verdict(*plan_case, result);
      break;
    case 3:
      // A plan that was repaired by ejection is not planned again in its final order.
      if (solved && plan_case->options.rescheduling != Rescheduling::kEjection) {
        check_final_order(*plan_case, result);
      }
      break;
    default:
      check_without_rescheduling(*plan_case, result);
      break;
  }
  return 0;
}
