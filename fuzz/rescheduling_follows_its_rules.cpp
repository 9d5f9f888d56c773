// Claim: each priority order follows from the failure before it as its method says, no order
// is tried twice, and giving up means that nothing was left to try. Checked on the traces of
// plans, and on the sequence of orders alone with failures that no planner would produce.
#include <set>
#include <string>
#include <vector>

#include "fuzz/support/case_input.hpp"
#include "fuzz/support/claims.hpp"
#include "fuzz/support/target.hpp"
#include "planner/grid/neighbourhood.hpp"
#include "planner/prioritized/priority_order.hpp"
#include "planner/solve/plan.hpp"
#include "property_tests/support/order_rules.hpp"

namespace {

using namespace sipplab;
using fuzz::Claim;

/// Failures that are made up for one sequence of orders.
constexpr int kMostFailures = 30;

/// Rounding of a distance over a speed, in seconds.
constexpr double kRoundingS = 1e-9;

void require_rule(bool condition, const char* detail) {
  fuzz::require(Claim::kTraceFollowsRules, condition, detail);
}

void require_none(const std::string& wrong) {
  fuzz::require(Claim::kTraceFollowsRules, wrong.empty(), wrong);
}

/// Seconds that the robot needs at least, by which orders are sorted.
double least_time_s(const PlanCase& plan_case, AgentIndex robot) {
  const Agent& agent = plan_case.instance.agents[robot];
  const PlannerOptions& options = plan_case.options;
  const double cells = options.any_angle
                           ? distance(agent.start, agent.goal)
                           : neighbourhood_distance(agent.start, agent.goal, options.connectedness);
  return cells / agent.speed_cells_per_s;
}

bool may_follow(const PlanCase& plan_case, AgentIndex before, AgentIndex behind) {
  const double before_s = least_time_s(plan_case, before);
  const double behind_s = least_time_s(plan_case, behind);
  switch (plan_case.options.order) {
    case InitialOrder::kFifo:
      return before < behind;
    case InitialOrder::kShortestFirst:
      return before_s <= behind_s + kRoundingS;
    case InitialOrder::kLongestFirst:
      return before_s >= behind_s - kRoundingS;
    default:
      return true;
  }
}

void check_first_order(const PlanCase& plan_case, const PriorityOrder& order) {
  if (!plan_case.options.rules.is_plain()) return;  // turns and delays come on top
  for (std::size_t i = 1; i < order.size(); ++i) {
    require_rule(may_follow(plan_case, order[i - 1], order[i]), "a first order that is not as its name says");
  }
}

/// What the first try did is part of what all tries did together.
void check_work(const PlanCase& plan_case, const PlanResult& result) {
  PlanCase once = plan_case;
  once.options.max_restarts = 0;
  const PlanResult first = plan(once.instance, once.options);
  require_rule(first.trace.front().order == result.trace.front().order, "another first order");
  require_rule(first.statistics.expansions <= result.statistics.expansions &&
                   first.statistics.generations <= result.statistics.generations,
               "all tries did less than the first");
}

void check_trace(const PlanCase& plan_case) {
  const PlanResult result = plan(plan_case.instance, plan_case.options);
  if (result.tries() > 1) {
    fuzz::count(fuzz::Event::kRescheduled);
    check_work(plan_case, result);
  }
  if (result.tries() > 0) check_first_order(plan_case, result.trace.front().order);
  if (result.tries() > 0) require_none(find_wrong_try(plan_case, result));
}

void check_sequence(const PlanCase& plan_case) {
  const std::size_t agents = plan_case.instance.agents.size();
  if (agents == 0) return;
  Random failures(plan_case.options.seed);
  std::vector<double> lengths_s;
  for (const Agent& agent : plan_case.instance.agents) lengths_s.push_back(distance(agent.start, agent.goal));
  PriorityOrder first = initial_order(plan_case.options.order, lengths_s, failures);
  require_rule(is_permutation_of(first, agents), "a first order with robots missing");
  OrderSequence orders(plan_case.options.rescheduling, first, failures);
  std::set<PriorityOrder> tried{first};
  for (int i = 0; i < kMostFailures; ++i) {
    const PriorityOrder order = orders.current();
    const AgentIndex failed = failures.below(agents);
    const bool more = orders.advance(failed);
    require_none(find_wrong_step(plan_case.options.rescheduling, tried, order, failed,
                                 more ? &orders.current() : nullptr));
    if (!more) return;
    tried.insert(orders.current());
  }
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const auto plan_case = fuzz::read_case(data, size);
  if (!plan_case) return -1;
  // Ejection repairs one plan and tries no orders: property_tests/properties/ejection.cpp.
  if (plan_case->options.rescheduling == Rescheduling::kEjection) return -1;
  check_trace(*plan_case);
  check_sequence(*plan_case);
  return 0;
}
