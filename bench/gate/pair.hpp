// One pair of processes, base and head, that plan the same jobs in turn. The pair is the
// unit of replication: each has address spaces of its own, and where code and data happen to
// lie moves times by a per cent or so.
#pragma once

#include <string>
#include <vector>

#include "bench/gate/gate_cases.hpp"
#include "planner/core/random.hpp"
#include "sipplab/error.hpp"

namespace sipplab::bench {

/// The two programs of a comparison.
struct GateBuilds {
  std::string base;
  std::string head;
  std::vector<std::string> head_extras;  ///< "NAME=value" that only the head is given
};

struct WorkerPair {
  WorkerProcess base;
  WorkerProcess head;
};

/// Starts both on one core, so that they share its caches, its frequency and its noisy
/// neighbours; the core, and which of them starts first, are drawn. `all`: hands over jobs
/// that are not timed as well.
Expected<WorkerPair, std::string> start_pair(const GateBuilds& builds, const GateCases& cases, bool all,
                                             Random& random);

/// What a pair measured: for each cell (empty for one that is not timed) the logarithms of
/// head's time over base's, one for each two plannings of a job one after the other.
struct PairTimes {
  std::vector<std::vector<double>> log_ratios;
  /// Job and build of the first answer that was not what the build had answered before.
  std::optional<std::size_t> unrepeatable_job;
  bool unrepeatable_head = false;
};

/// Results of each job as both builds gave them first.
struct FirstAnswers {
  std::vector<db::ResultRow> base;
  std::vector<db::ResultRow> head;
};

/// Plans every job once with each build, checked by the validator.
Expected<FirstAnswers, std::string> plan_all(WorkerPair& workers, const GateCases& cases);

/// How long a pair plans.
struct PairBudget {
  double seconds = 0.6;   ///< some five rounds of the suite on a machine that is idle
  int fewest_rounds = 3;  ///< on one that is not: enough to be robust against one bad round
};

/// Rounds over all timed jobs of the cells in `wanted`, in an order drawn for each round,
/// until the budget is spent.
Expected<PairTimes, std::string> time_pair(WorkerPair& workers, const GateCases& cases,
                                           const std::vector<bool>& wanted, const FirstAnswers& expected,
                                           const PairBudget& budget, Random& random);

}  // namespace sipplab::bench
