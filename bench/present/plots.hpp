// The pictures of a paper, from any runs: lines are what the cases of the runs differ in.
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "bench/present/chart.hpp"
#include "db/queries.hpp"
#include "db/trends.hpp"

namespace sipplab::bench {

/// Digits of a run's UUID that tell runs apart.
inline constexpr std::size_t kRunDigits = 8;

struct PlottedResult {
  std::int64_t case_id = 0;
  std::string instance;  ///< content, place and repetition: the same planning in another run has the same
  bool solved = false;
  double time_s = 0;  ///< wall clock of planning
  std::optional<double> flowtime_s;
  std::optional<double> makespan_s;
};

/// How a plan was improved: from elapsed_s on the gap is this.
struct PlottedStep {
  std::int64_t case_id = 0;
  std::string instance;
  double elapsed_s = 0;
  double flowtime_gap = 0;  ///< 0..1
};

struct PlottedRun {
  db::RunReport report;
  std::vector<PlottedResult> results;  ///< only if the picture needs them
  std::vector<PlottedStep> steps;      ///< by instance and time
};

struct PlotRequest {
  std::vector<PlottedRun> runs;
  db::CaseFilter filter;              ///< its id and map select nothing here
  std::vector<db::CaseFilter> sides;  ///< of a scatter plot, none or two: cases of the runs beside the filter
  std::vector<std::string> side_names;
  bool second_is_base =
      false;  ///< the second run is the base of the first: dashed, in the first one's colours
};

/// Reads a run, be it excluded or not, with its results or steps if they are asked for.
db::Result<PlottedRun> read_plotted_run(const std::filesystem::path& database, const std::string& run,
                                        bool with_results, bool with_steps);

/// "run 1a2b3c4d (density, 2026-01-31, 0123456789)": what a caption says of a run.
std::string run_words(const db::RunSummary& run);
/// Times on an axis of a chart, in seconds before, are in the unit in which the greatest reads best: its
/// name.
const char* in_one_unit(Chart& chart, bool of_x = false);
/// "20", "20 to 100".
std::string range_words(std::int64_t least, std::int64_t most);

/// Share solved over the number of robots, with 95 % intervals (Wilson).
Chart success_chart(const PlotRequest& request);
/// Median planning time of solved results over the number of robots; hollow where fewer than half are solved.
Chart runtime_chart(const PlotRequest& request);
/// How many results are solved within a time.
Chart cactus_chart(const PlotRequest& request);

enum class Measure { kRuntimes, kFlowtimes, kMakespans };
/// Box plots of solved results over the number of robots, dots of fewer than five; hollow where fewer than
/// half are solved.
Chart box_chart(const PlotRequest& request, Measure metric);
/// Mean gap over time, from when all results have a plan; a curve that has ended keeps its last value.
Chart improvement_chart(const PlotRequest& request);

/// One point for each planning that both sides did: those of the request, else two runs, else two planners,
/// re-schedulings, orders or start-safe intervals. Error: one line, if there are no two sides.
Expected<Chart, std::string> scatter_chart(const PlotRequest& request, Measure metric);

}  // namespace sipplab::bench
