// Google Benchmark reporters of a sweep: one that records each finished case and
// passes everything on, and one that prints a table at the end.
#pragma once

#include <benchmark/benchmark.h>

#include <string>
#include <vector>

#include "bench/sweep/sweep.hpp"

namespace sipplab::bench {

/// Opens the run when the benchmarks begin, commits every case as it ends, and hands
/// all calls on to `shown` (none: nothing is shown while the sweep runs).
class RecordingReporter : public benchmark::BenchmarkReporter {
 public:
  RecordingReporter(Sweep& sweep, benchmark::BenchmarkReporter* shown) : sweep_(sweep), shown_(shown) {}

  bool ReportContext(const Context& context) override;
  void ReportRuns(const std::vector<Run>& report) override;
  void Finalize() override;

 private:
  Sweep& sweep_;
  benchmark::BenchmarkReporter* shown_;
};

/// One line a case: what varies between the cases, and means over instances.
std::string result_table(const std::vector<SweepEntry>& entries);

/// {"suite", "run", "database", "status", "cases": [...]}; means over nothing are null.
std::string result_json(const std::vector<SweepEntry>& entries, const std::string& suite,
                        const std::string& run, const std::string& database, bool finished);

}  // namespace sipplab::bench
