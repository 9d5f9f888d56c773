// Numbers in texts.
#pragma once

#include <charconv>
#include <concepts>
#include <optional>
#include <string_view>
#include <system_error>

namespace sipplab {

/// The number that the whole text is: digits, of reals a point and an exponent too, perhaps a minus before
/// them. None for anything else, blanks and a plus sign among it, and where it does not fit. Of reals "inf"
/// and "nan" are numbers. The same on every machine and with every standard library; linear.
template <std::integral Number>
std::optional<Number> parse_number(std::string_view text, int base = 10) {
  Number value{};
  const char* const end = text.data() + text.size();
  const auto [rest, error] = std::from_chars(text.data(), end, value, base);
  if (error != std::errc{} || rest != end) return std::nullopt;
  return value;
}
template <std::floating_point Number>
std::optional<Number> parse_number(std::string_view text);

extern template std::optional<double> parse_number<double>(std::string_view text);

}  // namespace sipplab
