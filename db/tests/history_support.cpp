#include "db/tests/history_support.hpp"

#include <fmt/core.h>

namespace sipplab::db::test {

std::string hash_of(int number) { return fmt::format("{:040x}", 0xffff - number); }

std::string record_version(const std::filesystem::path& file, const Version& version, std::int64_t robots) {
  RunInfo info = sample_run();
  info.machine.host = version.host;
  info.build.dirty = version.dirty;
  info.commit = CommitInfo{hash_of(version.number),
                           fmt::format("2026-01-{:02}T12:00:00Z", 1 + version.number % 28),
                           fmt::format("Change {}", version.number),
                           version.number > 1 ? hash_of(version.number - 1) : "",
                           version.number,
                           version.number};
  auto recorder = must(RunRecorder::begin(must(Database::open(file)), info));
  CaseInfo parameters = sample_case(robots);
  parameters.planner = version.planner;
  parameters.options["time_limit_s"] = version.time_limit_s;
  for (int i = 0; i < version.instances; ++i) {
    ResultRow row = i < version.solved ? sample_result(i) : failed_result();
    row.planning_time_ns = static_cast<std::int64_t>(1e6 * (i + 1) * version.factor);
    if (row.flowtime_s) row.flowtime_s = 1000 * version.factor;
    recorder.add(parameters, sample_instance(i), row);
  }
  must(recorder.commit());
  const std::string uuid = recorder.run_uuid();
  must(recorder.finish(RunStatus::kFinished));
  return uuid;
}

}  // namespace sipplab::db::test
