#include "bench/present/runtime_chart.hpp"

#include <algorithm>
#include <array>
#include <map>
#include <set>
#include <string>

#include "bench/present/numbers.hpp"

namespace sipplab::bench {
namespace {

/// With more numbers of robots than this the axis is labelled at round numbers.
constexpr std::size_t kMostTicks = 10;
/// Digits of a run's UUID that tell runs apart.
constexpr std::size_t kShownUuid = 8;

/// What tells one line from another, most general first.
using LineName = std::array<std::string, 6>;

LineName name_of(const db::RunReport& run, const db::CellSummary& cell) {
  return {cell.environment,
          cell.planner,
          cell.reschedule,
          cell.order,
          "ssi " + ssi_text(cell.ssi_s),
          "run " + run.run.uuid.substr(0, kShownUuid)};
}

bool admits(const db::CaseFilter& filter, const db::CellSummary& cell) {
  const auto agrees = [](const auto& wanted, const auto& value) { return !wanted || *wanted == value; };
  return agrees(filter.environment, cell.environment) && agrees(filter.robots, cell.robots) &&
         agrees(filter.map, cell.parameters.map_spec) && agrees(filter.planner, cell.planner) &&
         std::all_of(filter.options.begin(), filter.options.end(), [&cell](const auto& wanted) {
           const auto option = cell.parameters.options.find(wanted.first);
           return option != cell.parameters.options.end() && option->second == wanted.second;
         });
}

/// The parts joined that `wanted` says, an entry for each part.
std::string joined(const LineName& name, const std::array<bool, std::tuple_size_v<LineName>>& wanted) {
  std::string text;
  for (std::size_t part = 0; part < name.size(); ++part) {
    if (wanted[part]) text += (text.empty() ? "" : ", ") + name[part];
  }
  return text;
}

}  // namespace

Chart runtime_chart(const std::vector<db::RunReport>& runs, const db::CaseFilter& filter) {
  // Cases that differ in what no line shows, such as seeds: the mean of their medians is drawn.
  std::map<LineName, std::map<double, std::vector<double>>> lines;
  std::set<double> robots;
  for (const db::RunReport& run : runs) {
    for (const db::CellSummary& cell : run.cells) {
      if (!admits(filter, cell) || !cell.median_planning_time_s) continue;
      const auto x = static_cast<double>(cell.robots);
      robots.insert(x);
      lines[name_of(run, cell)][x].push_back(*cell.median_planning_time_s * kMillisecondsPerSecond);
    }
  }
  const std::string omission = omission_note(lines.size());
  if (lines.size() > kMostChartLines) lines.erase(std::next(lines.begin(), kMostChartLines), lines.end());
  std::array<bool, std::tuple_size_v<LineName>> varies{};
  for (const auto& [name, points] : lines) {
    for (std::size_t part = 0; part < name.size(); ++part) {
      varies[part] = varies[part] || name[part] != lines.begin()->first[part];
    }
  }
  std::array<bool, std::tuple_size_v<LineName>> same{};
  std::transform(varies.begin(), varies.end(), same.begin(), [](bool part) { return !part; });

  Chart chart;
  chart.title = (lines.empty() ? "planning time" : joined(lines.begin()->first, same)) + omission;
  chart.x_label = "robots";
  chart.y_label = "median planning time [ms]";
  chart.log_y = true;
  for (const auto& [name, points] : lines) {
    ChartLine line;
    line.label = joined(name, varies);
    line.colour = static_cast<int>(chart.lines.size());
    for (const auto& [x, medians] : points) {
      double sum = 0;
      for (const double median : medians) sum += median;
      line.points.emplace_back(x, sum / static_cast<double>(medians.size()));
    }
    chart.lines.push_back(std::move(line));
  }
  if (robots.size() <= kMostTicks) {
    for (const double x : robots) chart.x_ticks.emplace_back(x, short_number(x));
  }
  return chart;
}

}  // namespace sipplab::bench
