// Orders and what follows from them: the same input gives the same plan, the final
// order alone explains it, and each next order follows from the failure before.
// [AY18], section 4.
#include <rapidcheck.h>

#include <algorithm>
#include <numeric>
#include <set>

#include "planner/solve/plan.hpp"
#include "property_tests/support/generators.hpp"
#include "property_tests/support/property.hpp"

namespace sipplab {
namespace {

bool same(const PlanResult& a, const PlanResult& b) {
  if (a.status != b.status || a.solution != b.solution || a.tries() != b.tries()) return false;
  if (a.statistics.expansions != b.statistics.expansions) return false;
  if (a.statistics.generations != b.statistics.generations) return false;
  return std::equal(a.trace.begin(), a.trace.end(), b.trace.begin(), [](const Try& one, const Try& other) {
    return one.order == other.order && one.failed == other.failed;
  });
}

PlanResult plan_case_of(const PlanCase& plan_case) {
  classify_case(plan_case);
  note_case(plan_case);
  PlanResult result = plan(plan_case.instance, plan_case.options);
  RC_CLASSIFY(result.status == PlanStatus::kSolved, "solved");
  RC_CLASSIFY(result.tries() > 1, "several tries");
  return result;
}

PlanCase any_case_with(Rescheduling rescheduling) {
  PlanCase plan_case = *any_case();
  plan_case.options.rescheduling = rescheduling;
  return plan_case;
}

PriorityOrder moved_to_front(PriorityOrder order, AgentIndex agent) {
  const auto position = std::find(order.begin(), order.end(), agent);
  std::rotate(order.begin(), position, position + 1);
  return order;
}

void is_a_permutation(PriorityOrder order, std::size_t agents) {
  std::sort(order.begin(), order.end());
  PriorityOrder expected(agents);
  std::iota(expected.begin(), expected.end(), AgentIndex{0});
  RC_ASSERT(order == expected);
}

bool no_order_twice(const PlanResult& result) {
  std::set<PriorityOrder> orders;
  for (const Try& pass : result.trace) orders.insert(pass.order);
  return orders.size() == result.trace.size();
}

}  // namespace
}  // namespace sipplab

