// Safe time: what is left of [0, infinity) when collision intervals are cut out.
#pragma once

#include <cstddef>
#include <vector>

#include "planner/geometry/interval.hpp"

namespace sipplab {

/// Sorted, pairwise disjoint closed intervals of plan time; single points are kept.
class IntervalSet {
 public:
  /// [0, infinity).
  IntervalSet() : intervals_{Interval{}} {}

  /// Removes the open interval (begin_s, end_s). For every time t:
  ///  (1) if begin_s < t < end_s, then !contains(t) afterwards;
  ///  (2) otherwise contains(t) is unchanged, so end points survive;
  ///  (3) the stored intervals stay sorted and pairwise disjoint.
  ///
  /// REQUIRES: begin_s <= end_s. O(size).
  void remove_open(OpenInterval span);

  /// O(log size).
  bool contains(double t) const;

  const std::vector<Interval>& intervals() const { return intervals_; }

 private:
  std::vector<Interval> intervals_;
};

/// The complement of a union, made in one sweep: appends to `out` what is left of
/// [0, infinity) when all `spans` are removed, and leaves `spans` sorted. Agrees with
/// IntervalSet::remove_open applied to each. O(n log n).
void append_complement(std::vector<OpenInterval>& spans, std::vector<Interval>& out);

}  // namespace sipplab
