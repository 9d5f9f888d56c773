// Separation of all pairs for all time; see separation.hpp.
#include "planner/validator/separation.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <map>
#include <utility>

#include "planner/validator/place_buckets.hpp"

namespace sipplab {
namespace {

/// Cells. Added to every reach: rounding of places by which steps go to buckets.
constexpr double kBucketMarginCells = 1e-6;

/// Cells. Most plans have contacts, so bodies are compared at close quarters first;
/// a wider look is due only when no two come as near as this.
constexpr double kCloseReachCells = 0.125;

/// A step with all that a comparison needs in one place.
struct Candidate {
  double begin_s = 0;
  double end_s = 0;
  Vec2 place;  ///< at begin_s
  Vec2 velocity_cells_per_s;
  Vec2 box_middle;
  Vec2 box_half;  ///< of the box around the body during the step
  double radius_cells = 0;
  std::uint32_t body = 0;
};

Candidate make_candidate(const BodyTrack& body, const MotionStep& step) {
  const LinearMotion& motion = body.motions[step.motion];
  const Vec2 first = motion.at(step.begin_s);
  const Vec2 last = motion.at(step.end_s);
  const double wider = body.radius_cells + kBucketMarginCells;
  return {step.begin_s,
          step.end_s,
          first,
          motion.velocity_cells_per_s,
          (first + last) * 0.5,
          {std::abs(last.x - first.x) / 2 + wider, std::abs(last.y - first.y) / 2 + wider},
          body.radius_cells,
          step.body};
}

/// Positions of candidates, bucket after bucket, within each sorted by time.
struct FilledBuckets {
  std::vector<std::uint32_t> begin;  // bucket b holds items[begin[b]] .. items[begin[b + 1] - 1]
  std::vector<std::uint32_t> items;
};

FilledBuckets fill_buckets(const std::vector<Candidate>& candidates, const BucketGrid& grid,
                           double reach_cells) {
  FilledBuckets filled;
  filled.begin.assign(grid.bucket_count() + 1, 0);
  const auto range_of = [&](const Candidate& candidate) {
    return grid.around(candidate.box_middle - candidate.box_half, candidate.box_middle + candidate.box_half,
                       reach_cells / 2);
  };
  for (const Candidate& candidate : candidates) {
    grid.for_each(range_of(candidate), [&](std::size_t bucket) { ++filled.begin[bucket + 1]; });
  }
  for (std::size_t bucket = 0; bucket < grid.bucket_count(); ++bucket)
    filled.begin[bucket + 1] += filled.begin[bucket];

  filled.items.resize(filled.begin.back());
  std::vector<std::uint32_t> next(filled.begin.begin(), filled.begin.end() - 1);
  for (std::size_t i = 0; i < candidates.size(); ++i) {
    grid.for_each(range_of(candidates[i]),
                  [&](std::size_t bucket) { filled.items[next[bucket]++] = static_cast<std::uint32_t>(i); });
  }
  return filled;
}

class Sweep {
 public:
  Sweep(const std::vector<BodyTrack>& bodies, std::size_t robots, double tolerance_cells,
        std::size_t max_conflicts)
      : bodies_(bodies), robots_(robots), tolerance_cells_(tolerance_cells), max_conflicts_(max_conflicts) {}

  /// Compares all pairs that come within reach of each other. False when enough
  /// conflicts have been found.
  bool run(const std::vector<MotionStep>& steps, const BucketGrid& grid, double reach_cells) {
    std::vector<Candidate> candidates;
    candidates.reserve(steps.size());
    for (const MotionStep& step : steps) candidates.push_back(make_candidate(bodies_[step.body], step));
    const FilledBuckets filled = fill_buckets(candidates, grid, reach_cells);
    least_clearance_cells_ = std::min(least_clearance_cells_, reach_cells);
    for (std::size_t bucket = 0; bucket < grid.bucket_count(); ++bucket) {
      sweep_bucket(candidates, filled.items.data() + filled.begin[bucket],
                   filled.items.data() + filled.begin[bucket + 1]);
      if (conflicts_.size() >= max_conflicts_) return false;
    }
    return true;
  }

  /// The least clearance found, or the reach if none was less.
  double least_clearance_cells() const { return least_clearance_cells_; }
  void forget_clearance() { least_clearance_cells_ = std::numeric_limits<double>::infinity(); }

