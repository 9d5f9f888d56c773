// Safe time against a row of points that are each safe or not.
#include "property_tests/support/interval_set.hpp"
#include "property_tests/support/property.hpp"
#include "property_tests/support/shown.hpp"

#include <rapidcheck.h>

#include <algorithm>
#include <cstddef>
#include <ostream>
#include <utility>
#include <vector>

namespace sipplab::interval_set_laws {
namespace {

/// Cuts begin and end at whole points 0 .. kPoints of the row; between two of them lies
/// one half point that stands for all times there, and one more stands for all after.
constexpr int kPoints = 24;
constexpr double kPointS = 0.125;

/// Every time that can be told from its neighbours, by half points.
class PointModel {
 public:
  PointModel() : safe_(2 * kPoints + 2, true) {}

  static double time_s(std::size_t half_point) { return static_cast<double>(half_point) * kPointS / 2; }
  std::size_t size() const { return safe_.size(); }
  bool is_safe(std::size_t half_point) const { return safe_[half_point]; }

  void remove_open(OpenInterval span) {
    for (std::size_t i = 0; i < safe_.size(); ++i) {
      if (span.begin_s < time_s(i) && time_s(i) < span.end_s) safe_[i] = false;
    }
  }

  std::pmr::vector<Interval> intervals() const {
    std::pmr::vector<Interval> runs;
    for (std::size_t i = 0; i < safe_.size(); ++i) {
      if (!safe_[i]) continue;
      if (i == 0 || !safe_[i - 1]) runs.push_back({time_s(i), time_s(i)});
      runs.back().end_s = i + 1 == safe_.size() ? kForever : time_s(i);
    }
    return runs;
  }

 private:
  std::vector<bool> safe_;
};

/// Begins before time 0 at times, ends never at times; short ones are common, because
/// long ones leave nothing.
rc::Gen<OpenInterval> any_span() {
  return rc::gen::resize(
      rc::kNominalSize, rc::gen::apply(
                            [](int begin, int length) {
                              const double begin_s = begin * kPointS;
                              return OpenInterval{begin_s, length > kPoints
                                                               ? kForever
                                                               : std::min(begin + length, kPoints) * kPointS};
                            },
                            rc::gen::inRange(-2, kPoints),
                            rc::gen::weightedOneOf<int>(
                                {{12, rc::gen::inRange(0, 5)}, {1, rc::gen::inRange(0, kPoints + 3)}})));
}

bool is_point(const Interval& interval) { return interval.begin_s == interval.end_s; }

/// OpenInterval with begin_s <= end_s, as remove_open requires.
OpenInterval ordered(OpenInterval span) { return {span.begin_s, std::max(span.begin_s, span.end_s)}; }

using Spans = std::vector<OpenInterval>;

rc::Gen<Spans> any_spans() { return rc::gen::container<Spans>(any_span()); }

void agrees_with_points(const std::vector<OpenInterval>& spans, IntervalSet& set) {
  PointModel model;
  std::size_t most = 0;
  for (const OpenInterval& drawn : spans) {
    const OpenInterval span = ordered(drawn);
    set.remove_open(span);
    model.remove_open(span);
    for (std::size_t i = 0; i < model.size(); ++i) {
      RC_ASSERT(set.contains(PointModel::time_s(i)) == model.is_safe(i));
    }
    RC_ASSERT(set.intervals() == model.intervals());
    most = std::max(most, set.intervals().size());
  }
  const auto& left = set.intervals();
  RC_CLASSIFY(most >= 4, "four intervals or more");
  RC_CLASSIFY(std::any_of(left.begin(), left.end(), is_point), "single points");
  RC_CLASSIFY(left.empty(), "nothing left");
}

const PropertyRoom room("interval_set", [] {
  bool passed = true;

  passed &= property("remove_open (1)(2)(3): agrees with removal point by point", [] {
    const Spans spans = *any_spans();
    IntervalSet set;
    agrees_with_points(spans, set);
  });

  passed &= property("remove_open: the order of removals does not matter", [] {
    const Spans spans = *any_spans();
    IntervalSet forwards;
    IntervalSet backwards;
    for (const OpenInterval& span : spans) forwards.remove_open(ordered(span));
    for (auto span = spans.rbegin(); span != spans.rend(); ++span) backwards.remove_open(ordered(*span));
    RC_ASSERT(forwards.intervals() == backwards.intervals());
  });

  passed &= property("reset: nothing that was removed is remembered", [] {
    const Spans before = *any_spans();
    const Spans after = *any_spans();
    IntervalSet set;
    for (const OpenInterval& span : before) set.remove_open(ordered(span));
    set.reset();
    RC_ASSERT(set.intervals() == std::pmr::vector<Interval>{Interval{}});
    agrees_with_points(after, set);
  });

  return passed;
});

}  // namespace
}  // namespace sipplab::interval_set_laws
