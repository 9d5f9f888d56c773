// Times of robots that follow each other in contact at right angles: whole numbers plus
// whole multiples of the square root of two, without rounding.
#pragma once

#include <cstdint>

namespace sipplab {

/// whole + diagonals * sqrt(2), in units of the time of a unit move. Sums of a plan stay far
/// below 2^30 in each part, so that squares of differences fit 64 bits.
struct ExactTime {
  std::int32_t whole = 0;
  std::int32_t diagonals = 0;

  friend bool operator==(const ExactTime&, const ExactTime&) = default;
  friend ExactTime operator+(ExactTime a, ExactTime b) {
    return {a.whole + b.whole, a.diagonals + b.diagonals};
  }
  friend ExactTime operator-(ExactTime a, ExactTime b) {
    return {a.whole - b.whole, a.diagonals - b.diagonals};
  }
  /// Exact: x < y sqrt(2) is decided by squares once the signs agree.
  friend bool operator<(ExactTime a, ExactTime b) {
    const std::int64_t x = std::int64_t{a.whole} - b.whole;
    const std::int64_t y = std::int64_t{b.diagonals} - a.diagonals;
    if (x < 0 && y >= 0) return true;
    if (x >= 0 && y <= 0) return false;
    const bool shorter = static_cast<std::uint64_t>(x * x) < 2 * static_cast<std::uint64_t>(y * y);
    return x >= 0 ? shorter : !shorter;
  }
  double seconds(double unit_move_s) const {
    constexpr double kSquareRootOfTwo = 1.4142135623730951;
    return (whole + diagonals * kSquareRootOfTwo) * unit_move_s;
  }
};

}  // namespace sipplab
