// A target that is wrong on purpose: it claims that no case has two robots on a map with an
// obstacle. Tests of judging, reducing and recording need something to find.
#include "fuzz/support/case_input.hpp"
#include "fuzz/support/claims.hpp"
#include "fuzz/support/target.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const auto plan_case = sipplab::fuzz::read_case(data, size);
  if (!plan_case) return -1;
  sipplab::fuzz::require(sipplab::fuzz::Claim::kResultIsWhole,
                         plan_case->instance.agents.size() < 2 || plan_case->instance.obstacles.empty(),
                         "two robots and an obstacle");
  return 0;
}
