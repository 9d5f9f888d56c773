// Everything that the report of a run shows, read from the history.
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "bench/judge/judgement.hpp"
#include "db/queries.hpp"
#include "db/table.hpp"
#include "db/trends.hpp"

namespace sipplab::bench {

/// Findings that a page lists at most; of more, one more is read.
inline constexpr std::size_t kMostFindings = 100;

struct ReportTrend {
  const db::TrendMetric* metric = nullptr;
  std::vector<db::TrendSeries> series;  ///< of the cases of the run; empty ones are left out
};

struct ReportData {
  db::RunReport run;
  std::optional<db::RunReport> base;
  Judgement against_base;  ///< without cells if there is no base, or no case that both have
  db::Table properties;    ///< the newest state of each
  db::Table fuzz_runs;     ///< the newest of each target
  db::Table findings;
  std::vector<ReportTrend> trends;
};

/// `run` and `base` as `sipplab show` takes them; without a base it is the run of the same suite
/// before, if there is one.
db::Result<ReportData> read_report(const std::filesystem::path& database, const std::string& run,
                                   const std::optional<std::string>& base);

}  // namespace sipplab::bench
