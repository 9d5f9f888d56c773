// Statistics of benchmark results: plain functions, no SQL. All tests are two-sided
// and, if the sizes allow it, exact.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

namespace sipplab::db::statistics {

/// The value below which the fraction `p` of the values lies, interpolated linearly
/// between neighbours (R's type 7, NumPy's default). None for no values.
/// REQUIRES: 0 <= p <= 1; no NaN.
std::optional<double> quantile(std::vector<double> values, double p);

/// quantile(values, 1/2).
std::optional<double> median(std::vector<double> values);

/// Mean of the logarithms, as a factor. None for no values, or for one that is not > 0.
std::optional<double> geometric_mean(const std::vector<double>& values);

/// Probability of a split at least as uneven as (wins, losses) when both are equally
/// likely. Ties are left out by the caller. None for no pairs.
std::optional<double> sign_test(std::uint64_t wins, std::uint64_t losses);

/// McNemar's exact test: `lost` pairs were solved before only, `gained` after only;
/// pairs that agree say nothing. 1 if none disagrees.
double mcnemar(std::uint64_t lost, std::uint64_t gained);

/// McNemar's test where an instance was planned several times, each a number of plannings lost less those
/// gained: the share of all choices of signs whose sum is at least as far from zero. Exact, and mcnemar() if
/// all are 1 or -1. 1 for none.
double sign_flips(const std::vector<std::int64_t>& nets);

/// Up to this many differences the distribution of ranks is counted out; beyond, it is
/// the normal approximation with correction for ties and continuity.
inline constexpr std::size_t kExactWilcoxonLimit = 100;

/// Wilcoxon's signed-rank test on differences of pairs. Zeros are left out, ties share
/// their mean rank. None when no difference is left.
/// REQUIRES: no NaN.
std::optional<double> wilcoxon(const std::vector<double>& differences);

struct ConfidenceInterval {
  double low = 0;
  double high = 1;
};

/// Where the true rate lies with a confidence of 95 %, by Wilson's score interval
/// (Wilson 1927, doi:10.1080/01621459.1927.10502953): good for few cases and for rates near 0
/// and 1, too. All of [0, 1] if `of` is 0. Cases that depend on each other count as fewer: both numbers
/// need not be whole then. REQUIRES: 0 <= held <= of.
ConfidenceInterval wilson_interval(double held, double of);

/// 97.5 % quantile of Student's t. REQUIRES: freedom > 0.
double t_quantile(double freedom);

/// Of the standard normal distribution. REQUIRES: 0 < p < 1.
double normal_quantile(double p);

/// One planning under a limit.
struct TimedResult {
  bool solved = false;
  double time_s = 0;
  double limit_s = 0;
};

/// Mean time, an unsolved result counting as twice its limit (PAR-2). None for no results.
std::optional<double> par2(const std::vector<TimedResult>& results);

}  // namespace sipplab::db::statistics
