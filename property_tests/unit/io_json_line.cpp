// On which line of a JSON text a value stands.
#include <gtest/gtest.h>

#include "planner/io/json_line.hpp"

namespace sipplab {
namespace {

constexpr std::string_view kText =
    "{\n"
    "  \"a\": 1,\n"
    "  \"ab\": [\n"
    "    12\n"
    "    ,\n"
    "    {\"c\": true, \"d\":\n"
    "      null},\n"
    "    [[], \"x\"]\n"
    "  ],\n"
    "  \"e\": {\"c\": {}}, \"f\":\n"
    "    -2.5\n"
    "}\n";

TEST(IoJsonLine, IsThatOnWhichTheValueBegins) {
  EXPECT_EQ(json_line(kText, "a"), 2);
  EXPECT_EQ(json_line(kText, "ab"), 3);
  EXPECT_EQ(json_line(kText, "ab[0]"), 4);
  EXPECT_EQ(json_line(kText, "ab[1]"), 6);
  EXPECT_EQ(json_line(kText, "ab[1].c"), 6);
  EXPECT_EQ(json_line(kText, "ab[1].d"), 7);
  EXPECT_EQ(json_line(kText, "ab[2]"), 8);
  EXPECT_EQ(json_line(kText, "ab[2][1]"), 8);
  EXPECT_EQ(json_line(kText, "e.c"), 10);
  EXPECT_EQ(json_line(kText, "f"), 11);
  EXPECT_EQ(json_line("12\n", ""), 1);
}

TEST(IoJsonLine, OfWhatIsMissingIsThatOfWhatShouldHoldIt) {
  EXPECT_EQ(json_line(kText, "g"), 1);
  EXPECT_EQ(json_line(kText, "abc[3]"), 1);
  EXPECT_EQ(json_line(kText, "ab[3]"), 3);
  EXPECT_EQ(json_line(kText, "ab[1].x"), 6);
  EXPECT_EQ(json_line(kText, "ab[1].d.e[0]"), 7);
  EXPECT_EQ(json_line(kText, "ab[2][4]"), 8);
  EXPECT_EQ(json_line("\n\n[]", "trajectories"), 3);
}

TEST(IoJsonLine, OfAKeyThatRepeatsIsThatOfTheLast) { EXPECT_EQ(json_line("{\"a\": 1,\n\"a\": 2}", "a"), 2); }

}  // namespace
}  // namespace sipplab
