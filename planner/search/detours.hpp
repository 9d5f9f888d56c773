// Where to turn aside for a disk that is in the way of a straight move.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <utility>

#include "planner/geometry/moving_disk.hpp"
#include "sipplab/grid_map.hpp"

namespace sipplab {

/// Cells near the place where a mover meets a disk, so far aside that the two pass each other if the mover
/// comes by there at that time: on either side those of the two shortest detours. Candidates only: neither
/// the map nor other disks are looked at. O(1).
class Detours {
 public:
  /// `reach`: the sum of the radii, in cells. REQUIRES: move.path.length > 0.
  Detours(const Move& move, double departure_s, const MovingDisk& disk, double reach) {
    const double begin_s = std::max(departure_s, disk.begin_s);
    const double shared_s = std::max(0.0, std::min(departure_s + move.duration, disk.end_s) - begin_s);
    const Vec2 relative = move.velocity - disk.velocity;
    const double relative_speed = norm(relative);
    const Vec2 along = move.path.direction;
    // How much of a cell to the side is a cell across the relative motion. Its sign tells the sides apart.
    const double slant = dot(along, relative) / relative_speed;
    if (!(std::abs(slant) >= kLeastSlant)) return;

    // The closest approach.
    const Vec2 mover = move.path.from + move.velocity * (begin_s - departure_s);
    const Vec2 apart = mover - (disk.from + disk.velocity * (begin_s - disk.begin_s));
    const double after_s = std::clamp(-dot(apart, relative) / squared_norm(relative), 0.0, shared_s);
    const Vec2 met = mover + move.velocity * after_s;
    const double missed_by = cross(relative, apart) / relative_speed;
    const Vec2 aside = Vec2{-along.y, along.x} * (slant < 0 ? -1 : 1);
    const double left = (reach - missed_by) / std::abs(slant);
    const double right = (reach + missed_by) / std::abs(slant);

    const Cell middle{nearest(met.x), nearest(met.y)};
    for (std::int32_t y = middle.y - kFarthest; y <= middle.y + kFarthest; ++y) {
      for (std::int32_t x = middle.x - kFarthest; x <= middle.x + kFarthest; ++x) {
        const Vec2 place = centre(Cell{x, y});
        const double offset = dot(place - met, aside);
        if (offset < left && -offset < right) continue;
        keep({{x, y}, norm(place - move.path.from) + norm(move.path.to - place)}, offset > 0 ? 0 : kPerSide);
      }
    }
  }

  template <class Visit>
  void for_each(Visit&& visit) const {
    for (const Detour& detour : detours_) {
      if (detour.cells < kForever) visit(detour.cell);
    }
  }

 private:
  static constexpr std::int32_t kFarthest = 2;  ///< cells from where they meet, in both directions
  static constexpr std::size_t kPerSide = 2;
  /// Of the relative motion along the move. Below this, the disk goes the same way or crosses so fast that no
  /// small step to the side helps.
  static constexpr double kLeastSlant = 0.3;

  struct Detour {
    Cell cell;
    double cells = kForever;
  };

  static std::int32_t nearest(double x) { return static_cast<std::int32_t>(x + (x < 0 ? -0.5 : 0.5)); }

  void keep(Detour detour, std::size_t side) {
    for (std::size_t i = side; i < side + kPerSide; ++i) {
      if (detour.cells < detours_[i].cells) std::swap(detour, detours_[i]);
    }
  }

  std::array<Detour, 2 * kPerSide> detours_{};
};

}  // namespace sipplab
