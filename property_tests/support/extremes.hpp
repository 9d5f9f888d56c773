// What lies beyond all numbers, for tests of readers and rules.
#pragma once

#include <limits>

namespace sipplab {

inline constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
inline constexpr double kInfinity = std::numeric_limits<double>::infinity();

}  // namespace sipplab