int main() {
  using namespace sipplab;
  bool passed = true;

  passed &= property("the same case gives the same result, to the last bit and counter", [] {
    const PlanCase plan_case = *any_case();
    RC_ASSERT(same(plan_case_of(plan_case), plan(plan_case.instance, plan_case.options)));
  });

  passed &= property("every try is an order of all agents; only the last one can succeed", [] {
    const PlanCase plan_case = *any_case();
    const PlanResult result = plan_case_of(plan_case);
    RC_ASSERT(result.tries() >= 1u);
    for (std::size_t i = 0; i < result.tries(); ++i) {
      is_a_permutation(result.trace[i].order, plan_case.instance.agents.size());
      const bool succeeded = !result.trace[i].failed;
      RC_ASSERT(succeeded == (i + 1 == result.tries() && result.status == PlanStatus::kSolved));
    }
  });

  passed &= property("the final order without re-scheduling gives the same trajectories", [] {
    const PlanCase plan_case = *any_case();
    const PlanResult result = plan_case_of(plan_case);
    RC_PRE(result.status == PlanStatus::kSolved);
    Instance sorted = plan_case.instance;
    for (std::size_t i = 0; i < result.order().size(); ++i) {
      sorted.agents[i] = plan_case.instance.agents[result.order()[i]];
    }
    PlannerOptions options = plan_case.options;
    options.order = InitialOrder::kFifo;
    options.rescheduling = Rescheduling::kNone;
    const PlanResult replayed = plan(sorted, options);
    RC_ASSERT(replayed.status == PlanStatus::kSolved);
    RC_ASSERT(replayed.tries() == 1u);
    for (std::size_t i = 0; i < result.order().size(); ++i) {
      RC_ASSERT(replayed.solution.trajectories[i] == result.solution.trajectories[result.order()[i]]);
    }
  });

  passed &= property("none: one try",
                     [] { RC_ASSERT(plan_case_of(any_case_with(Rescheduling::kNone)).tries() == 1u); });

  passed &= property("deterministic: the failed robot goes to the front, until an order repeats", [] {
    const PlanCase plan_case = any_case_with(Rescheduling::kDeterministic);
    const PlanResult result = plan_case_of(plan_case);
    for (std::size_t i = 1; i < result.tries(); ++i) {
      const Try& before = result.trace[i - 1];
      RC_ASSERT(before.failed.has_value());
      RC_ASSERT(result.trace[i].order == moved_to_front(before.order, *before.failed));
    }
    RC_ASSERT(no_order_twice(result));
    if (result.status != PlanStatus::kFailed) return;
    const PriorityOrder next = moved_to_front(result.order(), *result.trace.back().failed);
    RC_ASSERT(std::any_of(result.trace.begin(), result.trace.end(),
                          [&](const Try& pass) { return pass.order == next; }));
  });

  passed &= property("random: no order is tried twice; it gives up when all were", [] {
    const PlanCase plan_case = any_case_with(Rescheduling::kRandom);
    const PlanResult result = plan_case_of(plan_case);
    RC_ASSERT(no_order_twice(result));
    if (result.status != PlanStatus::kFailed) return;
    std::size_t orders = 1;
    for (std::size_t i = 2; i <= plan_case.instance.agents.size(); ++i) orders *= i;
    RC_ASSERT(result.tries() == orders);
  });

  passed &= property("re-scheduling solves in one try whatever is solved without", [] {
    PlanCase plan_case = any_case_with(Rescheduling::kNone);
    const PlanResult off = plan_case_of(plan_case);
    RC_PRE(off.status == PlanStatus::kSolved);
    for (const Rescheduling rescheduling : {Rescheduling::kDeterministic, Rescheduling::kRandom}) {
      plan_case.options.rescheduling = rescheduling;
      note_case(plan_case);
      RC_ASSERT(same(plan(plan_case.instance, plan_case.options), off));
    }
  });

  passed &= property("fifo: the last robot's goal is nothing to the others", [] {
    PlanCase plan_case = any_case_with(Rescheduling::kNone);
    RC_PRE(!plan_case.instance.agents.empty());
    plan_case.options.order = InitialOrder::kFifo;
    const PlanResult before = plan_case_of(plan_case);
    RC_PRE(before.status == PlanStatus::kSolved);
    Agent& last = plan_case.instance.agents.back();
    last.goal = last.start;
    RC_PRE(!find_error(plan_case.instance));
    note_case(plan_case);
    const PlanResult after = plan(plan_case.instance, plan_case.options);
    RC_PRE(after.status == PlanStatus::kSolved);
    for (AgentIndex i = 0; i + 1 < plan_case.instance.agents.size(); ++i) {
      RC_ASSERT(after.solution.trajectories[i] == before.solution.trajectories[i]);
    }
  });

  passed &= property("a budget of expansions is kept, and ends as a limit", [] {
    PlanCase plan_case = *any_case();
    const PlanResult free = plan_case_of(plan_case);
    RC_PRE(free.statistics.expansions > 0u);
    plan_case.options.max_expansions = *rc::gen::inRange<std::uint64_t>(0, free.statistics.expansions);
    note_case(plan_case);
    const PlanResult limited = plan(plan_case.instance, plan_case.options);
    RC_ASSERT(limited.status == PlanStatus::kLimit);
    RC_ASSERT(limited.statistics.expansions <= plan_case.options.max_expansions);
  });

  passed &= property("a time limit that is over at once ends as a limit, if there is anything to plan", [] {
    PlanCase plan_case = *any_case();
    const PlanResult free = plan_case_of(plan_case);
    plan_case.options.time_limit_s = 0;
    note_case(plan_case);
    const PlanResult limited = plan(plan_case.instance, plan_case.options);
    if (free.statistics.expansions == 0) return;
    RC_ASSERT(limited.status != PlanStatus::kSolved);
    RC_ASSERT(limited.status == PlanStatus::kLimit || free.status == PlanStatus::kFailed);
    RC_ASSERT(limited.statistics.expansions <= free.statistics.expansions);
  });

  passed &= property("a budget of restarts is kept", [] {
    PlanCase plan_case = *any_case();
    const PlanResult free = plan_case_of(plan_case);
    RC_PRE(free.tries() > 1u);
    plan_case.options.max_restarts = *rc::gen::inRange<std::uint64_t>(0, free.tries() - 1);
    note_case(plan_case);
    const PlanResult limited = plan(plan_case.instance, plan_case.options);
    RC_ASSERT(limited.status == PlanStatus::kLimit);
    RC_ASSERT(limited.tries() == plan_case.options.max_restarts + 1);
  });

  return passed ? 0 : 1;
}
