// How long to improve, as users write it.
#pragma once

#include <cstdint>
#include <limits>
#include <optional>
#include <string>
#include <string_view>

namespace sipplab {

/// One of the two is a limit.
struct ImproveBudget {
  double seconds = std::numeric_limits<double>::infinity();
  std::uint64_t iterations = UINT64_MAX;

  friend bool operator==(const ImproveBudget&, const ImproveBudget&) = default;
};

/// "30", "30s": seconds > 0; "500i": iterations > 0.
std::optional<ImproveBudget> parse_improve_budget(std::string_view text);
/// "30s" or "500i"; parse_improve_budget reads it back as the same value.
/// REQUIRES: one of the two is a limit.
std::string format_improve_budget(const ImproveBudget& budget);

}  // namespace sipplab
