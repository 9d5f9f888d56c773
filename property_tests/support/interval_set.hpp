// Safe time: what is left of [0, infinity) when collision intervals are cut out.
#pragma once

#include <cstddef>
#include <memory_resource>
#include <vector>

#include "sipplab/geometry.hpp"

namespace sipplab {

/// Sorted, pairwise disjoint closed intervals of plan time; single points are kept.
class IntervalSet {
 public:
  /// [0, infinity), with memory from `memory`, which must outlive the set.
  explicit IntervalSet(std::pmr::memory_resource* memory = std::pmr::get_default_resource())
      : intervals_({Interval{}}, memory) {}

  /// Removes the open interval (begin_s, end_s). For every time t:
  ///  (1) if begin_s < t < end_s, then !contains(t) afterwards;
  ///  (2) otherwise contains(t) is unchanged, so end points survive;
  ///  (3) the stored intervals stay sorted and pairwise disjoint.
  ///
  /// REQUIRES: begin_s <= end_s. O(log size + intervals behind the one removed).
  void remove_open(OpenInterval span);

  /// Back to [0, infinity); keeps memory.
  void reset() { intervals_.assign(1, Interval{}); }

  /// O(log size).
  bool contains(double t) const;

  const std::pmr::vector<Interval>& intervals() const { return intervals_; }

 private:
  std::pmr::vector<Interval> intervals_;
};

}  // namespace sipplab
