// Counts and confidence; see rate.hpp.
#include "property_tests/support/rate.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>

namespace sipplab {
namespace {

/// The two-sided 95 % quantile of the normal distribution.
constexpr double kNormalQuantile = 1.959963984540054;
/// Room for the longest sentence.
constexpr int kTitleColumns = 68;

}  // namespace

void Rate::count(std::optional<bool> outcome) { ++(!outcome ? not_applicable : *outcome ? held : broken); }

std::optional<double> Rate::value() const {
  if (applicable() == 0) return std::nullopt;
  return static_cast<double>(held) / static_cast<double>(applicable());
}

ConfidenceInterval wilson_interval(double held, double of) {
  if (of == 0) return {};
  const double rate = held / of;
  const double weight = kNormalQuantile * kNormalQuantile / of;
  const double middle = (rate + weight / 2) / (1 + weight);
  const double half = kNormalQuantile * std::sqrt(rate * (1 - rate) / of + weight / (4 * of)) / (1 + weight);
  // Exact at the ends, where rounding leaves a trace.
  return {held == 0 ? 0.0 : std::max(0.0, middle - half), held == of ? 1.0 : std::min(1.0, middle + half)};
}

std::string rate_table_heading() {
  std::array<char, 160> line{};
  std::snprintf(line.data(), line.size(), "%-*s %8s %8s %8s  %s\n", kTitleColumns, "relation", "cases",
                "held", "rate", "95 % confidence");
  return line.data();
}

std::string rate_table_row(const Rate& rate) {
  const ConfidenceInterval interval =
      wilson_interval(static_cast<double>(rate.held), static_cast<double>(rate.applicable()));
  std::array<char, 16> value{"-"};
  if (rate.value()) std::snprintf(value.data(), value.size(), "%.4f", *rate.value());
  std::array<char, 256> line{};
  std::snprintf(line.data(), line.size(), "%-*s %8lld %8lld %8s  %.4f to %.4f\n", kTitleColumns,
                rate.title.c_str(), static_cast<long long>(rate.applicable()),
                static_cast<long long>(rate.held), value.data(), interval.low, interval.high);
  return line.data();
}

}  // namespace sipplab
