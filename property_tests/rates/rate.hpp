// How often something holds that need not hold: counts, the rate, and how well it is
// known.
#pragma once

#include <cstdint>
#include <optional>
#include <string>

#include "db/statistics/statistics.hpp"

namespace sipplab {

struct Rate {
  std::string title;  ///< a sentence
  std::int64_t held = 0;
  std::int64_t broken = 0;
  std::int64_t not_applicable = 0;  ///< cases of which the sentence says nothing

  /// An outcome that is missing is not applicable.
  void count(std::optional<bool> outcome);

  std::int64_t applicable() const { return held + broken; }
  std::int64_t cases() const { return applicable() + not_applicable; }
  /// 0 to 1; nothing if no case was applicable.
  std::optional<double> value() const;
  db::statistics::ConfidenceInterval interval() const;
};

/// The heading of a table, and a line of it for each rate.
std::string rate_table_heading();
std::string rate_table_row(const Rate& rate);

}  // namespace sipplab
