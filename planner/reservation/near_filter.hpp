// Four disks at a time: which of them may come near a robot during a slice of time? Uses the compilers' own
// vectors, so every machine has it. What it lets through is decided exactly afterwards.
#pragma once

#include <cstdint>
#include <cstring>

#include "sipplab/geometry.hpp"

namespace sipplab {

/// A disk's motion during one slice, linear in the time since the slice began, in slices.
struct alignas(32) SliceEntry {
  float x;  ///< at the beginning of the slice, on the line
  float y;
  float radius;
  std::uint32_t disk;
  float vx;  ///< cells per slice
  float vy;
  float begin;  ///< of its stay on the line
  float end;
};

/// The motion of a robot during a slice or a part of it, in the same units; each value four times.
class NearFilter {
  using Float4 [[gnu::vector_size(16)]] = float;
  using Int4 [[gnu::vector_size(16)]] = std::int32_t;

 public:
  /// `velocity` in cells per slice.
  NearFilter(Vec2 velocity, double reach) : vx_(all(velocity.x)), vy_(all(velocity.y)), reach_(all(reach)) {}

  /// From now on the robot is at `place` when the slice begins, and only [begin, end] of it counts.
  void set(Vec2 place, double begin, double end) {
    x_ = all(place.x);
    y_ = all(place.y);
    begin_ = all(begin);
    end_ = all(end);
  }

  /// Bit i is set if robot and entry i come nearer than entry i's radius plus `reach` in the time they share,
  /// as far as floats can tell.
  unsigned near(const SliceEntry& a, const SliceEntry& b, const SliceEntry& c, const SliceEntry& d) const {
    Float4 x = load(&a.x), y = load(&b.x), radius = load(&c.x), disk = load(&d.x);
    transpose(x, y, radius, disk);
    Float4 vx = load(&a.vx), vy = load(&b.vx), begin = load(&c.vx), end = load(&d.vx);
    transpose(vx, vy, begin, end);
    begin = begin > begin_ ? begin : begin_;
    const Float4 span = (end < end_ ? end : end_) - begin;
    vx -= vx_;
    vy -= vy_;
    x += vx * begin - x_;
    y += vy * begin - y_;
    // When they are nearest to each other; not a number, and then taken as 0, if they move alike.
    Float4 nearest = -(x * vx + y * vy) / (vx * vx + vy * vy);
    nearest = nearest > 0.0F ? nearest : Float4{};
    nearest = nearest < span ? nearest : span;
    x += vx * nearest;
    y += vy * nearest;
    radius += reach_;
    return bits((x * x + y * y < radius * radius) & (span >= 0.0F));
  }

 private:
  static Float4 all(double value) {
    const auto one = static_cast<float>(value);
    return Float4{one, one, one, one};
  }
  static Float4 load(const float* four) {
    Float4 values;
    std::memcpy(&values, four, sizeof values);
    return values;
  }
  /// Rows to columns.
  static void transpose(Float4& a, Float4& b, Float4& c, Float4& d) {
    const Float4 ab_low = __builtin_shufflevector(a, b, 0, 4, 1, 5);
    const Float4 ab_high = __builtin_shufflevector(a, b, 2, 6, 3, 7);
    const Float4 cd_low = __builtin_shufflevector(c, d, 0, 4, 1, 5);
    const Float4 cd_high = __builtin_shufflevector(c, d, 2, 6, 3, 7);
    a = __builtin_shufflevector(ab_low, cd_low, 0, 1, 4, 5);
    b = __builtin_shufflevector(ab_low, cd_low, 2, 3, 6, 7);
    c = __builtin_shufflevector(ab_high, cd_high, 0, 1, 4, 5);
    d = __builtin_shufflevector(ab_high, cd_high, 2, 3, 6, 7);
  }
  /// The lanes are all ones or all zeros.
  static unsigned bits(Int4 lanes) {
#if defined(__SSE__)
    return static_cast<unsigned>(__builtin_ia32_movmskps(__builtin_bit_cast(Float4, lanes)));
#else
    return static_cast<unsigned>((lanes[0] & 1) | (lanes[1] & 2) | (lanes[2] & 4) | (lanes[3] & 8));
#endif
  }

  Float4 vx_, vy_;
  Float4 reach_;
  Float4 x_{}, y_{}, begin_{}, end_{};
};

}  // namespace sipplab
