// Reducing: cases stay cases, other texts lose what does not matter, and nothing is taken
// that does not break.
#include "property_tests/support/text_reducer.hpp"

#include <gtest/gtest.h>

#include <algorithm>

#include "planner/io/case_codec.hpp"
#include "property_tests/support/case_maker.hpp"

namespace sipplab {
namespace {

constexpr std::size_t kManyTries = 20000;

TEST(TextReducer, keeps_of_a_case_what_breaks) {
  const std::string text = encode_case(make_case(CaseFamily::kDense, 60, 5));
  ASSERT_GE(decode_case(text)->instance.agents.size(), 4U);
  const auto three_robots = [](const std::string& smaller) {
    const auto plan_case = decode_case(smaller);
    return plan_case && plan_case->instance.agents.size() >= 3;
  };
  const Reduction reduction = reduce_text(text, three_robots, kManyTries);
  const auto minimal = decode_case(reduction.text);
  ASSERT_TRUE(minimal);
  EXPECT_FALSE(find_error(minimal->instance));
  EXPECT_EQ(minimal->instance.agents.size(), 3U);
  EXPECT_LE(minimal->instance.map.cell_count(), 4U);
  EXPECT_GT(reduction.steps, 0U);
}

TEST(TextReducer, leaves_out_lines_and_bytes_that_do_not_matter) {
  const std::string text = "first line\nsecond, with the Needle in it\nthird\n";
  const auto has_needle = [](const std::string& smaller) {
    return smaller.find("Needle") != std::string::npos;
  };
  EXPECT_EQ(reduce_text(text, has_needle, kManyTries).text, "Needle");
}

TEST(TextReducer, puts_plain_bytes_where_any_would_do) {
  const auto is_long = [](const std::string& smaller) { return smaller.size() >= 3; };
  EXPECT_EQ(reduce_text("\xff\x01z?", is_long, kManyTries).text, "000");
}

TEST(TextReducer, ends_after_so_many_questions_with_what_breaks) {
  std::size_t asked = 0;
  const auto breaks = [&](const std::string& smaller) {
    ++asked;
    return std::count(smaller.begin(), smaller.end(), 'x') >= 40;
  };
  const Reduction reduction = reduce_text(std::string(100, 'x'), breaks, 10);
  EXPECT_LE(asked, 10U);
  EXPECT_EQ(reduction.tries, asked);
  EXPECT_TRUE(breaks(reduction.text));
}

TEST(TextReducer, keeps_a_text_from_which_nothing_can_go) {
  const auto never = [](const std::string&) { return false; };
  EXPECT_EQ(reduce_text("as it is", never, kManyTries).text, "as it is");
  EXPECT_EQ(reduce_text("", never, kManyTries).text, "");
}

}  // namespace
}  // namespace sipplab
