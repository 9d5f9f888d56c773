#include "property_tests/support/interval_set.hpp"

#include <algorithm>
#include <array>

#include "sipplab/error.hpp"

namespace sipplab {

void IntervalSet::remove_open(OpenInterval span) {
  PLANNER_ASSERT(span.begin_s <= span.end_s);
  if (span.empty()) return;
  // The intervals that meet the span: from the first that ends behind its beginning to
  // the last that begins before its end. What they leave is at most one piece each side.
  const auto first =
      std::partition_point(intervals_.begin(), intervals_.end(),
                           [&](const Interval& interval) { return interval.end_s <= span.begin_s; });
  const auto last = std::partition_point(
      first, intervals_.end(), [&](const Interval& interval) { return interval.begin_s < span.end_s; });
  if (first == last) return;
  std::array<Interval, 2> left;
  std::size_t pieces = 0;
  if (first->begin_s <= span.begin_s) left[pieces++] = {first->begin_s, span.begin_s};
  const double end_s = std::prev(last)->end_s;
  // Nothing begins at infinity: a span without end leaves no point behind it.
  if (end_s >= span.end_s && span.end_s < kForever) left[pieces++] = {span.end_s, end_s};

  const auto room = static_cast<std::size_t>(last - first);
  const auto kept = std::copy_n(left.begin(), std::min(pieces, room), first);
  if (pieces < room) {
    intervals_.erase(kept, last);
  } else if (pieces > room) {
    intervals_.insert(last, left[1]);
  }
}

bool IntervalSet::contains(double t) const {
  const auto after =
      std::upper_bound(intervals_.begin(), intervals_.end(), t,
                       [](double time, const Interval& interval) { return time < interval.begin_s; });
  return after != intervals_.begin() && std::prev(after)->contains(t);
}

}  // namespace sipplab
