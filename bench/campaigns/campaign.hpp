// A campaign: each target runs for its share of the time, what it finds is judged, made
// smaller and drawn, and all of it goes to the history.
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "bench/campaigns/target_program.hpp"
#include "db/database.hpp"
#include "db/findings.hpp"
#include "db/fuzz_runs.hpp"

namespace sipplab::bench {

struct CampaignOptions {
  std::filesystem::path programs;          ///< folder of the targets' programs
  std::filesystem::path sources;           ///< the folder fuzz/: corpus/, regressions/, dictionaries/
  std::filesystem::path work;              ///< where corpora grow, with logs, artifacts and pictures
  std::string mode = "for";                ///< "smoke", "for", "nightly"
  std::vector<std::string> targets;        ///< empty: all
  std::optional<std::int64_t> executions;  ///< per target
  std::optional<double> seconds;           ///< all targets together
  std::uint64_t seed = 1;
  int workers = 1;          ///< processes at a time: of one target in fork mode (nightly), else one of each
  bool skip_known = false;  ///< leave out programs that were fuzzed for a time without findings
};

struct CampaignResult {
  std::string campaign;  ///< UUID
  std::vector<std::string> skipped;
  std::vector<db::StoredFinding> findings;  ///< seen in this campaign
  bool broken = false;                      ///< a target did not run as it should
};

/// The targets below sources/corpus for which there is a program.
std::vector<std::string> targets_of(const CampaignOptions& options);

/// Runs all targets; rows are written after each, findings among them. Afterwards findings are made smaller,
/// within the same budget of seconds. An interrupt ends engines and reductions; what was found by then is
/// written. `tell` gets one line at a time, for a person, never two at once.
db::Result<CampaignResult> run_campaign(db::Database& database, const db::RunOrigin& origin,
                                        const CampaignOptions& options, const Teller& tell);

}  // namespace sipplab::bench
