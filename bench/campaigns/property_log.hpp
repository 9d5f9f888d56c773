// Reads the log that properties append to; its fields are explained where it is
// written, in property_tests/support/property_log.hpp.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "db/property_runs.hpp"
#include "sipplab/error.hpp"

namespace sipplab::bench {

/// The runs of a log; one that began and did not end has crashed, or is not over. Errors are one line:
/// `name:line: what is wrong, what was expected`; a log without any run is one, too.
Expected<std::vector<db::PropertyRun>, std::string> parse_property_log(std::string_view text,
                                                                       const std::string& name);

/// What the runs come to together.
struct PropertyTotals {
  std::size_t runs = 0;
  std::int64_t cases = 0;
  std::int64_t discards = 0;
  std::size_t failed = 0;
  std::size_t gave_up = 0;
  std::size_t crashed = 0;
  double wall_time_s = 0;  ///< sum over the runs, which may have run at once
};
PropertyTotals totals_of(const std::vector<db::PropertyRun>& runs);

}  // namespace sipplab::bench
