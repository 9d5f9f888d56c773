#include "planner/geometry/interval_set.hpp"

#include <algorithm>

#include "planner/core/assert.hpp"

namespace sipplab {

void IntervalSet::remove_open(OpenInterval span) {
  PLANNER_ASSERT(span.begin_s <= span.end_s);
  if (span.empty()) return;
  std::vector<Interval> kept;
  kept.reserve(intervals_.size() + 1);
  for (const Interval& interval : intervals_) {
    if (interval.end_s <= span.begin_s || interval.begin_s >= span.end_s) {
      kept.push_back(interval);
      continue;
    }
    if (interval.begin_s <= span.begin_s) kept.push_back({interval.begin_s, span.begin_s});
    // Nothing begins at infinity: a span without end leaves no point behind it.
    if (interval.end_s >= span.end_s && span.end_s < kForever) kept.push_back({span.end_s, interval.end_s});
  }
  intervals_ = std::move(kept);
}

bool IntervalSet::contains(double t) const {
  const auto after =
      std::upper_bound(intervals_.begin(), intervals_.end(), t,
                       [](double time, const Interval& interval) { return time < interval.begin_s; });
  return after != intervals_.begin() && std::prev(after)->contains(t);
}

void append_complement(std::vector<OpenInterval>& spans, std::vector<Interval>& out) {
  std::sort(spans.begin(), spans.end(),
            [](const OpenInterval& a, const OpenInterval& b) { return a.begin_s < b.begin_s; });
  double free_from_s = 0;
  for (const OpenInterval& span : spans) {
    if (span.empty() || span.end_s <= free_from_s) continue;
    if (span.begin_s >= free_from_s) out.push_back({free_from_s, span.begin_s});
    free_from_s = span.end_s;
  }
  if (free_from_s < kForever) out.push_back({free_from_s, kForever});
}

}  // namespace sipplab
