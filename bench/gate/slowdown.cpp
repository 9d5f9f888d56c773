#include "bench/gate/slowdown.hpp"

#include <cstdlib>
#include <ctime>
#include <string_view>
#include <system_error>

#include "planner/core/number.hpp"

namespace sipplab::bench {
namespace {

/// A planning a thousand times as long is a mistake in a script.
constexpr double kLargestShare = 1000;

/// The number that a variable of the environment holds; none if it holds anything else.
template <class Number>
std::optional<Number> number_in(const char* variable) {
  const char* value = std::getenv(variable);
  return value == nullptr ? std::nullopt : parse_number<Number>(value);
}

}  // namespace

double injected_slowdown() {
  const double share = number_in<double>(kSlowdownVariable).value_or(0);
  return share > 0 && share < kLargestShare ? share : 0;
}

std::optional<std::size_t> injected_change() { return number_in<std::size_t>(kChangeVariable); }

std::int64_t thread_cpu_ns() {
  constexpr std::int64_t kNanosecondsPerSecond = 1'000'000'000;
  timespec now = {};
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &now);
  return static_cast<std::int64_t>(now.tv_sec) * kNanosecondsPerSecond + now.tv_nsec;
}

void burn(double share, std::int64_t spent_ns) {
  if (share <= 0) return;
  const std::int64_t until_ns =
      thread_cpu_ns() + static_cast<std::int64_t>(share * static_cast<double>(spent_ns));
  while (thread_cpu_ns() < until_ns) {
  }
}

}  // namespace sipplab::bench
