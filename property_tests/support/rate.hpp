// How often something holds that need not hold: counts, the rate, and how well it is
// known.
#pragma once

#include <cstdint>
#include <optional>
#include <string>

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
  /// 0 to 1; nothing where no case was applicable.
  std::optional<double> value() const;
};

struct ConfidenceInterval {
  double low = 0;
  double high = 1;
};

/// Where the true rate lies with a confidence of 95 %, by Wilson's score interval
/// (Wilson 1927, doi:10.1080/01621459.1927.10502953): good for few cases and for rates near 0
/// and 1, too. All of [0, 1] where `of` is 0. Cases that depend on each other count as fewer: both numbers
/// need not be whole then. REQUIRES: 0 <= held <= of.
ConfidenceInterval wilson_interval(double held, double of);

/// The heading of a table, and a line of it for each rate.
std::string rate_table_heading();
std::string rate_table_row(const Rate& rate);

}  // namespace sipplab
