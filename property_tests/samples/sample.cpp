// Properties of which three end badly, on purpose: they show that a record is kept of
// every way in which a property can end. Not run as a test by itself.
#include <rapidcheck.h>

#include "planner/solve/plan.hpp"
#include "property_tests/support/generators.hpp"
#include "property_tests/support/property.hpp"

namespace sipplab::sample_laws {
namespace {

/// A wish, not a law: with it, plans of two robots are counterexamples.
bool one_robot_at_most(const PlanCase& plan_case) {
  const PlanResult result = plan(plan_case.instance, plan_case.options);
  return result.status != PlanStatus::kSolved || plan_case.instance.agents.size() < 2;
}

const PropertyRoom room("sample", 1000, [] {
  bool passed = true;

  passed &= property("every number is odd or even", [] {
    const int number = *rc::gen::inRange(0, 1000);
    RC_CLASSIFY(number % 2 == 0, "even");
    RC_ASSERT((number % 2 == 0) != (number % 2 == 1));
  });

  passed &= property("a plan has one robot", [] {
    const PlanCase plan_case = *any_case();
    classify_case(plan_case);
    RC_ASSERT(one_robot_at_most(plan_case));
  });

  passed &= property("a plan in 8 neighbours has one robot", [] {
    PlanCase plan_case = *any_case();
    plan_case.options.connectedness = 3;
    note_case(plan_case);
    RC_ASSERT(one_robot_at_most(plan_case));
  });

  passed &= property("no number is larger than 9", [] { RC_ASSERT(*rc::gen::inRange(0, 1000) <= 9); });

  passed &= property("numbers that do not exist are small", [] { RC_PRE(*rc::gen::inRange(0, 2) > 2); });

  return passed;
});

}  // namespace
}  // namespace sipplab::sample_laws
