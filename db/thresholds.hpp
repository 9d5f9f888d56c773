// From which size on a change counts, by what is measured: the one place for `compare`, `gate` and `trend`.
#pragma once

#include <array>
#include <cstddef>
#include <string_view>

namespace sipplab::db {

/// What a metric is about.
enum class MetricKind {
  kSuccess,  ///< shares of instances solved
  kQuality,  ///< flowtime, makespan
  kCounts,   ///< tries, expansions, generations: exact, the same on every machine
  kTime,     ///< of plannings that ran in turn
  kMemory,
};

struct Threshold {
  MetricKind kind;
  std::string_view name;  ///< as flags have it
  /// Smaller changes are equivalent, however certain: a share of the level, of success a difference.
  double floor;
  std::string_view reason;
};

/// A row for each kind, in order.
inline constexpr std::array<Threshold, 5> kThresholds = {{
    {MetricKind::kSuccess, "success", 0.01,
     "one planning in a hundred: what equal planners lose of suite density by chance is less"},
    {MetricKind::kQuality, "quality", 0.002, "less than the least gain of a change that was made for it"},
    {MetricKind::kCounts, "counts", 0.005, "exact, so that what a person would notice counts"},
    {MetricKind::kTime, "time", 0.01, "code that is moved about by any edit shifts times by as much"},
    {MetricKind::kMemory, "memory", 0.03, "pages and the allocator's arenas come in lumps"},
}};

/// Of times that did not run in turn, which wander by a few per cent on machines that are shared.
inline constexpr double kUnpairedTimeFloor = 0.05;

constexpr double floor_of(MetricKind kind) { return kThresholds[static_cast<std::size_t>(kind)].floor; }

}  // namespace sipplab::db
