// Rates and how well they are known.
#include "property_tests/support/rate.hpp"

#include <gtest/gtest.h>

namespace sipplab {
namespace {

TEST(Rate, CountsAddUp) {
  Rate rate{"it holds", 0, 0, 0};
  EXPECT_FALSE(rate.value());
  for (const std::optional<bool> outcome : {std::optional<bool>(true), std::optional<bool>(true),
                                            std::optional<bool>(false), std::optional<bool>()}) {
    rate.count(outcome);
  }
  EXPECT_EQ(rate.held, 2);
  EXPECT_EQ(rate.broken, 1);
  EXPECT_EQ(rate.not_applicable, 1);
  EXPECT_EQ(rate.applicable(), 3);
  EXPECT_EQ(rate.cases(), 4);
  EXPECT_DOUBLE_EQ(rate.value().value_or(-1), 2.0 / 3);
}

TEST(Rate, IntervalsAreThoseOfTheLiterature) {
  // Newcombe (1998), "Two-sided confidence intervals for the single proportion", table I, method 3.
  struct Known {
    std::int64_t held, of;
    double low, high;
  };
  for (const Known& known : {Known{81, 263, 0.2553, 0.3662}, Known{15, 148, 0.0624, 0.1605},
                             Known{0, 20, 0.0000, 0.1611}, Known{1, 29, 0.0061, 0.1718}}) {
    const ConfidenceInterval interval =
        wilson_interval(static_cast<double>(known.held), static_cast<double>(known.of));
    EXPECT_NEAR(interval.low, known.low, 5e-5) << known.held;
    EXPECT_NEAR(interval.high, known.high, 5e-5) << known.held;
  }
}

TEST(Rate, IntervalsReachTheEndsExactly) {
  EXPECT_EQ(wilson_interval(0, 7).low, 0);
  EXPECT_EQ(wilson_interval(7, 7).high, 1);
  EXPECT_EQ(wilson_interval(0, 0).low, 0);
  EXPECT_EQ(wilson_interval(0, 0).high, 1);
}

TEST(Rate, ARowNamesItsNumbers) {
  const std::string row = rate_table_row({"it holds", 1, 28, 5});
  EXPECT_NE(row.find("it holds"), std::string::npos);
  EXPECT_NE(row.find("29"), std::string::npos);
  EXPECT_NE(row.find("0.0345"), std::string::npos);
  EXPECT_NE(row.find("0.0061 to 0.1718"), std::string::npos);
  EXPECT_NE(rate_table_row({"never", 0, 0, 3}).find("-"), std::string::npos);
}

}  // namespace
}  // namespace sipplab
