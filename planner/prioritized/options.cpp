#include "planner/prioritized/options.hpp"

#include <array>
#include <charconv>
#include <cmath>
#include <utility>

namespace sipplab {
namespace {

constexpr std::array<std::pair<InitialOrder, std::string_view>, 4> kOrderNames = {{
    {InitialOrder::kFifo, "fifo"},
    {InitialOrder::kShortestFirst, "shortest"},
    {InitialOrder::kLongestFirst, "longest"},
    {InitialOrder::kRandom, "random"},
}};

constexpr std::array<std::pair<Rescheduling, std::string_view>, 4> kReschedulingNames = {{
    {Rescheduling::kNone, "none"},
    {Rescheduling::kDeterministic, "deterministic"},
    {Rescheduling::kRandom, "random"},
    {Rescheduling::kEjection, "ejection"},
}};

constexpr std::array<std::pair<Method, std::string_view>, 2> kMethodNames = {{
    {Method::kPrioritized, "prioritized"},
    {Method::kComplete, "complete"},
}};

constexpr std::array<std::pair<Fallback, std::string_view>, 2> kFallbackNames = {{
    {Fallback::kNone, "none"},
    {Fallback::kComplete, "complete"},
}};

template <class Names, class Value>
std::string_view name_in(const Names& names, Value value) {
  for (const auto& [known, text] : names) {
    if (known == value) return text;
  }
  return "unknown";
}

template <class Value, class Names>
std::optional<Value> parse_with(const Names& names, std::string_view text) {
  for (const auto& [value, known] : names) {
    if (known == text) return value;
  }
  return std::nullopt;
}

}  // namespace

std::string_view name(InitialOrder order) { return name_in(kOrderNames, order); }
std::string_view name(Rescheduling rescheduling) { return name_in(kReschedulingNames, rescheduling); }
std::string_view name(Method method) { return name_in(kMethodNames, method); }
std::string_view name(Fallback fallback) { return name_in(kFallbackNames, fallback); }

std::optional<InitialOrder> parse_initial_order(std::string_view text) {
  return parse_with<InitialOrder>(kOrderNames, text);
}

std::optional<Rescheduling> parse_rescheduling(std::string_view text) {
  return parse_with<Rescheduling>(kReschedulingNames, text);
}

std::optional<Method> parse_method(std::string_view text) { return parse_with<Method>(kMethodNames, text); }

std::optional<Fallback> parse_fallback(std::string_view text) {
  return parse_with<Fallback>(kFallbackNames, text);
}

std::optional<double> parse_ssi(std::string_view text) {
  if (text == "inf" || text == "infinity") return kInfiniteSsi;
  double value = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (error != std::errc() || end != text.data() + text.size() || !std::isfinite(value) || value < 0) {
    return std::nullopt;
  }
  return value + 0.0;  // no negative zero
}

std::string format_ssi(double ssi) {
  if (std::isinf(ssi)) return "inf";
  std::array<char, 32> buffer{};
  const auto [end, error] = std::to_chars(buffer.data(), buffer.data() + buffer.size(), ssi);
  return error == std::errc() ? std::string(buffer.data(), end) : std::string("?");
}

}  // namespace sipplab
