// The metrics that have a trend, and how a change of each is told.
#include <limits>

#include "db/trends.hpp"

namespace sipplab::db {

const std::vector<TrendMetric>& trend_metrics() {
  // Effects: what does not depend on the clock has no noise, so any change that a person would
  // notice counts; times of shared machines wander by a few per cent.
  constexpr double kTimeEffect = 0.05;
  constexpr double kWorkEffect = 0.005;
  constexpr double kRateEffect = 0.01;
  static const std::vector<TrendMetric> metrics = {
      {"success", "share of instances solved", "", true, false, true, kRateEffect, true},
      {"runtime", "median planning time", "s", false, true, true, kTimeEffect, false},
      {"mean-runtime", "mean planning time", "s", false, true, true, kTimeEffect, false},
      {"max-runtime", "longest planning time", "s", false, true, true, kTimeEffect, false},
      {"par2", "mean planning time, unsolved ones counted as twice the limit", "s", false, true, true,
       kTimeEffect, false},
      {"makespan", "mean makespan of solved instances", "s", false, false, true, kWorkEffect, false},
      {"flowtime", "mean flowtime of solved instances", "s", false, false, true, kWorkEffect, false},
      {"tries", "mean priority orders tried", "", false, false, true, kWorkEffect, false},
      {"expansions", "mean nodes expanded", "", false, false, true, kWorkEffect, false},
      {"generations", "mean nodes generated", "", false, false, true, kWorkEffect, false},
      {"property-cases", "cases that properties were tested on", "", true, false, false, kTimeEffect, false},
      {"property-failures", "share of property runs that did not pass", "", false, false, false, kRateEffect,
       true},
      {"fuzz-speed", "inputs per second of each fuzz target", "", true, true, false, kTimeEffect, false},
      {"fuzz-edges", "edges of the program that each fuzz target reached", "", true, false, false,
       kWorkEffect, false},
      {"benchmark-time", "wall clock of one iteration of imported benchmarks", "s", false, true, false,
       kTimeEffect, false},
      {"fuzz-coverage", "share of lines that fuzzing reached, by room", "", true, false, false, kRateEffect,
       true},
  };
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
