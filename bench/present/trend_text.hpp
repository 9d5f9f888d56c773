// Trends as text with sparklines, as JSON and as a chart.
#pragma once

#include <cstddef>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "bench/present/chart.hpp"
#include "db/trends.hpp"

namespace sipplab::bench {

/// One block character for each value, or for the mean of neighbours if there are more
/// than `width`; all alike if nothing varies.
std::string sparkline(const std::vector<double>& values, std::size_t width);

/// One series: its newest `rows` points. Several: one line each. Changes below.
std::string trend_text(const db::TrendMetric& metric, const std::vector<db::TrendSeries>& series,
                       std::size_t rows);

nlohmann::ordered_json trend_json(const db::TrendMetric& metric, const std::vector<db::TrendSeries>& series);

/// x counts the versions of all series, by which it is labelled.
Chart trend_chart(const db::TrendMetric& metric, const std::vector<db::TrendSeries>& series);

/// The case in words, its instances if it has several sets of them, machine and build of times.
std::string series_name(const db::TrendSeries& series);

/// "1a2b3c4d5e", "1a2b3c4d5e+" with uncommitted changes, or "no commit".
std::string version_name(const db::TrendPoint& point);

/// "0.4 -> 0.98 (+58.0 points, better)".
std::string change_text(const db::TrendMetric& metric, const db::TrendChange& change);

}  // namespace sipplab::bench
