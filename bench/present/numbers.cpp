// Numbers for people.
#include "bench/present/numbers.hpp"

#include <fmt/core.h>

#include <cmath>

namespace sipplab::bench {

std::string short_number(double value) {
  if (std::isinf(value)) return value > 0 ? "inf" : "-inf";
  if (value == 0) return "0";
  if (std::abs(value) >= 1e4 && std::abs(value) < 1e7) return fmt::format("{:.0f}", value);
  return fmt::format("{:.4g}", value);
}

std::string with_unit(double value, std::string_view unit) {
  if (unit == "s" && value != 0 && std::abs(value) < 1e-3)
    return fmt::format("{} us", short_number(value * 1e6));
  if (unit == "s" && value != 0 && std::abs(value) < 1)
    return fmt::format("{} ms", short_number(value * 1e3));
  return unit.empty() ? short_number(value) : fmt::format("{} {}", short_number(value), unit);
}

std::string signed_share(double share, bool points) {
  if (std::isinf(share)) return "from 0";
  return fmt::format("{:+.1f} {}", share * 100, points ? "points" : "%");
}

std::string ssi_text(double ssi_s) { return std::isinf(ssi_s) ? "inf" : fmt::format("{:g}", ssi_s); }

}  // namespace sipplab::bench
