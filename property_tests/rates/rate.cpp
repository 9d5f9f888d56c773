// Counts and confidence; see rate.hpp.
#include "property_tests/rates/rate.hpp"

#include <array>
#include <cstdio>

namespace sipplab {
namespace {

/// Room for the longest sentence.
constexpr int kTitleColumns = 68;

}  // namespace

void Rate::count(std::optional<bool> outcome) { ++(!outcome ? not_applicable : *outcome ? held : broken); }

std::optional<double> Rate::value() const {
  if (applicable() == 0) return std::nullopt;
  return static_cast<double>(held) / static_cast<double>(applicable());
}

db::statistics::ConfidenceInterval Rate::interval() const {
  return db::statistics::wilson_interval(static_cast<double>(held), static_cast<double>(applicable()));
}

std::string rate_table_heading() {
  std::array<char, 160> line{};
  std::snprintf(line.data(), line.size(), "%-*s %8s %8s %8s  %s\n", kTitleColumns, "relation", "cases",
                "held", "rate", "95 % confidence");
  return line.data();
}

std::string rate_table_row(const Rate& rate) {
  const db::statistics::ConfidenceInterval interval = rate.interval();
  std::array<char, 16> value{"-"};
  if (rate.value()) std::snprintf(value.data(), value.size(), "%.4f", *rate.value());
  std::array<char, 256> line{};
  std::snprintf(line.data(), line.size(), "%-*s %8lld %8lld %8s  %.4f to %.4f\n", kTitleColumns,
                rate.title.c_str(), static_cast<long long>(rate.applicable()),
                static_cast<long long>(rate.held), value.data(), interval.low, interval.high);
  return line.data();
}

}  // namespace sipplab
