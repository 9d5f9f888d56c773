// What the gate times beside planning: reading, validating, recording and asking, each as often as it takes
// to be measured.
#pragma once

#include <array>
#include <cstdint>
#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <string_view>

#include "db/recorder.hpp"
#include "sipplab/error.hpp"
#include "sipplab/solve.hpp"

namespace sipplab::bench {

enum class GateTask {
  kPlan,      ///< solve()
  kRead,      ///< an instance from its file
  kValidate,  ///< the plan of an instance
  kRecord,    ///< a case of fifty results into a history
  kAsk,       ///< a history of ten such cases what became of them
};
inline constexpr std::array kLaboratoryTasks = {GateTask::kRead, GateTask::kValidate, GateTask::kRecord,
                                                GateTask::kAsk};
/// "plan", "read", "validate", "record", "ask".
std::string_view name(GateTask task);
std::optional<GateTask> parse_gate_task(std::string_view text);

struct TimedTask {
  std::uint64_t outcome = 0;  ///< the same for builds that do the same
  std::int64_t cpu_ns = 0;    ///< of one time, the mean of several
};

class Laboratory {
 public:
  /// Histories of this process come into `folder`, and stay there.
  explicit Laboratory(std::filesystem::path folder) : folder_(std::move(folder)) {}

  /// Does it again and again for two milliseconds or more; spends `slowdown` of each time once more.
  /// REQUIRES: task is not kPlan. Errors: one line.
  Expected<TimedTask, std::string> run(GateTask task, const std::string& file, const Instance& instance,
                                       const PlannerOptions& options, double slowdown);

 private:
  Expected<std::uint64_t, std::string> once(GateTask task, const std::string& file, const Instance& instance,
                                            const PlannerOptions& options);
  Expected<std::uint64_t, std::string> record();
  Expected<std::uint64_t, std::string> ask();
  Expected<db::RunRecorder, std::string> new_history(const char* file) const;

  std::filesystem::path folder_;
  std::map<const Instance*, SolveResult> plans_;  ///< under the options that came first
  std::optional<db::RunRecorder> recorder_;
  std::int64_t recorded_ = 0;
  bool is_filled_ = false;
};

}  // namespace sipplab::bench
