// Looks for small cases that are hard: the counters below make the engine keep every input
// that needs more expansions per robot, or more restarts, than any before it. Claim: budgets
// are kept however hard it gets. What it finds feeds the suite `adversarial` (bench/).
#include <algorithm>
#include <bit>
#include <cstdint>

#include "fuzz/support/case_input.hpp"
#include "fuzz/support/claims.hpp"
#include "fuzz/support/target.hpp"
#include "planner/solve/plan.hpp"

namespace {

using namespace sipplab;

/// Steps of a climb: four to each doubling, so that a gain of a fifth is seen.
constexpr std::size_t kStepsPerDoubling = 4;
constexpr std::size_t kSteps = 64;
/// Expansions and tries of one case: what a hundred cases a second may cost.
constexpr std::uint64_t kClimbExpansions = 20000;
constexpr std::uint64_t kClimbRestarts = 100;

#if defined(__clang__) && defined(__linux__)
#define SIPPLAB_EXTRA_COUNTERS __attribute__((section("__libfuzzer_extra_counters"), used))
#else
#define SIPPLAB_EXTRA_COUNTERS
#endif
/// libFuzzer takes a byte here that becomes other than 0 for news, as it takes a new edge.
SIPPLAB_EXTRA_COUNTERS std::uint8_t climbed[2 * kSteps];

/// 0 for 0, then quarters of doublings.
std::size_t step_of(std::uint64_t amount) {
  if (amount == 0) return 0;
  const auto doublings = static_cast<std::size_t>(std::bit_width(amount) - 1);
  const std::uint64_t quarters = ((amount * kStepsPerDoubling) >> doublings) - kStepsPerDoubling;
  return std::min(kSteps - 1, 1 + doublings * kStepsPerDoubling + static_cast<std::size_t>(quarters));
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  std::fill(std::begin(climbed), std::end(climbed), std::uint8_t{0});
  auto plan_case = fuzz::read_case(data, size);
  if (!plan_case || plan_case->instance.agents.empty()) return -1;
  PlannerOptions& options = plan_case->options;
  options.max_expansions = kClimbExpansions;
  options.max_restarts = kClimbRestarts;
  const PlanResult result = plan(plan_case->instance, options);
  fuzz::require(fuzz::Claim::kBudgetIsKept,
                result.statistics.expansions <= kClimbExpansions && result.tries() <= kClimbRestarts + 1,
                "more expansions or restarts than allowed");
  if (result.tries() > 1) fuzz::count(fuzz::Event::kRescheduled);
  climbed[step_of(result.statistics.expansions / plan_case->instance.agents.size())] = 1;
  climbed[kSteps + step_of(result.tries() - 1)] = 1;
  return 0;
}
