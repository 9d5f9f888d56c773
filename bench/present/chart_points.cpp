#include "bench/present/chart_points.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <set>
#include <vector>

#include "bench/present/numbers.hpp"

namespace sipplab::bench {

bool is_drawn(const Chart& chart, const ChartPoint& point) {
  return !(chart.log_y && point.y <= 0) && !(chart.log_x && point.x <= 0) && std::isfinite(point.y);
}

bool coincide(const Chart& chart) {
  constexpr double kToTheEye = 0.004;
  ChartRange y;
  for (const ChartLine& line : chart.lines) {
    for (const ChartPoint& point : line.points) y.add(point.y);
  }
  std::map<long, std::vector<ChartRange>> places;  // height, and what lies there of the lines before
  for (const ChartLine& line : chart.lines) {
    std::vector<std::pair<long, ChartRange>> own;
    for (std::size_t i = 0; i < line.points.size(); ++i) {
      const ChartPoint& point = line.points[i];
      const double share = y.high > y.low ? (point.y - y.low) / (y.high - y.low) : 0;
      const bool goes_on = line.style == LineStyle::kSteps && i + 1 < line.points.size();
      own.push_back({std::lround(share / kToTheEye), {point.x, goes_on ? line.points[i + 1].x : point.x}});
    }
    for (const auto& [height, part] : own) {
      for (const ChartRange& other : places[height]) {
        if (part.low <= other.high && other.low <= part.high) return true;
      }
    }
    for (const auto& [height, part] : own) places[height].push_back(part);
  }
  return false;
}

void label_points(Chart& chart, std::size_t most) {
  std::set<double> values;
  for (const ChartLine& line : chart.lines) {
    for (const ChartPoint& point : line.points) values.insert(point.x);
  }
  if (values.size() > most) return;
  for (const double x : values) chart.x_ticks.emplace_back(x, short_number(x));
}

bool is_empty(const Chart& chart) {
  return std::all_of(chart.lines.begin(), chart.lines.end(), [&chart](const ChartLine& line) {
    return std::none_of(line.points.begin(), line.points.end(),
                        [&chart](const ChartPoint& point) { return is_drawn(chart, point); });
  });
}

}  // namespace sipplab::bench
