// A comparison of two builds from end to end: exact tier, pairs, suspicion, fresh pairs,
// verdict.
#pragma once

#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "bench/gate/evidence.hpp"
#include "bench/gate/gate_cases.hpp"
#include "bench/gate/pair.hpp"
#include "bench/judge/exact.hpp"
#include "bench/sweep/run_info.hpp"
#include "db/gate_runs.hpp"

namespace sipplab::bench {

struct GateRequest {
  GateBuilds builds;
  std::string suite = "gate";
  std::uint64_t seed = 1;       ///< of the order of plannings; the instances are always the same
  std::size_t pairs = 12;       ///< 11 of 12 above zero are what the strictest Holm step asks
  std::size_t fresh_pairs = 8;  ///< 7 of 8 confirm
  PairBudget budget;
  double tolerance = 0.05;          ///< a slowdown that must be ruled out for "equivalent"
  bool allow_changes = false;       ///< other plans are meant
  bool treat_as_different = false;  ///< judge times even where both programs are the same file
};

struct GateRow {
  std::string name;
  std::optional<std::size_t> cell;  ///< none: all cells together
  std::vector<double> pairs;        ///< log ratio of each
  std::vector<double> fresh_pairs;
  Suspicion suspicion;
  std::optional<Confirmation> confirmation;
  double at_most = 0;  ///< upper bound of the log ratio, may be infinite
  double noise = 0;    ///< standard error, of calibrations where there are any
  double floor = 0;
  double detectable = 0;  ///< may be infinite
  RowVerdict verdict = RowVerdict::kInconclusive;
};

struct GateDifference {
  std::size_t job = 0;
  Difference what;
};

struct GateResult {
  WorkerGreeting base;
  WorkerGreeting head;
  std::string started_utc;
  double wall_s = 0;
  std::size_t compared = 0;   ///< jobs of the exact tier
  std::size_t differing = 0;  ///< of these
  std::size_t lost = 0;       ///< solved by the base alone
  std::size_t gained = 0;     ///< solved by the head alone
  std::vector<GateDifference> differences;
  std::size_t calibrations = 0;  ///< comparisons of equal builds behind the noise
  std::vector<GateRow> rows;     ///< timed cells, and all of them together
  bool same_program = false;
  bool times_excused = false;     ///< what the rows say was judged to be noise
  bool behaviour_failed = false;  ///< the differences are reason enough
  RowVerdict verdict = RowVerdict::kInconclusive;
  std::string reason;  ///< one line
};

/// Jobs in which the builds differ, each counted once.
std::size_t differing_jobs(const std::vector<GateDifference>& differences);

/// Called with one line whenever something new is under way.
using GateProgress = std::function<void(const std::string&)>;

/// Compares. Errors: one line, for builds that cannot be judged.
Expected<GateResult, std::string> compare_builds(const GateRequest& request, const GateCases& cases,
                                                 const std::vector<db::GateNoise>& noise,
                                                 const GateProgress& progress);

/// Calibrations of this kind say how noisy the comparison is.
db::GateKind gate_kind(const GateRequest& request);

/// Puts noise, floor and what can be seen of all rows right once more calibrations are known.
void update_noise(const GateRequest& request, const GateCases& cases, const std::vector<db::GateNoise>& noise,
                  GateResult& result);

/// As the history keeps it.
db::GateRun gate_record(const GateRequest& request, const GateCases& cases, const GateResult& result,
                        bool calibration);

}  // namespace sipplab::bench
