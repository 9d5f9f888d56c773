// What is made of measurements: plain functions of numbers. A slowdown travels as the logarithm of
// head's time over base's: 0.03 is 3 % slower, -0.03 faster.
#pragma once

#include <cstddef>
#include <optional>
#include <vector>

namespace sipplab::bench {

/// Rises when measuring or judging changes in a way that makes older noise worthless.
inline constexpr int kGateMethod = 2;

/// Chance of suspecting some row of a comparison of equal builds, before fresh pairs are asked.
inline constexpr double kSuspicionLevel = 0.02;
/// Chance that fresh pairs confirm what is not there.
inline constexpr double kConfirmationLevel = 0.05;
/// Chance that a median lies beyond a bound, on either side: both together are an interval of 95 %.
inline constexpr double kBoundLevel = 0.025;
/// The floor in standard errors of a comparison of equal builds.
inline constexpr double kFloorInStandardErrors = 3;

/// Mean of the middle half; 0 for no values. For adjacent plannings it scatters half as much
/// from pair to pair as the median over instances of medians does.
double interquartile_mean(std::vector<double> values);

/// Probability of at least this many values above zero if above and below are equally
/// likely; 1 for no values. Zeros are left out.
double slower_p_value(const std::vector<double>& values);

/// With confidence 1 - kBoundLevel, the median of the distribution that the values come from
/// is not above this; infinity for fewer than 6 values.
double upper_bound(std::vector<double> values);

/// The same from below.
double lower_bound(std::vector<double> values);

/// Half of the 95 % interval of the mean, by Student's distribution; none for fewer than 6 values.
std::optional<double> half_width(const std::vector<double>& values);

/// Holm: each p value as it counts among all of them, in their order.
std::vector<double> holm(const std::vector<double>& p_values);

/// Standard error of a comparison, the median over `pairs` of numbers that scatter like
/// `values`; from the median distance to their median, so that a few wild pairs say little.
double standard_error(const std::vector<double>& values, std::size_t pairs);

/// The floor that the noise asks for, or `least`.
double floor_from(double standard_error, double least);

/// How many pairs each look takes.
struct GatePlan {
  std::size_t pairs = 0;
  std::size_t fresh_pairs = 0;
  std::size_t rows = 0;
};

/// The smallest slowdown that is found in 95 of 100 comparisons, when pairs scatter as in
/// `pairs` (drawn again and again, seeded). Infinity for fewer than 2 pairs.
double detectable(const std::vector<double>& pairs, const GatePlan& plan, double floor);

/// The same by a test of ranks at this level, when instances scatter about the effect as in `pairs`, a normal
/// approximation: enough for the test, and with a mean above the floor. Infinity if even pairs that all agree
/// are too few.
double detectable_by_ranks(const std::vector<double>& pairs, double level, double floor);

/// The share of `plannings` that must be lost, spread over the instances by chance, so that in 95 of 100
/// comparisons sign_flips() finds it at this level and it is above the floor, a share too, when without it
/// instances lose and gain as in `nets`. A normal approximation. Infinity if all are too few.
double detectable_losses(const std::vector<double>& nets, std::size_t plannings, double level, double floor);

}  // namespace sipplab::bench
