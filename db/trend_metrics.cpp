// The metrics that have a trend. A new one is a row of make_metrics().
#include <fmt/core.h>

#include <limits>

#include "db/thresholds.hpp"
#include "db/trends.hpp"

namespace sipplab::db {

namespace {

/// A value for each commit, of all property runs of it.
std::string of_properties(std::string_view value) {
  return fmt::format(
      "SELECT 'all properties' AS context, commit_hash, commit_subject, committed_utc, ancestor_count, "
      "min(started_utc) AS started_utc, 0 AS dirty, '' AS binary_hash, {} AS value FROM v_property_runs "
      "WHERE mutant = '' AND excluded_reason IS NULL AND commit_hash IS NOT NULL GROUP BY commit_hash",
      value);
}

std::string of_fuzz_runs(std::string_view value) {
  return fmt::format(
      "SELECT target || ', ' || host AS context, v_fuzz_runs.commit_hash, v_fuzz_runs.commit_subject, "
      "commit_.committed_utc, v_fuzz_runs.ancestor_count, started_utc, dirty, target_hash AS binary_hash, "
      "{0} AS value FROM v_fuzz_runs LEFT JOIN commit_ ON commit_.hash = v_fuzz_runs.commit_hash "
      "WHERE {0} IS NOT NULL AND excluded_reason IS NULL",
      value);
}

constexpr const char* kCoverage =
    "SELECT room AS context, v_fuzz_coverage.commit_hash, commit_.subject AS commit_subject, "
    "commit_.committed_utc, v_fuzz_coverage.ancestor_count, started_utc, 0 AS dirty, '' AS binary_hash, "
    "share AS value FROM v_fuzz_coverage LEFT JOIN commit_ ON commit_.hash = v_fuzz_coverage.commit_hash";

constexpr const char* kBenchmarks =
    "SELECT benchmark || ', ' || program || ', ' || host || ifnull(' ' || build_type, '') AS context, "
    "v_measurements.commit_hash, commit_.subject AS commit_subject, commit_.committed_utc, "
    "v_measurements.ancestor_count, started_utc, 0 AS dirty, run AS binary_hash, real_time_ns / 1e9 AS value "
    "FROM v_measurements JOIN (SELECT run.uuid AS run_uuid, run.suite AS program, build.build_type "
    "  FROM run JOIN build ON build.id = run.build_id) ON run_uuid = v_measurements.run "
    "LEFT JOIN commit_ ON commit_.hash = v_measurements.commit_hash "
    "WHERE real_time_ns IS NOT NULL AND excluded_reason IS NULL";

std::vector<TrendMetric> make_metrics() {
  // Effects: what does not depend on the clock has no noise, so any change that a person would
  // notice counts; times of shared machines wander by a few per cent.
  constexpr double kTimeEffect = kUnpairedTimeFloor;
  constexpr double kWorkEffect = floor_of(MetricKind::kCounts);
  constexpr double kQualityEffect = floor_of(MetricKind::kQuality);
  constexpr double kRateEffect = floor_of(MetricKind::kSuccess);
  return {
      {"success", "share of instances solved", "", true, false, true, kRateEffect, true,
       "1.0 * solved / results"},
      {"runtime", "median planning time, unsolved ones counted as the longest", "s", false, true, true,
       kTimeEffect, false, "median_time_to_solve_s"},
      {"mean-runtime", "mean planning time, where all versions solve", "s", false, true, true, kTimeEffect,
       false, "mean_solved_time_s", "planning_time_ns / 1e9"},
      {"max-runtime", "longest planning time", "s", false, true, true, kTimeEffect, false,
       "max_planning_time_s"},
      {"par2", "mean planning time, unsolved ones counted as twice the limit", "s", false, true, true,
       kTimeEffect, false, "par2_time_s"},
      {"makespan", "mean makespan, where all versions solve", "s", false, false, true, kQualityEffect, false,
       "mean_makespan_s", "makespan_s"},
      {"flowtime", "mean flowtime, where all versions solve", "s", false, false, true, kQualityEffect, false,
       "mean_flowtime_s", "flowtime_s"},
      {"tries", "mean priority orders tried", "", false, false, true, kWorkEffect, false, "mean_tries"},
      {"expansions", "mean nodes expanded", "", false, false, true, kWorkEffect, false, "mean_expansions"},
      {"generations", "mean nodes generated", "", false, false, true, kWorkEffect, false, "mean_generations"},
      {"property-cases", "cases that properties were tested on", "", true, false, false, kTimeEffect, false,
       of_properties("sum(cases)")},
      {"property-failures", "share of property runs that did not pass", "", false, false, false, kRateEffect,
       true, of_properties("avg(status <> 'passed')")},
      {"fuzz-speed", "inputs per second of each fuzz target", "", true, true, false, kTimeEffect, false,
       of_fuzz_runs("executions_per_s")},
      {"fuzz-edges", "edges of the program that each fuzz target reached", "", true, false, false,
       kWorkEffect, false, of_fuzz_runs("edges")},
      {"benchmark-time", "wall clock of one iteration of imported benchmarks", "s", false, true, false,
       kTimeEffect, false, kBenchmarks},
      {"fuzz-coverage", "share of lines that fuzzing reached, by folder", "", true, false, false, kRateEffect,
       true, kCoverage},
  };
}

}  // namespace

const std::vector<TrendMetric>& trend_metrics() {
  static const std::vector<TrendMetric> metrics = make_metrics();
  return metrics;
}

const TrendMetric* find_trend_metric(std::string_view name) {
  for (const TrendMetric& metric : trend_metrics()) {
    if (metric.name == name) return &metric;
  }
  return nullptr;
}

double effect_of(const TrendChange& change, const TrendMetric& metric) {
  if (metric.rate) return change.after - change.before;
  if (change.before == change.after) return 0;
  if (change.before == 0) return std::numeric_limits<double>::infinity();
  return change.after / change.before - 1;
}

}  // namespace sipplab::db
