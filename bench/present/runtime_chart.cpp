#include "bench/present/runtime_chart.hpp"

#include <algorithm>
#include <array>
#include <map>
#include <string>

#include "bench/present/numbers.hpp"

namespace sipplab::bench {
namespace {

/// Digits of a run's UUID that tell runs apart.
constexpr std::size_t kShownUuid = 8;

/// What tells one line from another, most general first.
using LineName = std::array<std::string, 6>;

LineName name_of(const db::RunReport& run, const db::CellSummary& cell) {
  const db::CaseInfo& of = cell.parameters;
  return {of.environment,
          of.planner,
          of.text("reschedule"),
          of.text("initial_order"),
          "ssi " + ssi_text(of.real("ssi_s")),
          "run " + run.run.uuid.substr(0, kShownUuid)};
}

bool admits(const db::CaseFilter& filter, const db::CaseInfo& of) {
  const auto agrees = [](const auto& wanted, const auto& value) { return !wanted || *wanted == value; };
  return agrees(filter.environment, of.environment) && agrees(filter.robots, of.robots) &&
         agrees(filter.map, of.map_spec) && agrees(filter.planner, of.planner) &&
         std::all_of(filter.options.begin(), filter.options.end(),
                     [&of](const auto& wanted) { return of.option(wanted.first) == wanted.second; });
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
  for (const db::RunReport& run : runs) {
    for (const db::CellSummary& cell : run.cells) {
      if (!admits(filter, cell.parameters) || !cell.median_planning_time_s) continue;
      lines[name_of(run, cell)][static_cast<double>(cell.parameters.robots)].push_back(
          *cell.median_planning_time_s * kMillisecondsPerSecond);
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
  label_points(chart, kMostNumbersOfRobots);
  return chart;
}

}  // namespace sipplab::bench
