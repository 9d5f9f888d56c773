// The cases themselves: what generators draw is a problem, what shrinking offers is
// one and simpler, and text keeps all of it.
#include <rapidcheck.h>

#include <cstddef>
#include <string>

#include "planner/io/case_codec.hpp"
#include "property_tests/support/case_shrinker.hpp"
#include "property_tests/support/generators.hpp"
#include "property_tests/support/property.hpp"

namespace sipplab::cases_laws {
namespace {

bool same(const PlannerOptions& a, const PlannerOptions& b) {
  return a.order == b.order && a.rescheduling == b.rescheduling && a.ssi_s == b.ssi_s &&
         a.any_angle == b.any_angle && a.connectedness == b.connectedness && a.weight == b.weight &&
         a.seed == b.seed && a.time_limit_s == b.time_limit_s && a.max_expansions == b.max_expansions &&
         a.max_restarts == b.max_restarts && a.rules == b.rules;
}

const PropertyRoom room("cases", [] {
  bool passed = true;

  passed &= property("every case keeps the rules of an instance", [] {
    const PlanCase plan_case = *any_case();
    classify_case(plan_case);
    RC_ASSERT(!find_error(plan_case.instance));
  });

  passed &= property("text keeps the whole case", [] {
    const PlanCase plan_case = *rc::gen::oneOf(any_case(), any_turning_case());
    const auto decoded = decode_case(encode_case(plan_case));
    RC_ASSERT(decoded.has_value());
    RC_ASSERT(decoded->instance == plan_case.instance);
    RC_ASSERT(same(decoded->options, plan_case.options));
    RC_ASSERT(encode_case(*decoded) == encode_case(plan_case));
  });

  passed &= property("any text is decoded or refused", [] {
    std::string text = encode_case(*any_case());
    const int edits = *rc::gen::inRange(0, 6);
    for (int i = 0; i < edits; ++i) {
      text[*rc::gen::inRange<std::size_t>(0, text.size())] =
          *rc::gen::element('.', '@', '\n', ' ', '9', '-', 'e', '#');
    }
    const auto decoded = decode_case(text);
    if (decoded) RC_ASSERT(decode_case(encode_case(*decoded)).has_value());
    RC_CLASSIFY(decoded.has_value(), "decoded");
  });

  passed &= property("simpler cases keep the rules, and simplifying comes to an end", [] {
    PlanCase plan_case = *rc::gen::oneOf(any_case(), any_turning_case());
    // Always the last offer: the least step, so the longest path.
    int steps = 0;
    for (auto simpler = simpler_cases(plan_case); !simpler.empty(); simpler = simpler_cases(plan_case)) {
      for (const PlanCase& offer : simpler) RC_ASSERT(!find_error(offer.instance));
      plan_case = simpler.back();
      RC_ASSERT(++steps < 2000);
    }
    RC_ASSERT(plan_case.instance.agents.empty());
    RC_ASSERT(plan_case.instance.map.cell_count() == 1u);
  });

  return passed;
});

}  // namespace
}  // namespace sipplab::cases_laws
