// Changes of level: found where they are, and not where there are none.
#include "db/statistics/change_points.hpp"

#include <gtest/gtest.h>

#include "planner/core/random.hpp"

namespace sipplab::db::statistics {
namespace {

std::vector<double> noisy(Random& random, std::size_t count, double level, double noise) {
  // Nearly normal: a sum of twelve uniforms.
  std::vector<double> values;
  for (std::size_t i = 0; i < count; ++i) {
    double sum = -6;
    for (int k = 0; k < 12; ++k) sum += random.unit();
    values.push_back(level + noise * sum);
  }
  return values;
}

std::vector<double> joined(std::vector<double> first, const std::vector<double>& second) {
  first.insert(first.end(), second.begin(), second.end());
  return first;
}

std::vector<std::size_t> accepted(const std::vector<double>& values) {
  std::vector<std::size_t> positions;
  for (const Division& division : divide(values)) {
    if (division.accepted) positions.push_back(division.position);
  }
  return positions;
}

TEST(ChangePoints, nothing_is_found_in_too_little) {
  EXPECT_TRUE(divide({}).empty());
  EXPECT_TRUE(divide({1, 1, 1, 9, 9, 9, 9}).empty()) << "seven points are no two segments of four";
}

TEST(ChangePoints, a_constant_series_has_no_change) {
  EXPECT_TRUE(accepted(std::vector<double>(50, 0.1)).empty());
}

TEST(ChangePoints, a_step_is_found_at_its_first_point) {
  EXPECT_EQ(accepted(joined(std::vector<double>(6, 0.3), std::vector<double>(5, 0.4))),
            (std::vector<std::size_t>{6}));
  // Far away from 0, where sums lose digits.
  EXPECT_EQ(accepted(joined(std::vector<double>(6, 1e12 + 3), std::vector<double>(5, 1e12 + 4))),
            (std::vector<std::size_t>{6}));
}

TEST(ChangePoints, steps_up_and_down_are_found_in_noise) {
  Random random{7};
  // Drawn one after the other: compilers differ in the order in which they evaluate arguments. One series in
  // twenty is divided without need, and this is none of them.
  const auto last = noisy(random, 70, 9.5, 1);
  const auto middle = noisy(random, 50, 13, 1);
  const auto first = noisy(random, 60, 10, 1);
  const auto values = joined(joined(first, middle), last);
  const std::vector<std::size_t> positions = accepted(values);
  ASSERT_EQ(positions.size(), 2U);
  EXPECT_NEAR(static_cast<double>(positions[0]), 60, 2);
  EXPECT_NEAR(static_cast<double>(positions[1]), 110, 2);
}

TEST(ChangePoints, noise_alone_is_divided_as_rarely_as_promised) {
  Random random{1};
  constexpr int kSeries = 200;
  int alarms = 0;
  for (int i = 0; i < kSeries; ++i) alarms += accepted(noisy(random, 30, 5, 1)).empty() ? 0 : 1;
  // 10 are expected at 5 %; 20 or more have a probability of 0.3 %, and the seed is fixed.
  EXPECT_LT(alarms, 20);
  EXPECT_GT(alarms, 1) << "a test that never alarms does not test at 5 %";
}

TEST(ChangePoints, the_same_series_gives_the_same_answer) {
  Random random{3};
  const auto low = noisy(random, 20, 1, 1);
  const auto values = joined(low, noisy(random, 20, 1.6, 1));
  const auto first = divide(values);
  const auto second = divide(values);
  ASSERT_EQ(first.size(), second.size());
  for (std::size_t i = 0; i < first.size(); ++i) {
    EXPECT_EQ(first[i].position, second[i].position);
    EXPECT_EQ(first[i].p_value, second[i].p_value);
  }
}

TEST(ChangePoints, segments_are_as_long_as_asked) {
  ChangePointOptions options;
  options.min_segment = 10;
  for (const Division& division :
       divide(joined(std::vector<double>(6, 0), std::vector<double>(30, 1)), options)) {
    if (division.accepted) {
      EXPECT_GE(division.position, 10U);
    }
  }
}

TEST(BenjaminiHochberg, example_of_1995) {
  // Table 1 of the paper: 15 p values, of which four stand at 5 %.
  const std::vector<double> p{0.0001, 0.0004, 0.0019, 0.0095, 0.0201, 0.0278, 0.0298, 0.0344,
                              0.0459, 0.3240, 0.4262, 0.5719, 0.6528, 0.7590, 1.0000};
  const std::vector<bool> stands = benjamini_hochberg(p, 0.05);
  for (std::size_t i = 0; i < p.size(); ++i) EXPECT_EQ(stands[i], i < 4) << i;
  EXPECT_TRUE(benjamini_hochberg({}, 0.05).empty());
}

}  // namespace
}  // namespace sipplab::db::statistics
