// What a search may still spend: expansions, and time until its deadline.
#pragma once

#include <cstdint>
#include <optional>

#include "planner/search/single_agent_planner.hpp"

namespace sipplab {

/// Counts the expansions of one search.
class SearchBudget {
 public:
  explicit SearchBudget(const SearchLimits& limits) : limits_(limits) {}

  /// Why there may not be one more expansion, or nothing. The clock is looked at before the
  /// first one and then now and again.
  std::optional<PlanFailure> take_expansion() {
    if (taken_ >= limits_.max_expansions) return PlanFailure::kExpansionLimit;
    if (taken_ % kExpansionsPerLook == 0 && limits_.is_over()) return PlanFailure::kTimeLimit;
    ++taken_;
    return std::nullopt;
  }

 private:
  /// Expansions between two looks at the clock; one takes some microseconds.
  static constexpr std::uint64_t kExpansionsPerLook = 64;

  const SearchLimits& limits_;
  std::uint64_t taken_ = 0;
};

}  // namespace sipplab
