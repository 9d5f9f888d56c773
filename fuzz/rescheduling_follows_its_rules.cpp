// Claim: each priority order follows from the failure before it as its method says, no order
// is tried twice, and giving up means that nothing was left to try. Checked on the traces of
// plans, and on the sequence of orders alone with failures that no planner would produce.
#include <algorithm>
#include <numeric>
#include <set>
#include <vector>

#include "fuzz/support/case_input.hpp"
#include "fuzz/support/claims.hpp"
#include "fuzz/support/target.hpp"
#include "planner/prioritized/prioritized_planner.hpp"

namespace {

using namespace sipplab;
using fuzz::Claim;

/// Failures that are made up for one sequence of orders.
constexpr int kMostFailures = 30;

void require_rule(bool condition, const char* detail) {
  fuzz::require(Claim::kTraceFollowsRules, condition, detail);
}

bool is_permutation_of(PriorityOrder order, std::size_t agents) {
  std::sort(order.begin(), order.end());
  PriorityOrder expected(agents);
  std::iota(expected.begin(), expected.end(), AgentIndex{0});
  return order == expected;
}

PriorityOrder moved_to_front(PriorityOrder order, AgentIndex agent) {
  const auto position = std::find(order.begin(), order.end(), agent);
  std::rotate(order.begin(), position, position + 1);
  return order;
}

std::size_t factorial(std::size_t n) {
  std::size_t product = 1;
  for (std::size_t i = 2; i <= n; ++i) product *= i;
  return product;
}

/// One step of a method, seen from outside: `next` is empty where it gave up.
void check_step(Rescheduling rescheduling, const std::set<PriorityOrder>& tried, const PriorityOrder& order,
                AgentIndex failed, const PriorityOrder* next) {
  if (next != nullptr) {
    require_rule(is_permutation_of(*next, order.size()), "an order that is none of all robots");
    require_rule(tried.count(*next) == 0, "an order is tried twice");
  }
  switch (rescheduling) {
    case Rescheduling::kNone:
      return require_rule(next == nullptr, "a second order without re-scheduling");
    case Rescheduling::kDeterministic: {
      const PriorityOrder expected = moved_to_front(order, failed);
      if (next != nullptr) return require_rule(*next == expected, "not the failed robot to the front");
      return require_rule(tried.count(expected) > 0, "gave up with an order left");
    }
    case Rescheduling::kRandom:
      if (next == nullptr) require_rule(tried.size() == factorial(order.size()), "gave up with orders left");
      return;
    default:
      return;
  }
}

void check_trace(const PlanCase& plan_case) {
  const PlanResult result = plan(plan_case.instance, plan_case.options);
  if (result.tries() > 1) fuzz::count(fuzz::Event::kRescheduled);
  std::set<PriorityOrder> tried;
  for (std::size_t i = 0; i < result.tries(); ++i) {
    const Try& pass = result.trace[i];
    const bool is_last = i + 1 == result.tries();
    require_rule(is_permutation_of(pass.order, plan_case.instance.agents.size()),
                 "an order with robots missing");
    require_rule(!pass.failed == (is_last && result.status == PlanStatus::kSolved),
                 "a success that is not the end");
    tried.insert(pass.order);
    if (!pass.failed || (is_last && result.status == PlanStatus::kLimit)) continue;
    check_step(plan_case.options.rescheduling, tried, pass.order, *pass.failed,
               is_last ? nullptr : &result.trace[i + 1].order);
  }
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
    check_step(plan_case.options.rescheduling, tried, order, failed, more ? &orders.current() : nullptr);
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
