// Motions cut into short steps and sorted into buckets by place: bodies that come
// near each other have steps that share a bucket.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "planner/validator/body_track.hpp"
#include "sipplab/grid_map.hpp"

namespace sipplab {

/// A part of a motion, short enough for a few buckets.
struct MotionStep {
  double begin_s = 0;
  double end_s = 0;
  std::uint32_t body = 0;
  std::uint32_t motion = 0;  ///< position in the body's track
};

/// A span of buckets along both axes, ends included.
struct BucketRange {
  std::int32_t first_column = 0;
  std::int32_t last_column = 0;
  std::int32_t first_row = 0;
  std::int32_t last_row = 0;
};

/// Square buckets that tile the plane and repeat: the plane is wrapped around a
/// torus of at most a few buckets per step, so that memory follows the size of the
/// plan and not the size of the map. Two places far apart can share a bucket,
/// which costs a comparison and nothing else.
class BucketGrid {
 public:
  /// REQUIRES: bucket_cells > 0, buckets_wanted > 0.
  BucketGrid(double bucket_cells, double extent_cells, std::size_t buckets_wanted);

  std::size_t bucket_count() const {
    return static_cast<std::size_t>(side_) * static_cast<std::size_t>(side_);
  }

  /// Buckets that the box around two points touches, `reach_cells` wider all round.
  BucketRange around(Vec2 a, Vec2 b, double reach_cells) const;

  /// Calls visit(bucket) once for each bucket of the range.
  template <class Visit>
  void for_each(const BucketRange& range, Visit visit) const {
    for (std::int32_t row = range.first_row; row <= range.last_row; ++row) {
      for (std::int32_t column = range.first_column; column <= range.last_column; ++column) {
        visit(static_cast<std::size_t>(row & (side_ - 1)) * static_cast<std::size_t>(side_) +
              static_cast<std::size_t>(column & (side_ - 1)));
      }
    }
  }

 private:
  double per_cell_;    // buckets
  std::int32_t side_;  // buckets along each axis, a power of two
};

/// The square of all places within `margin_cells` of the map.
struct Surroundings {
  Vec2 low;
  Vec2 high;
};
Surroundings surroundings(const GridMap& map, double margin_cells);

/// Cuts the time during which each motion is within the surroundings into equal
/// steps of at most `step_cells` each; sorted by begin_s, then body, then motion.
std::vector<MotionStep> cut_into_steps(const std::vector<BodyTrack>& bodies, const Surroundings& within,
                                       double step_cells);

/// A length for steps and for buckets' sides that keeps both numbers small: at most
/// nine steps per motion on average (and some thousands more), and a few buckets
/// per step, however long single motions and however large single bodies are.
/// `reach_cells` is added to each radius.
double choose_step_cells(const std::vector<BodyTrack>& bodies, const Surroundings& within,
                         double reach_cells);

}  // namespace sipplab
