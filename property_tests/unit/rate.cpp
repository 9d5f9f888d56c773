// Rates and how well they are known.
#include "property_tests/rates/rate.hpp"

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
