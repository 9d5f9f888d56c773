// Numbers for people.
#pragma once

#include <cstddef>
#include <string>
#include <string_view>

namespace sipplab::bench {

inline constexpr double kMillisecondsPerSecond = 1e3;
/// Digits of a commit that people read.
inline constexpr std::size_t kHashLength = 10;

/// Four significant digits, whole numbers below ten millions: "0.8571", "12.34", "123456", "1.2e+07".
std::string short_number(double value);
/// With its unit: seconds become ms or us if that reads better.
std::string with_unit(double value, std::string_view unit);
/// "+3.1 %", "-12 %"; of a rate's difference "+3.1 points".
std::string signed_share(double share, bool points);
/// "3", "2.5", "inf".
std::string ssi_text(double ssi_s);

}  // namespace sipplab::bench
