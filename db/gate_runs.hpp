// Comparisons of two builds by `sipplab gate`: how they get into the history, and the noise of
// this machine that they left there.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "db/database.hpp"
#include "db/records.hpp"
#include "db/sqlite/error.hpp"

namespace sipplab::db {

/// One row of a comparison. A slowdown is head's time over base's, minus one.
struct GateCellRow {
  std::optional<CaseInfo> parameters;  ///< none: all cells together
  double slowdown = 0;
  double p_value = 1;
  std::optional<double> confirm_slowdown;
  std::optional<double> confirm_p_value;
  std::optional<double> at_most;  ///< none: no bound can be given
  double noise = 0;               ///< standard error of `slowdown`
  double effect_floor = 0;
  std::optional<double> detectable;  ///< none: none can be told
  std::string verdict;               ///< "regressed", "inconclusive", "equivalent" (also if faster)
  std::vector<double> pairs;         ///< slowdown of each pair
  std::vector<double> fresh_pairs;   ///< of those that were to confirm
};

struct GateDifferenceRow {
  CaseInfo parameters;
  InstanceInfo instance;
  std::string what;  ///< "status", "validity", "plan", "work", "repetition"
  std::string base;
  std::string head;
};

/// Its origin is the head: the commit and build that are judged.
struct GateRun : RunOrigin {
  std::string uuid;  ///< given when it is recorded
  bool calibration = false;
  std::string suite;
  std::int64_t method = 0;
  BuildInfo base_build;
  std::optional<CommitInfo> base_commit;
  std::uint64_t seed = 0;
  double pair_seconds = 0;  ///< that each pair of processes planned for
  double tolerance = 0;
  double injected_slowdown = 0;
  std::int64_t wall_time_ns = 0;
  std::string started_utc;
  std::int64_t compared = 0;   ///< instances and options that both builds planned
  std::int64_t differing = 0;  ///< those with a difference
  std::string verdict;
  std::string reason;
  std::vector<GateCellRow> cells;
  std::vector<GateDifferenceRow> differences;
};

/// Writes everything in one transaction. Returns the UUID.
Result<std::string> record_gate_run(Database& database, GateRun run);

/// What calibrations said about one row: the pairs of each comparison of equal builds.
struct GateNoise {
  std::optional<CaseInfo> parameters;  ///< none: all cells together
  std::vector<std::vector<double>> comparisons;
};

/// How a comparison was made: noise of one kind says nothing about another.
struct GateKind {
  MachineInfo machine;
  std::string suite;
  std::int64_t method = 0;
  double pair_seconds = 0;
};

/// Of the newest calibrations of that kind; empty if there is none.
Result<std::vector<GateNoise>> gate_noise(Database& database, const GateKind& kind);

}  // namespace sipplab::db
