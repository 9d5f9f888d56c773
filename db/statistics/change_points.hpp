// Where a series changes its level: E-divisive with permutation tests
// (Matteson & James 2014, doi:10.1080/01621459.2013.849605), as continuous integration
// uses it (Daly et al. 2020, doi:10.1145/3358960.3375791).
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

namespace sipplab::db::statistics {

struct ChangePointOptions {
  /// Points between two changes, at least. Three on either side can be divided in 20
  /// ways, so that no division of them could ever be significant at 5 %.
  std::size_t min_segment = 4;
  /// Level of one test, before many series are looked at together.
  double significance = 0.05;
  std::uint64_t seed = 1;  ///< of the permutations
};

/// One place at which a segment was divided, or could not be.
struct Division {
  std::size_t position = 0;  ///< first point of the new level; 0 if none was found
  double p_value = 1;
  bool accepted = false;  ///< p_value <= significance
};

/// Divides the series at its greatest change, then both parts again, until no division
/// is significant. All tests are returned, those that found nothing too, by position:
/// many series are to be judged together. The same input gives the same answer.
///
/// Differs from [MJ14]: the segment after a division reaches to the end of the part (they
/// try all ends), which makes it O(n log n), and each part is permuted on its own.
/// REQUIRES: no NaN.
std::vector<Division> divide(const std::vector<double>& values, const ChangePointOptions& options = {});

/// Which of many tests stand when the expected share of false ones among them is to be
/// at most `rate` (Benjamini & Hochberg 1995).
std::vector<bool> benjamini_hochberg(const std::vector<double>& p_values, double rate);

}  // namespace sipplab::db::statistics
