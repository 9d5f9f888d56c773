// What dead processes print, as signatures: the same for the same bug, whatever the input.
#include "fuzz/replay/judge.hpp"

#include <gtest/gtest.h>
#include <unistd.h>

#include <cstdlib>
#include <string>

#include "fuzz/support/target.hpp"

/// Judged below: breaks in as many ways as there are first letters.
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  if (size > 0 && data[0] == 'a') std::abort();
  if (size > 0 && data[0] == 'x') _exit(5);
  return 0;
}

namespace sipplab::fuzz {
namespace {

TEST(Judge, runs_an_input_in_a_process_of_its_own) {
  EXPECT_FALSE(judge("fine").broken);
  EXPECT_FALSE(judge("").broken);
  EXPECT_EQ(judge("abort").kind, "crash");
  EXPECT_EQ(judge("x").claim, "exit code 5");
}

TEST(Judge, a_broken_claim_is_known_by_its_name) {
  const Judgement judgement = read_report("noise\nbroken claim: plan is valid: robots 0 and 1 overlap\n", "");
  EXPECT_EQ(judgement.signature(), "claim | plan is valid | ");
  EXPECT_EQ(judgement.message, "broken claim: plan is valid: robots 0 and 1 overlap");
}

TEST(Judge, a_broken_invariant_is_known_by_its_condition_and_not_by_its_line) {
  EXPECT_EQ(read_report("some/file.cpp:12: broken invariant: a < b\n", "").signature(),
            read_report("some/file.cpp:99: broken invariant: a < b\n", "").signature());
}

TEST(Judge, a_sanitizer_error_is_known_by_its_kind_and_innermost_functions_of_the_project) {
  const Judgement judgement = read_report(
      "==7==ERROR: AddressSanitizer: heap-buffer-overflow on address 0x602000000011 at pc 0x1\n"
      "READ of size 1 at 0x602000000011 thread T0\n"
      "    #0 0x55 in std::vector<int>::at(unsigned long) /usr/include/c++/12/bits/stl_vector.h:1\n"
      "    #1 0x56 in sipplab::(anonymous namespace)::fields_of(std::string_view) "
      "/src/planner/io/movingai.cpp:25:3\n"
      "    #2 0x57 in sipplab::parse_movingai_scen(std::string_view) /src/planner/io/movingai.cpp:150:3\n"
      "    #3 0x58 in LLVMFuzzerTestOneInput /src/fuzz/parse.cpp:9:3\n"
      "    #4 0x59 in run_child /src/fuzz/replay/judge.cpp:9:3\n"
      "\n"
      "allocated by thread T0 here:\n"
      "    #0 0x60 in sipplab::another(int) /src/planner/io/text.cpp:1:1\n",
      "");
  EXPECT_EQ(judgement.kind, "sanitizer");
  EXPECT_EQ(judgement.claim, "heap-buffer-overflow");
  EXPECT_EQ(judgement.frames, "fields_of < parse_movingai_scen < LLVMFuzzerTestOneInput");
}

TEST(Judge, numbers_in_undefined_behaviour_are_no_part_of_it) {
  const auto overflow = [](const char* numbers) {
    return read_report(std::string("a.cpp:3:5: runtime error: signed integer overflow: ") + numbers, "")
        .claim;
  };
  EXPECT_EQ(overflow("2147483647 + 1 cannot be represented in type 'int'"),
            overflow("2147483640 + 12 cannot be represented in type 'int'"));
}

TEST(Judge, what_is_not_known_is_called_after_the_way_it_ended) {
  EXPECT_EQ(read_report("nothing known", "signal Killed").signature(), "crash | signal Killed | ");
}

}  // namespace
}  // namespace sipplab::fuzz
