// Reports of Google Benchmark (--benchmark_format=json), of any project.
#pragma once

#include <optional>
#include <string>
#include <string_view>

#include "db/measurements.hpp"
#include "sipplab/error.hpp"

namespace sipplab::bench {

/// What the report does not say.
struct ImportContext {
  std::string suite;                  ///< empty: name of the program that ran
  std::optional<std::string> commit;  ///< hash of the commit that was measured
  std::string subject;                ///< of the commit
  std::string branch;
};

/// 7 or more lower-case hexadecimal digits.
bool is_commit_hash(std::string_view text);

/// Errors: one line, `file:line: what, expected what`. Of a benchmark with repetitions the aggregates (mean,
/// median, ...) are left out: the history makes its own. Of one that is reported by aggregates alone, the
/// median (else the mean) is one measurement. Linear in the size of the report.
Expected<db::MeasurementRun, std::string> read_google_benchmark(const std::string& path,
                                                                const ImportContext& context);

}  // namespace sipplab::bench
