#include "bench/present/solvers_report.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <limits>
#include <map>
#include <variant>

#include "bench/present/plots.hpp"
#include "bench/present/template.hpp"
#include "db/queries.hpp"
#include "planner/io/text.hpp"

namespace sipplab::bench {
namespace {

/// Of each environment; the rest of the columns is as in v_results and v_retimed.
constexpr std::string_view kSolverQuery = R"sql(
SELECT result.environment AS environment, result.robots AS robots, result.planner AS planner,
  count(*) AS instances,
  sum(ifnull(retimed.given_valid, 0)) AS valid_as_given,
  sum(result.status = 'solved') AS solved,
  sum(ifnull(retimed.status = 'not_executable', 0)) AS not_executable,
  round(1.0 * sum(result.status = 'solved') / count(*), 3) AS success,
  round(avg(iif(result.status = 'solved', result.flowtime_s, NULL)), 2) AS flowtime_s,
  round(avg(iif(result.status = 'solved', result.makespan_s, NULL)), 2) AS makespan_s,
  round(avg(result.planning_time_s), 3) AS planning_s,
  round(avg(retimed.retime_s), 4) AS retime_s,
  max(result.peak_memory_bytes) / 1048576 AS peak_mib
FROM v_results AS result
LEFT JOIN v_retimed AS retimed ON retimed.run = result.run AND retimed.environment = result.environment
  AND retimed.robots = result.robots AND retimed.planner = result.planner AND retimed.instance = result.instance
  AND retimed.position = result.position AND retimed.repetition = result.repetition
WHERE result.run IN ({})
GROUP BY result.environment, result.robots, result.planner
ORDER BY result.environment, result.robots, result.planner)sql";

std::string cell_text(const db::Value& value) {
  if (const auto* text = std::get_if<std::string>(&value)) return *text;
  if (const auto* number = std::get_if<double>(&value)) return format_real(*number);
  if (const auto* count = std::get_if<std::int64_t>(&value)) return std::to_string(*count);
  return "";
}

double number_of(const db::Value& value) {
  if (const auto* number = std::get_if<double>(&value)) return *number;
  const auto* count = std::get_if<std::int64_t>(&value);
  return count ? static_cast<double>(*count) : 0;
}

std::size_t column_of(const db::Table& rows, std::string_view name) {
  return static_cast<std::size_t>(std::find(rows.columns.begin(), rows.columns.end(), name) -
                                  rows.columns.begin());
}

std::string table_html(const db::Table& rows) {
  std::string html = "<table><tr>";
  for (const std::string& column : rows.columns) html += "<th>" + xml_escaped(column) + "</th>";
  html += "</tr>\n";
  for (const std::vector<db::Value>& row : rows.rows) {
    html += "<tr>";
    for (const db::Value& value : row) html += "<td>" + xml_escaped(cell_text(value)) + "</td>";
    html += "</tr>\n";
  }
  return html + "</table>\n";
}

Chart chart_of(const db::Table& rows, const std::string& environment, std::string_view column,
               std::string title, std::string y_label, const std::string& source) {
  Chart chart;
  chart.caption = source;
  chart.title = std::move(title);
  chart.x_label = "robots";
  chart.y_label = std::move(y_label);
  std::map<std::string, ChartLine> lines;
  std::pair<std::int64_t, std::int64_t> counts{std::numeric_limits<std::int64_t>::max(), 0};
  for (const std::vector<db::Value>& row : rows.rows) {
    if (cell_text(row[0]) != environment) continue;
    const std::string planner = cell_text(row[2]);
    ChartLine& line = lines[planner];
    line.label = planner;
    line.points.push_back({number_of(row[1]), number_of(row[column_of(rows, column)])});
    const auto instances = static_cast<std::int64_t>(number_of(row[column_of(rows, "instances")]));
    counts = {std::min(counts.first, instances), std::max(counts.second, instances)};
  }
  if (counts.second > 0)
    chart.caption += fmt::format("; n = {} instances a point", range_words(counts.first, counts.second));
  for (auto& [planner, line] : lines) {
    line.colour = static_cast<int>(chart.lines.size() % kMostChartLines);
    line.dashed = chart.lines.size() >= kMostChartLines;
    chart.lines.push_back(std::move(line));
  }
  label_points(chart, kMostNumbersOfRobots);
  return chart;
}

}  // namespace

db::Result<db::Table> solver_rows(const std::filesystem::path& database,
                                  const std::vector<std::string>& runs) {
  std::string list;
  for (const std::string& run : runs) list += (list.empty() ? "'" : ", '") + run + "'";
  return db::run_sql(database, fmt::format(fmt::runtime(kSolverQuery), list), {});
}

std::vector<std::pair<std::string, Chart>> solver_charts(const db::Table& rows, const std::string& source) {
  std::vector<std::pair<std::string, Chart>> charts;
  std::vector<std::string> environments;
  for (const std::vector<db::Value>& row : rows.rows) {
    const std::string environment = cell_text(row[0]);
    if (environments.empty() || environments.back() != environment) environments.push_back(environment);
  }
  for (const std::string& environment : environments) {
    std::string name = environment;
    std::replace(name.begin(), name.end(), '/', '-');
    Chart success = chart_of(rows, environment, "success", environment + ", re-timed",
                             "share of instances solved", source);
    success.y_min = 0;
    success.y_max = 1;
    charts.emplace_back("success-" + name, std::move(success));
    Chart seconds = chart_of(rows, environment, "planning_s", environment, "mean planning time [s]", source);
    charts.emplace_back("seconds-" + name, std::move(seconds));
  }
  return charts;
}

Expected<std::string, std::string> solvers_page(const db::Table& rows, const std::string& source) {
  std::string places;
  std::vector<Chart> charts;
  for (auto& [name, chart] : solver_charts(rows, source)) {
    places += picture_place(charts.size());
    charts.push_back(std::move(chart));
  }
  return with_pictures(
      filled_page("solvers", "Planners side by side",
                  {{"source", xml_escaped(source)}, {"charts", places}, {"table", table_html(rows)}}),
      charts);
}

}  // namespace sipplab::bench
