// Orders and what follows from them: the same input gives the same plan, the final
// order alone explains it, and each next order follows from the failure before.
// [AY18], section 4.
#include <rapidcheck.h>

#include <algorithm>

#include "planner/solve/plan.hpp"
#include "property_tests/support/generators.hpp"
#include "property_tests/support/order_rules.hpp"
#include "property_tests/support/property.hpp"

namespace sipplab::rescheduling_laws {
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

void follows_the_rules_of(Rescheduling rescheduling) {
  const PlanCase plan_case = any_case_with(rescheduling);
  RC_ASSERT(find_wrong_try(plan_case, plan_case_of(plan_case)) == "");
}

const PropertyRoom room("rescheduling", [] {
  bool passed = true;

  passed &= property("the same case gives the same result, to the last bit and counter", [] {
    const PlanCase plan_case = *any_case();
    RC_ASSERT(same(plan_case_of(plan_case), plan(plan_case.instance, plan_case.options)));
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

  passed &= property("none: one try", [] { follows_the_rules_of(Rescheduling::kNone); });

  passed &= property("deterministic: the failed robot goes to the front, until an order repeats",
                     [] { follows_the_rules_of(Rescheduling::kDeterministic); });

  passed &= property("random: no order is tried twice; it gives up when all were",
                     [] { follows_the_rules_of(Rescheduling::kRandom); });

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

  return passed;
});

}  // namespace
}  // namespace sipplab::rescheduling_laws
