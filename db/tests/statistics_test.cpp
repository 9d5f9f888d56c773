// Statistics against tables that can be checked with pencil and paper.
#include "db/statistics/statistics.hpp"

#include <sqlite3.h>

#include <cmath>
#include <utility>

#include "db/queries.hpp"
#include "db/tests/support.hpp"

namespace sipplab::db::statistics {
namespace {

/// Sums of a few hundred terms lose some units in the last place.
constexpr double kRelativeError = 1e-12;

void expect_p(std::optional<double> p, double expected) {
  ASSERT_TRUE(p);
  EXPECT_NEAR(*p, expected, expected * kRelativeError);
}

TEST(Statistics, quantiles) {
  EXPECT_FALSE(median({}));
  EXPECT_EQ(median({7}), 7);
  EXPECT_EQ(median({3, 1, 2}), 2);
  EXPECT_EQ(median({4, 1, 3, 2}), 2.5);
  EXPECT_EQ(median({2, 1, test::kInfinity}), 2);
  EXPECT_EQ(median({1, test::kInfinity, test::kInfinity, test::kInfinity}), test::kInfinity);
  EXPECT_EQ(quantile({1, 2, 3, 4, 5}, 0), 1);
  EXPECT_EQ(quantile({1, 2, 3, 4, 5}, 1), 5);
  EXPECT_EQ(quantile({5, 4, 3, 2, 1}, 0.25), 2);
  EXPECT_DOUBLE_EQ(*quantile({10, 20, 30, 40}, 0.9), 37);
}

TEST(Statistics, geometric_mean) {
  expect_p(geometric_mean({1, 2, 4}), 2);
  expect_p(geometric_mean({1e-300, 1e300}), 1);
  EXPECT_FALSE(geometric_mean({}));
  EXPECT_FALSE(geometric_mean({1, 0}));
  EXPECT_FALSE(geometric_mean({1, -2}));
}

TEST(Statistics, wilson_intervals_are_those_of_the_literature) {
  // Newcombe (1998), "Two-sided confidence intervals for the single proportion", table I, method 3.
  struct Known {
    double held, of, low, high;
  };
  for (const Known& known : {Known{81, 263, 0.2553, 0.3662}, Known{15, 148, 0.0624, 0.1605},
                             Known{0, 20, 0.0000, 0.1611}, Known{1, 29, 0.0061, 0.1718}}) {
    const ConfidenceInterval interval = wilson_interval(known.held, known.of);
    EXPECT_NEAR(interval.low, known.low, 5e-5) << known.held;
    EXPECT_NEAR(interval.high, known.high, 5e-5) << known.held;
  }
}

TEST(Statistics, wilson_intervals_reach_the_ends_exactly) {
  EXPECT_EQ(wilson_interval(0, 7).low, 0);
  EXPECT_EQ(wilson_interval(7, 7).high, 1);
  EXPECT_EQ(wilson_interval(0, 0).low, 0);
  EXPECT_EQ(wilson_interval(0, 0).high, 1);
}

TEST(Statistics, sign_test) {
  EXPECT_FALSE(sign_test(0, 0));
  EXPECT_EQ(sign_test(1, 0), 1);
  EXPECT_EQ(sign_test(4, 4), 1);
  expect_p(sign_test(5, 0), 2.0 / 32);
  // (1 + 10 + 45) of 1024 patterns, and as many on the other side.
  expect_p(sign_test(8, 2), 112.0 / 1024);
  EXPECT_EQ(sign_test(2, 8), sign_test(8, 2));
  // 11 pairs, 5 against 6: everything is at least as uneven.
  expect_p(sign_test(5, 6), 1);
  // Sums of exact integers, worked out elsewhere: counted up to 1000 pairs, beyond by
  // logarithms, which cost some digits.
  expect_p(sign_test(450, 550), 0.0017305360849763176);
  EXPECT_NEAR(*sign_test(450, 551), 0.001561138839699202, 1e-12);
  EXPECT_NEAR(*sign_test(3000, 2000), 1.3002310005203771e-45, 1e-54);
  EXPECT_EQ(sign_test(2000, 0), 0.0);
}

TEST(Statistics, mcnemar) {
  EXPECT_EQ(mcnemar(0, 0), 1);
  // C(22, 0) + ... + C(22, 6) = 110056 of 2^22.
  expect_p(mcnemar(6, 16), 2 * 110056.0 / 4194304);
  EXPECT_EQ(mcnemar(16, 6), mcnemar(6, 16));
}

TEST(Statistics, wilcoxon_exact) {
  EXPECT_FALSE(wilcoxon({}));
  EXPECT_FALSE(wilcoxon({0, 0}));
  expect_p(wilcoxon({1, 2, 3, 4, 5}), 2.0 / 32);
  expect_p(wilcoxon({-1, -2, -3, -4, -5, 0}), 2.0 / 32);
  // Ten pairs, the negative ranks 3 and 5: of the 1024 subsets of 1..10, those with sums
  // 0 to 8 number 1 + 1 + 1 + 2 + 2 + 3 + 4 + 5 + 6 = 25.
  expect_p(wilcoxon({1, 2, -3, 4, -5, 6, 7, 8, 9, 10}), 50.0 / 1024);
  // Ranks 1.5, 1.5, 3 with the sum 1.5 against: two of eight patterns have 1.5, one 0.
  expect_p(wilcoxon({1, -1, 2}), 6.0 / 8);
  EXPECT_EQ(wilcoxon({1, -1}), 1);
}

TEST(Statistics, wilcoxon_is_continuous_where_the_approximation_begins) {
  std::vector<double> differences;
  for (std::size_t i = 1; i <= kExactWilcoxonLimit; ++i) {
    differences.push_back((i % 3 == 0 ? -1.0 : 1.0) * static_cast<double>(i));
  }
  const double exact = *wilcoxon(differences);
  differences.push_back(0.5);
  differences.push_back(-0.25);
  EXPECT_NEAR(*wilcoxon(differences), exact, exact / 5);
  EXPECT_LT(exact, 0.01);
  EXPECT_GT(exact, 0.0001);
}

TEST(Statistics, par2) {
  EXPECT_FALSE(par2({}));
  EXPECT_EQ(par2({{true, 1, 10}, {false, 10, 10}, {false, 3, 10}}), (1 + 20 + 20) / 3.0);
}

class SqlStatistics : public test::DatabaseTest {
 protected:
  SqlStatistics() { test::must(Database::open(file)); }
  Value ask(const std::string& sql) { return test::must(run_sql(file, sql)).rows.at(0).at(0); }
};

TEST_F(SqlStatistics, are_the_same_functions) {
  const std::string values = " FROM (SELECT column1 AS x FROM (VALUES (4), (1.0), (NULL), (2)))";
  EXPECT_EQ(ask("SELECT median(x)" + values), Value{2.0});
  EXPECT_EQ(ask("SELECT quantile(x, 0.25)" + values), Value{1.5});
  EXPECT_NEAR(std::get<double>(ask("SELECT geomean(x)" + values)), 2, 1e-12);
  EXPECT_EQ(ask("SELECT sign_test(x)" + values), Value{0.25});
  EXPECT_EQ(ask("SELECT wilcoxon(x)" + values), Value{0.25});
  EXPECT_EQ(ask("SELECT mcnemar(column1, column2) FROM (VALUES (1, 0), (1, 0), (1, 1), (0, 0), (NULL, 1))"),
            Value{0.5});
  EXPECT_EQ(ask("SELECT par2(column1, column2, 10) FROM (VALUES (1, 2.0), (0, 3.0))"), Value{11.0});
  EXPECT_EQ(ask("SELECT round(wilson_low(column1), 4) || ' ' || round(wilson_high(column1), 4) FROM (VALUES "
                "(1), (1), (0), (1))"),
            Value{std::string("0.3006 0.9544")});
  EXPECT_EQ(
      ask("SELECT group_concat(m) FROM (SELECT median(column2) AS m FROM (VALUES (1, 1), (1, 3), (2, 5)) "
          "GROUP BY column1)"),
      Value{std::string{"2.0,5.0"}});
}

TEST_F(SqlStatistics, of_nothing_are_null) {
  for (const char* call : {"median(x)", "quantile(x, 0.5)", "geomean(x)", "sign_test(x)", "wilcoxon(x)",
                           "mcnemar(x, x)", "par2(x, x, x)"}) {
    EXPECT_EQ(ask(std::string{"SELECT "} + call + " FROM (SELECT 1 AS x WHERE false)"), Value{Null{}})
        << call;
    EXPECT_EQ(ask(std::string{"SELECT "} + call + " FROM (SELECT NULL AS x)"), Value{Null{}}) << call;
  }
}

TEST_F(SqlStatistics, say_what_they_expect) {
  const auto error = [&](const std::string& sql) {
    const auto result = run_sql(file, sql);
    EXPECT_FALSE(result) << sql;
    return result ? std::string{} : result.error().message;
  };
  EXPECT_NE(error("SELECT quantile(1, 2)").find("p is a fraction"), std::string::npos);
  EXPECT_NE(error("SELECT quantile(1, column1) FROM (VALUES (0.1), (0.2))").find("the same for all"),
            std::string::npos);
  EXPECT_NE(error("SELECT geomean(0)").find("greater than 0"), std::string::npos);
  EXPECT_NE(error("SELECT median(column1) FROM (VALUES (1), ('a'))").find("need numbers"), std::string::npos);
}

TEST(Extension, loads_into_a_plain_connection) {
  sqlite3* connection = nullptr;
  ASSERT_EQ(sqlite3_open(":memory:", &connection), SQLITE_OK);
  ASSERT_EQ(sqlite3_db_config(connection, SQLITE_DBCONFIG_ENABLE_LOAD_EXTENSION, 1, nullptr), SQLITE_OK);
  char* error = nullptr;
  EXPECT_EQ(sqlite3_load_extension(connection, SIPPLAB_EXTENSION, nullptr, &error), SQLITE_OK)
      << (error == nullptr ? "" : error);
  sqlite3_free(error);
  EXPECT_EQ(sqlite3_exec(connection,
                         "SELECT median(1), quantile(1, 0.5), geomean(1), sign_test(1), wilcoxon(1), "
                         "mcnemar(1, 0), par2(1, 1, 1)",
                         nullptr, nullptr, nullptr),
            SQLITE_OK)
      << sqlite3_errmsg(connection);
  sqlite3_close(connection);
}

// From the closed forms of Abramowitz and Stegun (1964), 26.7.3 and 26.7.4, in fifty digits; the last
// from 26.7.5.
TEST(Statistics, t_quantiles_are_those_of_the_tables) {
  const std::pair<double, double> table[] = {{1, 12.706204736174705}, {4, 2.7764451051977943},
                                             {5, 2.5705818356363155}, {9, 2.2621571627982053},
                                             {59, 2.000995378088268}, {1e6, 1.959966356814107}};
  for (const auto& [freedom, quantile] : table) {
    EXPECT_NEAR(t_quantile(freedom), quantile, 1e-12 * quantile) << freedom;
  }
}

TEST(Statistics, sign_tests_are_sums_of_binomial_coefficients) {  // in exact integers
  struct Known {
    std::uint64_t wins, losses;
    double p;
  };
  for (const Known& known :
       {Known{0, 5, 0.0625}, Known{700, 800, 0.010559255466711544}, Known{1600, 1400, 0.0002785639610392337},
        Known{2450, 2550, 0.1614852223973769}, Known{49500, 50500, 0.0015823598788515956}}) {
    EXPECT_NEAR(*sign_test(known.wins, known.losses), known.p, 1e-12 * known.p) << known.wins;
  }
}

}  // namespace
}  // namespace sipplab::db::statistics
