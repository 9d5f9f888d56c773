// Arithmetic that cannot be wrong by rounding: numbers as closed intervals whose ends
// are rounded outwards by one unit in the last place after every operation.
// R. E. Moore, "Interval Analysis" (1966), chapters 2 and 3.
#pragma once

#include <algorithm>
#include <cmath>
#include <limits>

namespace sipplab {

/// A real number that lies somewhere in [low, high].
///
/// Operations on doubles round to nearest, so a true result is less than one unit in
/// the last place away from the computed one, and the next double on either side is
/// beyond it. Laws, for all reals a in A and b in B:
///  (1) a + b is in A + B, and likewise for -, *, square and square_root;
///  (2) a / b is in A / B if b is not 0;
///  (3) after an overflow, or a division by an interval with 0 in it, the result
///      still holds every value that it has to, at worst all numbers.
struct Enclosure {
  double low = 0;
  double high = 0;

  constexpr Enclosure() = default;
  /// Exactly this number.
  explicit constexpr Enclosure(double number) : low(number), high(number) {}
  constexpr Enclosure(double least, double most) : low(least), high(most) {}

  static constexpr Enclosure everything() {
    return {-std::numeric_limits<double>::infinity(), std::numeric_limits<double>::infinity()};
  }
  /// `low` and `high` as computed, rounded outwards. What is not a number may be any.
  static Enclosure outwards(double low, double high) {
    if (std::isnan(low) || std::isnan(high)) return everything();
    constexpr double kInfinity = std::numeric_limits<double>::infinity();
    return {std::nextafter(low, -kInfinity), std::nextafter(high, kInfinity)};
  }

  /// A number in the middle, for guesses that are checked afterwards.
  double guess() const { return low + (high - low) / 2; }
};

inline Enclosure operator+(Enclosure a, Enclosure b) {
  return Enclosure::outwards(a.low + b.low, a.high + b.high);
}

inline Enclosure operator-(Enclosure a, Enclosure b) {
  return Enclosure::outwards(a.low - b.high, a.high - b.low);
}

/// All that lies between the ends, which were rounded.
inline Enclosure hull_of(const double (&ends)[4]) {
  double low = ends[0];
  double high = ends[0];
  for (const double end : ends) {
    if (std::isnan(end)) return Enclosure::everything();
    low = std::min(low, end);
    high = std::max(high, end);
  }
  return Enclosure::outwards(low, high);
}

inline Enclosure operator*(Enclosure a, Enclosure b) {
  return hull_of({a.low * b.low, a.low * b.high, a.high * b.low, a.high * b.high});
}

inline Enclosure operator/(Enclosure a, Enclosure b) {
  if (!(b.low > 0 || b.high < 0)) return Enclosure::everything();
  return hull_of({a.low / b.low, a.low / b.high, a.high / b.low, a.high / b.high});
}

/// Never below 0, and narrower than a * a if a may be 0.
inline Enclosure square(Enclosure a) {
  const double least = a.low > 0 ? a.low : a.high < 0 ? -a.high : 0.0;
  const double most = std::max(std::abs(a.low), std::abs(a.high));
  const Enclosure result = Enclosure::outwards(least * least, most * most);
  return {std::max(0.0, result.low), result.high};
}

/// Of what is not negative in the interval. REQUIRES: high >= 0.
inline Enclosure square_root(Enclosure a) {
  const Enclosure result = Enclosure::outwards(std::sqrt(std::max(0.0, a.low)), std::sqrt(a.high));
  return {std::max(0.0, result.low), result.high};
}

/// True only if it holds for every pair of numbers in the two; the rest is not
/// "greater" but unknown.
inline bool certainly_less(Enclosure a, Enclosure b) { return a.high < b.low; }
inline bool certainly_at_least(Enclosure a, Enclosure b) { return a.low >= b.high; }

}  // namespace sipplab
