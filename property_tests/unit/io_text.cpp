// Numbers, tokens and lines in text.
#include "planner/io/text.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

namespace sipplab {
namespace {

TEST(IoText, IntegersAreWholeTokens) {
  EXPECT_EQ(parse_integer("42"), 42);
  EXPECT_EQ(parse_integer(" -7\t"), -7);
  for (const char* token : {"", " ", "4.0", "4x", "+4", "0x10", "1e3", "99999999999999999999", "4 2"}) {
    EXPECT_FALSE(parse_integer(token)) << token;
  }
}

TEST(IoText, RealsAreFiniteWholeTokens) {
  EXPECT_EQ(parse_real("2.5"), 2.5);
  EXPECT_EQ(parse_real(" -1e-3 "), -1e-3);
  for (const char* token : {"", "nan", "NaN", "inf", "-inf", "1e999", "2,5", "1.0f", "1 2", "--1"}) {
    EXPECT_FALSE(parse_real(token)) << token;
  }
}

TEST(IoText, RealsSurviveTheRoundTrip) {
  for (const double value :
       {0.0, 0.1, 1.0 / 3, std::sqrt(2.0), 1e-300, -123456.789, 0x1.fffffffffffffp+1023}) {
    EXPECT_EQ(parse_real(format_real(value)), value);
  }
  EXPECT_EQ(format_real(0.1), "0.1");
  EXPECT_EQ(format_real(3), "3");
}

TEST(IoText, QuotedTokensStayOnOneShortLine) {
  EXPECT_EQ(in_quotes("a\nb"), "'a?b'");
  EXPECT_EQ(in_quotes("\xff"), "'?'");
  const std::string long_token = std::string(39, 'x') + "\xc3\xa9" + std::string(100, 'y');
  EXPECT_EQ(in_quotes(long_token), "'" + std::string(39, 'x') + "...'");
}

TEST(IoText, KnowsUtf8) {
  EXPECT_TRUE(is_valid_utf8("plain, \xc3\xa9, \xe2\x82\xac, \xf0\x9f\x98\x80"));
  // Cut off, a stray continuation, too long a form, a surrogate, beyond the last character.
  for (const char* text :
       {"\xc3", "\x80", "\xc0\xaf", "\xed\xa0\x80", "\xf4\x90\x80\x80", "\xf8\x88\x80\x80\x80"}) {
    EXPECT_FALSE(is_valid_utf8(text));
  }
}

TEST(IoText, LinesAreCountedFromOne) {
  const LineTable table("ab\ncd\n\ne");
  EXPECT_EQ(table.line(0), 1);
  EXPECT_EQ(table.line(2), 1);
  EXPECT_EQ(table.line(3), 2);
  EXPECT_EQ(table.line(7), 4);

  LineScanner scanner("one\r\n\ntwo");
  EXPECT_EQ(scanner.next(), "one");
  EXPECT_EQ(scanner.next(), "");
  EXPECT_EQ(scanner.next(), "two");
  EXPECT_EQ(scanner.line(), 3);
  EXPECT_FALSE(scanner.next());
}

}  // namespace
}  // namespace sipplab
