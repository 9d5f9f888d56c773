// What the gate plans: the cases of a suite, which it times, and those of the smoke suite
// besides, of which only the results are compared.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "bench/gate/worker_process.hpp"
#include "bench/sweep/expand.hpp"
#include "bench/temporary_folder.hpp"
#include "sipplab/error.hpp"

namespace sipplab::bench {

/// One instance under one case's options. Both builds plan all of them in the same order.
struct GateJob {
  std::size_t cell = 0;
  std::size_t instance = 0;  ///< which file
  db::InstanceInfo row;
};

struct GateCell {
  std::string name;  ///< for people
  db::CaseInfo row;
  PlannerOptions options;
  GateTask task = GateTask::kPlan;
  bool timed = false;
  bool slow = false;  ///< planned fewer times
  std::vector<std::size_t> jobs;
};

/// Instances lie in a folder of their own, which is removed at the end.
class GateCases {
 public:
  struct Extent {
    bool exact = true;       ///< the smoke suite
    bool crowded = true;     ///< what takes longer: beside suite gate those of gate-crowded
    bool laboratory = true;  ///< the tasks beside planning
    /// Instances of each cell; none: as many as the suite has.
    std::optional<std::uint64_t> instances = std::nullopt;
  };
  /// Makes the instances and writes them as files. Errors: one line.
  static Expected<GateCases, std::string> make(const std::string& suite, std::uint64_t seed,
                                               const Extent& extent);

  const std::vector<GateCell>& cells() const { return cells_; }
  const std::vector<GateJob>& jobs() const { return jobs_; }

  /// Tells a worker all instances and jobs, so that both number them alike; `all` adds those
  /// that are not timed. Errors: one line.
  Expected<std::size_t, std::string> hand_over(WorkerProcess& worker, bool all) const;

 private:
  explicit GateCases(TemporaryFolder folder) : folder_(std::move(folder)) {}
  std::string add_suite(const std::string& name, std::uint64_t seed, bool timed, bool slow,
                        std::optional<std::uint64_t> instances);
  void add_laboratory();

  TemporaryFolder folder_;
  std::vector<std::string> files_;
  std::vector<std::string> hashes_;
  std::vector<GateCell> cells_;
  std::vector<GateJob> jobs_;  ///< those of timed cells first
};

}  // namespace sipplab::bench
