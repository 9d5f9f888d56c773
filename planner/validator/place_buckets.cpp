// Steps and buckets; see place_buckets.hpp.
#include "planner/validator/place_buckets.hpp"

#include <algorithm>
#include <bit>
#include <cmath>
#include <optional>

#include "sipplab/error.hpp"

namespace sipplab {
namespace {

/// Steps allowed in addition to those that the number of motions allows, so that a few long
/// motions on a large map are still cut finely.
constexpr double kFreeSteps = 1 << 14;
constexpr double kStepsPerMotion = 8;

struct TimeSpan {
  double begin_s;
  double end_s;
};

/// The part of a motion's time span within a rectangle.
std::optional<TimeSpan> time_within(const LinearMotion& motion, const Surroundings& within) {
  TimeSpan span{motion.begin_s, motion.end_s};
  const auto cut = [&](double from, double velocity, double low, double high) {
    if (velocity == 0) return from >= low && from <= high;
    const double one = motion.begin_s + (low - from) / velocity;
    const double other = motion.begin_s + (high - from) / velocity;
    span.begin_s = std::max(span.begin_s, std::min(one, other));
    span.end_s = std::min(span.end_s, std::max(one, other));
    return span.begin_s <= span.end_s;
  };
  if (!cut(motion.from.x, motion.velocity_cells_per_s.x, within.low.x, within.high.x)) return std::nullopt;
  if (!cut(motion.from.y, motion.velocity_cells_per_s.y, within.low.y, within.high.y)) return std::nullopt;
  return span;
}

double length_within(const LinearMotion& motion, const TimeSpan& span) {
  return motion.is_rest() ? 0 : norm(motion.velocity_cells_per_s) * (span.end_s - span.begin_s);
}

}  // namespace

Surroundings surroundings(const GridMap& map, double margin_cells) {
  const double beyond = margin_cells + 0.5;
  return {{-beyond, -beyond}, {map.width() - 1 + beyond, map.height() - 1 + beyond}};
}

double choose_step_cells(const std::vector<BodyTrack>& bodies, const Surroundings& within,
                         double reach_cells) {
  double motions = 0;
  double length_cells = 0;
  double squared_radii = 0;
  for (const BodyTrack& body : bodies) {
    const double radius = body.radius_cells + reach_cells;
    for (const LinearMotion& motion : body.motions) {
      const auto span = time_within(motion, within);
      if (!span) continue;
      motions += 1;
      length_cells += length_within(motion, *span);
      squared_radii += radius * radius;
    }
  }
  if (motions == 0) return 1;
  // A body of radius R covers (2 R / side)^2 buckets: with the root mean square of
  // 2 R as the side, that is one per motion on average.
  const double diameter = 2 * std::sqrt(squared_radii / motions);
  return std::max(diameter, length_cells / (kStepsPerMotion * motions + kFreeSteps));
}

std::vector<MotionStep> cut_into_steps(const std::vector<BodyTrack>& bodies, const Surroundings& within,
                                       double step_cells) {
  PLANNER_ASSERT(step_cells > 0);
  std::vector<MotionStep> steps;
  for (std::size_t body = 0; body < bodies.size(); ++body) {
    const std::vector<LinearMotion>& motions = bodies[body].motions;
    for (std::size_t position = 0; position < motions.size(); ++position) {
      const auto span = time_within(motions[position], within);
      if (!span) continue;
      MotionStep step{span->begin_s, span->end_s, static_cast<std::uint32_t>(body),
                      static_cast<std::uint32_t>(position)};
      const double count = std::ceil(length_within(motions[position], *span) / step_cells);
      if (!(count > 1)) {
        steps.push_back(step);
        continue;
      }
      for (double i = 0; i < count; ++i) {
        step.end_s =
            i + 1 < count ? span->begin_s + (span->end_s - span->begin_s) * ((i + 1) / count) : span->end_s;
        steps.push_back(step);
        step.begin_s = step.end_s;
      }
    }
  }
  std::sort(steps.begin(), steps.end(), [](const MotionStep& a, const MotionStep& b) {
    if (a.begin_s != b.begin_s) return a.begin_s < b.begin_s;
    if (a.body != b.body) return a.body < b.body;
    return a.motion < b.motion;
  });
  return steps;
}

BucketGrid::BucketGrid(double bucket_cells, double extent_cells, std::size_t buckets_wanted)
    : per_cell_(1 / bucket_cells) {
  PLANNER_ASSERT(bucket_cells > 0 && buckets_wanted > 0);
  const double enough = std::min(std::ceil(extent_cells / bucket_cells) + 1,
                                 std::ceil(std::sqrt(static_cast<double>(buckets_wanted))));
  side_ = static_cast<std::int32_t>(std::bit_ceil(static_cast<std::uint32_t>(std::max(1.0, enough))));
}

BucketRange BucketGrid::around(Vec2 a, Vec2 b, double reach_cells) const {
  // Within what the later sums of bucket numbers can hold, whatever the places.
  const auto bucket = [&](double cells) {
    return static_cast<std::int32_t>(std::clamp(std::floor(cells * per_cell_), -1e9, 1e9));
  };
  BucketRange range;
  range.first_column = bucket(std::min(a.x, b.x) - reach_cells);
  range.last_column = bucket(std::max(a.x, b.x) + reach_cells);
  range.first_row = bucket(std::min(a.y, b.y) - reach_cells);
  range.last_row = bucket(std::max(a.y, b.y) + reach_cells);
  // Once around the torus is every bucket.
  range.last_column = std::min(range.last_column, range.first_column + side_ - 1);
  range.last_row = std::min(range.last_row, range.first_row + side_ - 1);
  return range;
}

}  // namespace sipplab