  Separation result() const {
    Separation separation;
    separation.min_clearance_cells = least_clearance_cells_;
    for (const auto& [pair, seen] : conflicts_) {
      // The buckets were left early, maybe: look at the two bodies' whole lives.
      const BodyTrack& a = bodies_[pair.first];
      const BodyTrack& b = bodies_[pair.second];
      Approach deepest = closest_approach(a, b);
      if (seen.distance_cells < deepest.distance_cells) deepest = seen;
      const double clearance_cells = deepest.distance_cells - (a.radius_cells + b.radius_cells);
      separation.min_clearance_cells = std::min(separation.min_clearance_cells, clearance_cells);
      separation.conflicts.push_back({pair.first, pair.second, deepest.time_s, -clearance_cells});
    }
    std::sort(separation.conflicts.begin(), separation.conflicts.end(),
              [](const BodyConflict& a, const BodyConflict& b) {
                if (a.time_s != b.time_s) return a.time_s < b.time_s;
                return std::pair(a.first, a.second) < std::pair(b.first, b.second);
              });
    return separation;
  }

 private:
  void sweep_bucket(const std::vector<Candidate>& candidates, const std::uint32_t* begin,
                    const std::uint32_t* end) {
    active_.clear();
    for (const std::uint32_t* item = begin; item != end; ++item) {
      const Candidate& candidate = candidates[*item];
      std::size_t kept = 0;
      for (const Candidate* other : active_) {
        if (other->end_s < candidate.begin_s) continue;  // over for all that follow, too
        active_[kept++] = other;
        if (may_be_nearest(*other, candidate)) compare(*other, candidate);
      }
      active_.resize(kept);
      active_.push_back(&candidate);
    }
  }

  /// False for bodies that stay farther apart than the nearest two so far.
  bool may_be_nearest(const Candidate& a, const Candidate& b) const {
    const double apart_cells =
        std::max(std::abs(a.box_middle.x - b.box_middle.x) - (a.box_half.x + b.box_half.x),
                 std::abs(a.box_middle.y - b.box_middle.y) - (a.box_half.y + b.box_half.y));
    return apart_cells <= std::max(0.0, least_clearance_cells_);
  }

  /// `b` begins no earlier than `a`, which is not over by then.
  void compare(const Candidate& a, const Candidate& b) {
    if (a.body == b.body || (a.body >= robots_ && b.body >= robots_)) return;
    const LinearMotion motion_a{a.begin_s, a.end_s, a.place, a.velocity_cells_per_s};
    const LinearMotion motion_b{b.begin_s, b.end_s, b.place, b.velocity_cells_per_s};
    const Approach approach = closest_approach(motion_a, motion_b, b.begin_s, std::min(a.end_s, b.end_s));
    const double clearance_cells = approach.distance_cells - (a.radius_cells + b.radius_cells);
    if (clearance_cells < least_clearance_cells_) least_clearance_cells_ = clearance_cells;
    if (clearance_cells >= -tolerance_cells_) return;
    const std::pair<std::size_t, std::size_t> pair = std::minmax<std::size_t>(a.body, b.body);
    const auto found = conflicts_.find(pair);
    if (found != conflicts_.end()) {
      if (approach.distance_cells < found->second.distance_cells) found->second = approach;
    } else if (conflicts_.size() < max_conflicts_) {
      conflicts_.emplace(pair, approach);
    }
  }

  const std::vector<BodyTrack>& bodies_;
  const std::size_t robots_;
  const double tolerance_cells_;
  const std::size_t max_conflicts_;
  std::vector<const Candidate*> active_;
  std::map<std::pair<std::size_t, std::size_t>, Approach> conflicts_;
  double least_clearance_cells_ = std::numeric_limits<double>::infinity();
};

}  // namespace

Separation check_separation(const GridMap& map, const std::vector<BodyTrack>& bodies, std::size_t robots,
                            double tolerance_cells, std::size_t max_conflicts) {
  if (robots == 0 || bodies.size() < 2) return {};
  double max_radius_cells = 0;
  for (const BodyTrack& body : bodies) max_radius_cells = std::max(max_radius_cells, body.radius_cells);
  // A robot's centre is inside the map or the plan is wrong already.
  const Surroundings within = surroundings(map, 2 * max_radius_cells + kClearanceReachCells);
  const double extent_cells = std::max(within.high.x - within.low.x, within.high.y - within.low.y);

  Sweep sweep(bodies, robots, tolerance_cells, max_conflicts);
  for (const double reach_cells : {kCloseReachCells, kClearanceReachCells}) {
    const double step_cells = choose_step_cells(bodies, within, reach_cells / 2);
    const std::vector<MotionStep> steps = cut_into_steps(bodies, within, step_cells);
    const BucketGrid grid(step_cells, extent_cells, 2 * steps.size() + 1);
    sweep.forget_clearance();
    if (!sweep.run(steps, grid, reach_cells) || sweep.least_clearance_cells() < reach_cells) break;
  }
  return sweep.result();
}

}  // namespace sipplab
