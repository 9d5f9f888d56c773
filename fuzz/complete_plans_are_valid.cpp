// Claim: every plan of LaCAM passes the validator, with the start-safe intervals
// that it says it keeps; the same case gives the same plan; and small cases are solved exactly
// when moving one robot at a time, in every order, solves them.
#include "fuzz/support/case_input.hpp"
#include "fuzz/support/claims.hpp"
#include "fuzz/support/target.hpp"
#include "planner/complete/complete_planner.hpp"
#include "property_tests/support/pebble_search.hpp"
#include "sipplab/validator.hpp"

namespace {

using namespace sipplab;
using fuzz::Claim;
using fuzz::Event;

/// Steps: some milliseconds. A mutated case may be a puzzle that takes hours.
constexpr std::uint64_t kMostSteps = 3'000;

CompleteResult planned(const PlanCase& plan_case) {
  PlannerOptions options = plan_case.options;
  options.max_expansions = kMostSteps;
  return plan_complete(plan_case.instance, options);
}

void check_plan(const Instance& instance, const CompleteResult& result) {
  ValidationOptions options;
  options.ssi_s = result.ssi_kept_s;
  options.order = result.order;
  const ValidationReport report = validate(instance, result.solution, options);
  fuzz::require(Claim::kPlanIsValid, report.valid(),
                report.valid() ? std::string() : report.violations.front().message);
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const auto drawn = fuzz::read_case(data, size);
  if (!drawn) return -1;
  const PlanCase plan_case = within_complete_model(*drawn);
  fuzz::require(Claim::kCompleteIsComplete, !find_beyond_complete(plan_case.instance),
                "refuses a case of its model");
  const CompleteResult result = planned(plan_case);
  const bool solved = result.status == LacamStatus::kSolved;
  fuzz::count(solved                                      ? Event::kSolved
              : result.status == LacamStatus::kUnsolvable ? Event::kFailed
                                                          : Event::kLimited);
  if (solved) check_plan(plan_case.instance, result);

  const CompleteResult again = planned(plan_case);
  fuzz::require(Claim::kSameInputSamePlan,
                again.status == result.status && again.solution == result.solution &&
                    again.order == result.order && again.steps_tried == result.steps_tried,
                "LaCAM, asked again");

  if (result.status != LacamStatus::kLimit && pebble_search_is_small(plan_case.instance)) {
    fuzz::require(Claim::kCompleteIsComplete, solved == is_solvable_by_pebbles(plan_case.instance),
                  "not what moving one at a time solves");
  }
  return 0;
}
