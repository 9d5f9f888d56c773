// What the points of a chart say before anything is drawn.
#pragma once

#include <limits>

#include "bench/present/chart.hpp"

namespace sipplab::bench {

/// Whether a point has a place: logarithmic axes have none for zero.
bool is_drawn(const Chart& chart, const ChartPoint& point);

/// The span of values; empty at first.
struct ChartRange {
  double low = std::numeric_limits<double>::infinity();
  double high = -std::numeric_limits<double>::infinity();
  void add(double value) {
    low = std::min(low, value);
    high = std::max(high, value);
  }
};

/// Whether two lines have a point in common, to the eye; steps also where they go along each other.
bool coincide(const Chart& chart);

}  // namespace sipplab::bench
