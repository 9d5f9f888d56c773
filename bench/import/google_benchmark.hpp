// Reports of Google Benchmark (--benchmark_format=json), of any project.
#pragma once

#include <optional>
#include <string>

#include "db/measurements.hpp"
#include "planner/core/expected.hpp"

namespace sipplab::bench {

/// What the report does not say.
struct ImportContext {
  std::string suite;                  ///< empty: name of the program that ran
  std::optional<std::string> commit;  ///< hash of the commit that was measured
  std::string subject;                ///< of the commit
  std::string branch;
};

/// Errors: one line, `file:line: what, expected what`. Aggregates (mean, median, ...) are left
/// out: the history makes its own.
Expected<db::MeasurementRun, std::string> read_google_benchmark(const std::string& path,
                                                                const ImportContext& context);

}  // namespace sipplab::bench
