// Numbers in texts.
#pragma once

#include <fast_float/fast_float.h>

#include <charconv>
#include <concepts>
#include <optional>
#include <string_view>
#include <system_error>

namespace sipplab {

/// The number that the whole text spells: digits, perhaps after a minus. None for anything else, including
/// blanks and a plus sign, and if it does not fit. The same on every machine and with every standard library;
/// linear.
template <std::integral Number>
std::optional<Number> parse_number(std::string_view text, int base = 10) {
  Number value{};
  const char* const end = text.data() + text.size();
  const auto [rest, error] = std::from_chars(text.data(), end, value, base);
  if (error != std::errc{} || rest != end) return std::nullopt;
  return value;
}

/// The same with a point and an exponent; "inf" and "nan" are numbers too. Uses a library: libc++ before
/// version 20 has no std::from_chars for reals.
template <std::floating_point Number>
std::optional<Number> parse_number(std::string_view text) {
  Number value{};
  const char* const end = text.data() + text.size();
  const auto [rest, error] = fast_float::from_chars(text.data(), end, value);
  if (error != std::errc{} || rest != end || text.empty()) return std::nullopt;
  return value;
}

}  // namespace sipplab
