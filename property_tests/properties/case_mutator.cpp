// Mutated cases: problems within the bounds, nearly always with something to decide, and the
// same ones for the same seed.
#include "property_tests/support/case_mutator.hpp"

#include <rapidcheck.h>

#include <cstdint>

#include "planner/io/case_codec.hpp"
#include "property_tests/support/generators.hpp"
#include "property_tests/support/property.hpp"

namespace sipplab::case_mutator_laws {
namespace {

/// Mutations of one another, as a fuzzer makes them.
constexpr int kGenerations = 20;

std::uint64_t any_seed() {
  return *rc::gen::noShrink(
      rc::gen::resize(rc::kNominalSize, rc::gen::inRange<std::uint64_t>(0, UINT32_MAX)));
}

void is_within_bounds(const PlanCase& plan_case) {
  RC_ASSERT(!find_error(plan_case.instance));
  RC_ASSERT(is_small_case(plan_case));
  RC_ASSERT(plan_case.options.max_expansions <= kMutatedExpansions);
  RC_ASSERT(plan_case.options.max_restarts <= kMutatedRestarts);
}

const PropertyRoom room("case_mutator", [] {
  bool passed = true;

  passed &= property("a mutated case keeps rules and bounds, and four in five have two robots", [] {
    Random random(any_seed());
    PlanCase plan_case = *any_case();
    int with_two = 0;
    for (int i = 0; i < kGenerations; ++i) {
      plan_case = mutate_case(plan_case, random);
      is_within_bounds(plan_case);
      with_two += plan_case.instance.agents.size() >= 2 ? 1 : 0;
    }
    RC_CLASSIFY(with_two * 5 >= kGenerations * 4, "four in five or more");
  });

  passed &= property("a case crossed with another keeps rules and bounds", [] {
    Random random(any_seed());
    const PlanCase one = mutate_case(*any_case(), random);
    const PlanCase other = mutate_case(*any_case(), random);
    is_within_bounds(cross_cases(one, other, random));
    is_within_bounds(cross_cases(*any_case(), other, random));
  });

  passed &= property("the same seed gives the same mutation", [] {
    const PlanCase plan_case = *any_case();
    const std::uint64_t seed = any_seed();
    Random first(seed);
    Random second(seed);
    RC_ASSERT(encode_case(mutate_case(plan_case, first)) == encode_case(mutate_case(plan_case, second)));
  });

  return passed;
});

}  // namespace
}  // namespace sipplab::case_mutator_laws
