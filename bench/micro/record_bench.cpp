// How fast results reach the history: cases of a hundred results, one transaction each, as a sweep
// writes them.
#include <benchmark/benchmark.h>
#include <fmt/format.h>

#include <string>
#include <utility>

#include "bench/sweep/run_info.hpp"
#include "bench/sweep/sweep_case.hpp"
#include "bench/temporary_folder.hpp"
#include "db/database.hpp"
#include "db/recorder.hpp"

namespace sipplab {
namespace {

constexpr int kResults = 100;

db::ResultRow sample_row(int index) {
  db::ResultRow row;
  row.position = index;
  row.status = db::ResultStatus::kSolved;
  row.planning_time_ns = 1'000'000 + 7919 * (index % 13);
  row.makespan_s = 30 + 0.1 * index;
  row.flowtime_s = 1000 + 0.3 * index;
  row.tries = 2;
  row.expansions = 5000;
  row.generations = 20000;
  row.plan_hash = static_cast<std::uint64_t>(index) * std::uint64_t{0x9e3779b97f4a7c15};
  row.valid = true;
  row.min_clearance_cells = 1e-12;
  return row;
}

void record_cases(benchmark::State& state) {
  const auto folder = bench::TemporaryFolder::make();
  if (!folder) return state.SkipWithError(folder.error().c_str());
  auto database = db::Database::open(folder->path() / "history.db");
  if (!database) return state.SkipWithError(database.error().message.c_str());
  db::RunInfo info;
  info.suite = "micro";
  info.machine = bench::machine_info();
  auto recorder = db::RunRecorder::begin(std::move(*database), info);
  if (!recorder) return state.SkipWithError(recorder.error().message.c_str());
  db::CaseInfo parameters = bench::case_row({});
  std::int64_t seed = 0;
  for ([[maybe_unused]] auto iteration : state) {
    parameters.options["seed"] = ++seed;  // another case each time
    for (int i = 0; i < kResults; ++i) {
      const db::InstanceInfo instance{
          fmt::format("{:016x}", i), "map", fmt::format("number {}", i), 64, 32, 32, 0};
      recorder->add(parameters, instance, sample_row(i));
    }
    if (const auto done = recorder->commit(); !done) {
      return state.SkipWithError(done.error().message.c_str());
    }
  }
  state.SetItemsProcessed(static_cast<std::int64_t>(state.iterations()) * kResults);
}
BENCHMARK(record_cases)->Name("history/record_100_results")->Unit(benchmark::kMicrosecond);

}  // namespace
}  // namespace sipplab
