// A comparison of two builds from end to end: exact tier, pairs, suspicion, fresh pairs,
// verdict.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "bench/gate/gate_cases.hpp"
#include "bench/gate/pair.hpp"
#include "bench/judge/judgement.hpp"
#include "bench/sweep/run_info.hpp"
#include "db/gate_runs.hpp"

namespace sipplab::bench {

struct GateRequest {
  GateBuilds builds;
  std::string suite = "gate";
  std::uint64_t seed = 1;       ///< of the order of plannings; the instances are always the same
  std::size_t pairs = 14;       ///< 13 of 14 above zero are what the strictest Holm step asks
  std::size_t fresh_pairs = 8;  ///< 7 of 8 confirm
  PairBudget budget;
  double tolerance = 0.05;  ///< a slowdown that must be ruled out for "equivalent"
  Floors floors;
  bool expects_changes = false;  ///< other plans are meant
  /// Sweeps of both builds, judged with the rest.
  std::vector<db::PairedCell> sweeps = {};
  bool treat_as_different = false;  ///< judge times even if both programs are the same file
};

/// What to plant into a comparison of equal builds.
struct Planted {
  double slowdown = 0;                  ///< a logarithm: 0.03 is 3 % slower; 0: nothing
  std::optional<std::size_t> row = {};  ///< of the rows of times; none: all
};

/// Verdicts of comparisons into which the same was planted.
struct ErrorRate {
  Planted planted;
  std::size_t comparisons = 0;
  std::size_t regressed = 0;
  std::size_t inconclusive = 0;
};

struct GateResult {
  WorkerGreeting base;
  WorkerGreeting head;
  std::string started_utc;
  double wall_s = 0;
  std::size_t calibrations = 0;             ///< comparisons of equal builds behind the noise
  std::vector<ErrorRate> error_rates = {};  ///< of calibrations alone
  Judgement judgement;  ///< its cells are those of the cases, its times those of the timed ones;
                        ///< then come those of sweeps
};

/// What pairs of processes gave: times of all cells together, then of each timed cell, then the memory of
/// all.
std::vector<Difference*> paired_rows(Judgement& judgement);

/// Called with one line whenever something new is under way.
using GateProgress = std::function<void(const std::string&)>;

/// Compares. Errors: one line, for builds that cannot be judged.
Expected<GateResult, std::string> compare_builds(const GateRequest& request, const GateCases& cases,
                                                 const std::vector<db::GateNoise>& noise,
                                                 const GateProgress& progress);

/// Calibrations of this kind say how noisy the comparison is.
db::GateKind gate_kind(const GateRequest& request);

/// What the calibrations say about one row.
struct RowNoise {
  std::size_t comparisons = 0;
  std::vector<double> pairs;  ///< log ratios in the order in which they were measured
};
RowNoise calibrated(const Difference& row, const GateCases& cases, const std::vector<db::GateNoise>& noise);

/// Puts noise, floor and what can be seen of all rows right once more calibrations are known.
void update_noise(const GateRequest& request, const GateCases& cases, const std::vector<db::GateNoise>& noise,
                  GateResult& result);

/// As the history keeps it.
db::GateRun gate_record(const GateRequest& request, const GateCases& cases, const GateResult& result,
                        bool calibration);

}  // namespace sipplab::bench
