// Density curves of a run.
#include "bench/present/density.hpp"

#include <fmt/core.h>

#include <map>
#include <set>

#include "bench/present/numbers.hpp"
#include "bench/sweep/sweep_case.hpp"

namespace sipplab::bench {
namespace {

/// What stays the same within a picture.
std::string method_of(const db::CellSummary& cell) {
  const db::CaseInfo& of = cell.parameters;
  return fmt::format("{}, {}, {}, {}", of.environment, of.text("reschedule"), of.text("initial_order"),
                     of.planner);
}

std::string file_name(const std::string& kind, const std::string& method) {
  std::string name = kind + '-';
  for (const char c : method) {
    const bool plain = (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') || c == '-';
    if (plain) {
      name += c;
    } else if (name.back() != '-') {
      name += '-';
    }
  }
  return name;
}

using Curves = std::map<double, std::vector<std::pair<double, double>>>;  // by start-safe interval

Curves curves_of(const db::RunReport& run, const std::string& method, bool runtime) {
  // Several cases may differ in what no curve shows, such as seeds: their mean is drawn.
  std::map<double, std::map<double, std::pair<double, int>>> sums;
  for (const db::CellSummary& cell : run.cells) {
    if (method_of(cell) != method) continue;
    std::optional<double> value = runtime ? cell.median_planning_time_s : cell.success_rate;
    if (!value) continue;
    if (runtime) *value *= kMillisecondsPerSecond;
    auto& [sum, count] = sums[cell.parameters.real("ssi_s")][static_cast<double>(cell.parameters.robots)];
    sum += *value;
    ++count;
  }
  Curves curves;
  for (const auto& [ssi_s, points] : sums) {
    for (const auto& [robots, sum] : points) curves[ssi_s].emplace_back(robots, sum.first / sum.second);
  }
  return curves;
}

Chart chart_of(const db::RunReport& run, const std::optional<db::RunReport>& base, const std::string& method,
               bool runtime) {
  Chart chart;
  chart.title = method;
  chart.x_label = "robots";
  chart.y_label = runtime ? "median planning time [ms]" : "share of instances solved";
  chart.log_y = runtime;
  if (!runtime) {
    chart.y_min = 0;
    chart.y_max = 1;
  }
  const Curves curves = curves_of(run, method, runtime);
  const Curves before = base ? curves_of(*base, method, runtime) : Curves{};
  int colour = 0;
  for (const auto& [ssi_s, points] : curves) {
    ChartLine line;
    line.label = "ssi " + ssi_text(ssi_s);
    line.points = points;
    line.colour = colour;
    chart.lines.push_back(line);
    const auto old = before.find(ssi_s);
    if (old != before.end()) {
      line.label = line.label + ", base";
      line.points = old->second;
      line.dashed = true;
      chart.lines.push_back(std::move(line));
    }
    ++colour;
  }
  label_points(chart, kMostNumbersOfRobots);
  return chart;
}

}  // namespace

std::vector<DensityChart> density_charts(const db::RunReport& run, const std::optional<db::RunReport>& base) {
  std::vector<std::string> methods;  // in the order of the run
  std::set<std::string> seen;
  for (const db::CellSummary& cell : run.cells) {
    if (seen.insert(method_of(cell)).second) methods.push_back(method_of(cell));
  }
  std::vector<DensityChart> charts;
  std::set<std::string> taken;
  for (const std::string& method : methods) {
    // Methods may differ in what a file's name does not hold.
    std::string suffix;
    for (int copy = 2; !taken.insert(file_name("", method) + suffix).second; ++copy) {
      suffix = fmt::format("-{}", copy);
    }
    charts.push_back({file_name("success", method) + suffix, chart_of(run, base, method, false)});
    charts.push_back({file_name("runtime", method) + suffix, chart_of(run, base, method, true)});
  }
  return charts;
}

}  // namespace sipplab::bench
