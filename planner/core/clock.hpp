// Wall-clock limits.
#pragma once

#include <chrono>
#include <optional>

namespace sipplab {

using Clock = std::chrono::steady_clock;

/// Beyond this many seconds a time limit is as good as none (and a clock would
/// overflow): about three years.
inline constexpr double kLongestTimeLimitS = 1e8;

/// None if the limit is never reached.
inline std::optional<Clock::time_point> deadline_after(Clock::time_point begin, double limit_s) {
  if (!(limit_s < kLongestTimeLimitS)) return std::nullopt;
  return begin + std::chrono::duration_cast<Clock::duration>(std::chrono::duration<double>(limit_s));
}

inline double seconds_since(Clock::time_point begin) {
  return std::chrono::duration<double>(Clock::now() - begin).count();
}

}  // namespace sipplab
