// Rules of priority orders; see order_rules.hpp.
#include "property_tests/support/order_rules.hpp"

#include <algorithm>
#include <numeric>

namespace sipplab {
namespace {

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

}  // namespace

bool is_permutation_of(PriorityOrder order, std::size_t agents) {
  std::sort(order.begin(), order.end());
  PriorityOrder expected(agents);
  std::iota(expected.begin(), expected.end(), AgentIndex{0});
  return order == expected;
}

std::string find_wrong_step(Rescheduling rescheduling, const std::set<PriorityOrder>& tried,
                            const PriorityOrder& order, AgentIndex failed, const PriorityOrder* next) {
  if (next != nullptr && !is_permutation_of(*next, order.size()))
    return "an order that is none of all robots";
  if (next != nullptr && tried.count(*next) > 0) return "an order is tried twice";
  if (rescheduling == Rescheduling::kNone) {
    return next == nullptr ? "" : "a second order without re-scheduling";
  }
  if (rescheduling == Rescheduling::kDeterministic) {
    const PriorityOrder expected = moved_to_front(order, failed);
    if (next != nullptr) return *next == expected ? "" : "not the failed robot to the front";
    return tried.count(expected) > 0 ? "" : "gave up with an order left";
  }
  const bool is_early = next == nullptr && tried.size() != factorial(order.size());
  return is_early ? "gave up with orders left" : "";
}

std::string find_wrong_try(const PlanCase& plan_case, const PlanResult& result) {
  if (result.tries() == 0) return "no try";
  std::set<PriorityOrder> tried;
  for (std::size_t i = 0; i < result.tries(); ++i) {
    const Try& pass = result.trace[i];
    const bool is_last = i + 1 == result.tries();
    if (!is_permutation_of(pass.order, plan_case.instance.agents.size()))
      return "an order with robots missing";
    if (!pass.failed != (is_last && result.status == PlanStatus::kSolved))
      return "a success that is not the end";
    tried.insert(pass.order);
    if (!pass.failed || (is_last && result.status == PlanStatus::kLimit)) continue;
    const PriorityOrder* const next = is_last ? nullptr : &result.trace[i + 1].order;
    std::string wrong =
        find_wrong_step(plan_case.options.rescheduling, tried, pass.order, *pass.failed, next);
    if (!wrong.empty()) return wrong;
  }
  return "";
}

}  // namespace sipplab
