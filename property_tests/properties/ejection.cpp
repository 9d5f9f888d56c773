// Re-scheduling by ejection: its plans are right, its final order keeps the guarantee of
// start-safe intervals, and its trace tells what happened.
#include "planner/prioritized/ejection.hpp"

#include <rapidcheck.h>

#include <algorithm>
#include <deque>
#include <set>

#include "planner/solve/plan.hpp"
#include "property_tests/support/assert_valid.hpp"
#include "property_tests/support/generators.hpp"
#include "property_tests/support/property.hpp"

namespace sipplab {
namespace {

/// Enough for every case that can be solved; others end soon.
constexpr std::uint64_t kRestarts = 200;

PlanCase any_ejecting_case() {
  PlanCase plan_case = *any_case();
  plan_case.options.rescheduling = Rescheduling::kEjection;
  plan_case.options.max_restarts = std::min(plan_case.options.max_restarts, kRestarts);
  return plan_case;
}

std::size_t ejections(const PlanResult& result) {
  std::size_t count = 0;
  for (const Try& pass : result.trace) count += pass.ejected.size();
  return count;
}

PlanResult plan_case_of(const PlanCase& plan_case) {
  classify_case(plan_case);
  note_case(plan_case);
  PlanResult result = plan(plan_case.instance, plan_case.options);
  RC_CLASSIFY(result.status == PlanStatus::kSolved, "solved");
  RC_CLASSIFY(ejections(result) > 0, "somebody was ejected");
  RC_CLASSIFY(ejections(result) > 0 && result.status == PlanStatus::kSolved, "solved after ejections");
  return result;
}

void is_right(const PlanCase& plan_case, const PlanResult& result) {
  if (result.status != PlanStatus::kSolved) return;
  assert_valid(plan_case.instance, result.solution, {plan_case.options.ssi_s, result.order()});
}

/// The first order, as the other rules have it.
PriorityOrder first_order(PlanCase plan_case) {
  plan_case.options.rescheduling = Rescheduling::kNone;
  return plan(plan_case.instance, plan_case.options).trace.front().order;
}

/// Plays the trace: the next in the queue is planned or fails, and those that a
/// failed robot ejects were planned before and are next.
void tells_what_happened(const PlanCase& plan_case, const PlanResult& result) {
  const PriorityOrder first = first_order(plan_case);
  std::deque<AgentIndex> waiting(first.begin(), first.end());
  std::set<AgentIndex> planned;
  for (std::size_t i = 0; i < result.tries(); ++i) {
    const Try& pass = result.trace[i];
    const bool is_last = i + 1 == result.tries();
    RC_ASSERT(pass.order.empty() != is_last);
    RC_ASSERT(pass.failed.has_value() != (is_last && result.status == PlanStatus::kSolved));
    if (!pass.failed) break;
    while (!waiting.empty() && waiting.front() != *pass.failed) {
      planned.insert(waiting.front());
      waiting.pop_front();
    }
    RC_ASSERT(!waiting.empty());
    waiting.pop_front();
    for (auto robot = pass.ejected.rbegin(); robot != pass.ejected.rend(); ++robot) {
      RC_ASSERT(planned.erase(*robot) == 1u);
      waiting.push_front(*robot);
    }
    planned.insert(*pass.failed);
  }
  RC_ASSERT(result.order().size() == first.size());
  RC_ASSERT(std::is_permutation(first.begin(), first.end(), result.order().begin()));
}

}  // namespace
}  // namespace sipplab

int main() {
  using namespace sipplab;
  bool passed = true;

  passed &= property("every solution is valid and keeps its start-safe interval in the final order", [] {
    const PlanCase plan_case = any_ejecting_case();
    is_right(plan_case, plan_case_of(plan_case));
  });

  passed &= property("the same with start-safe intervals without end", [] {
    PlanCase plan_case = any_ejecting_case();
    plan_case.options.ssi_s = kInfiniteSsi;
    is_right(plan_case, plan_case_of(plan_case));
  });

  passed &= property("the trace tells who ejected whom, and the last try has the order", [] {
    const PlanCase plan_case = any_ejecting_case();
    RC_PRE(!plan_case.instance.agents.empty());
    tells_what_happened(plan_case, plan_case_of(plan_case));
  });

  passed &= property("the same case gives the same result, to the last bit and counter", [] {
    const PlanCase plan_case = any_ejecting_case();
    const PlanResult one = plan_case_of(plan_case);
    const PlanResult other = plan(plan_case.instance, plan_case.options);
    RC_ASSERT(one.status == other.status);
    RC_ASSERT(one.solution == other.solution);
    RC_ASSERT(one.order() == other.order());
    RC_ASSERT(one.tries() == other.tries());
    RC_ASSERT(one.statistics.expansions == other.statistics.expansions);
  });

  passed &= property("what is solved without re-scheduling is solved the same way", [] {
    PlanCase plan_case = any_ejecting_case();
    plan_case.options.rescheduling = Rescheduling::kNone;
    const PlanResult off = plan_case_of(plan_case);
    RC_PRE(off.status == PlanStatus::kSolved);
    plan_case.options.rescheduling = Rescheduling::kEjection;
    const PlanResult result = plan(plan_case.instance, plan_case.options);
    RC_ASSERT(result.tries() == 1u);
    RC_ASSERT(result.solution == off.solution);
    RC_ASSERT(result.order() == off.order());
  });

  passed &= property("budgets of restarts and expansions are kept, and end as limits", [] {
    PlanCase plan_case = any_ejecting_case();
    const PlanResult free = plan_case_of(plan_case);
    RC_PRE(free.tries() > 1u);
    plan_case.options.max_restarts = *rc::gen::inRange<std::uint64_t>(0, free.tries() - 1);
    const PlanResult few_tries = plan(plan_case.instance, plan_case.options);
    RC_ASSERT(few_tries.status == PlanStatus::kLimit);
    RC_ASSERT(few_tries.tries() == plan_case.options.max_restarts + 1);
    plan_case.options.max_restarts = kRestarts;
    plan_case.options.max_expansions = *rc::gen::inRange<std::uint64_t>(0, free.statistics.expansions);
    const PlanResult few_expansions = plan(plan_case.instance, plan_case.options);
    RC_ASSERT(few_expansions.status == PlanStatus::kLimit);
    RC_ASSERT(few_expansions.statistics.expansions <= plan_case.options.max_expansions);
  });

  return passed ? 0 : 1;
}
