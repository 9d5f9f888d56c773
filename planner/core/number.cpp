// Numbers in texts; see number.hpp.
#include "planner/core/number.hpp"

#include <fast_float/fast_float.h>

namespace sipplab {

/// By a library: libc++ before version 20 has no std::from_chars for reals.
template <std::floating_point Number>
std::optional<Number> parse_number(std::string_view text) {
  Number value{};
  const char* const end = text.data() + text.size();
  const auto [rest, error] = fast_float::from_chars(text.data(), end, value);
  if (error != std::errc{} || rest != end || text.empty()) return std::nullopt;
  return value;
}

template std::optional<double> parse_number<double>(std::string_view text);

}  // namespace sipplab
