// libFuzzer's custom mutator and cross-over for targets that read cases: they change the
// problem, not its bytes.
#include <algorithm>
#include <cstring>
#include <optional>
#include <string>

#include "fuzz/support/target.hpp"
#include "planner/core/random.hpp"
#include "planner/io/case_codec.hpp"
#include "property_tests/support/case_mutator.hpp"

namespace {

using namespace sipplab;

/// One mutation in this many changes bytes: the reader of cases is on trial too.
constexpr std::uint64_t kBytesOneIn = 64;

std::size_t put(const std::string& text, std::uint8_t* out, std::size_t max_size) {
  if (text.size() > max_size) return 0;
  std::memcpy(out, text.data(), text.size());
  return text.size();
}

}  // namespace

extern "C" std::size_t LLVMFuzzerCustomMutator(std::uint8_t* data, std::size_t size, std::size_t max_size,
                                               unsigned seed) {
  Random random(seed);
  if (size > 0 && random.below(kBytesOneIn) == 0) return LLVMFuzzerMutate(data, size, max_size);
  const auto plan_case = decode_case(fuzz::text_of(data, size));
  const std::size_t written =
      put(encode_case(mutate_case(plan_case.value_or(PlanCase{}), random)), data, max_size);
  return written > 0 ? written : size;
}

extern "C" std::size_t LLVMFuzzerCustomCrossOver(const std::uint8_t* one, std::size_t one_size,
                                                 const std::uint8_t* other, std::size_t other_size,
                                                 std::uint8_t* out, std::size_t max_size, unsigned seed) {
  Random random(seed);
  const auto first = decode_case(fuzz::text_of(one, one_size));
  const auto second = decode_case(fuzz::text_of(other, other_size));
  if (!first || !second) return 0;
  return put(encode_case(cross_cases(*first, *second, random)), out, max_size);
}
