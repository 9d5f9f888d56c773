#include "bench/present/paper_report.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <set>
#include <tuple>

#include "bench/present/html_table.hpp"
#include "bench/present/numbers.hpp"
#include "bench/present/plots.hpp"
#include "bench/present/template.hpp"
#include "db/aligned.hpp"
#include "planner/io/text.hpp"

namespace sipplab::bench {
namespace {

/// A table in words, for both forms.
struct Words {
  std::vector<std::string> columns;
  std::vector<std::vector<std::string>> rows;
};

std::string cost_words(const std::optional<double>& measured, double error,
                       const std::optional<double>& paper, Standing standing) {
  if (!measured) return paper ? fmt::format("- (paper {:.2f})", *paper) : "-";
  const std::string ours = std::isfinite(error) ? fmt::format("{:.2f} +-{:.2f}", *measured, error)
                                                : fmt::format("{:.2f}", *measured);
  return paper ? fmt::format("{} ({:.2f}) {}", ours, *paper, name(standing)) : ours;
}

std::string success_words(const TableLine& line) {
  const db::statistics::ConfidenceInterval interval = line.measured->success_interval();
  return fmt::format("{:.3f} [{:.3f}, {:.3f}] ({:.2f}) {}", line.measured->success(), interval.low,
                     interval.high, line.paper.success, name(line.success));
}

Words table_words(const std::vector<MeasuredCell>& cells) {
  Words words{{"robots", "re-scheduling", "runs", "success", "seconds", "makespan [s]", "flowtime [s]"}, {}};
  for (const TableLine& line : compare_with_table(cells)) {
    std::vector<std::string> row = {std::to_string(line.paper.robots), line.paper.reschedule};
    if (!line.measured) {
      row.insert(row.end(), {"0", "not measured", "", "", ""});
    } else {
      const MeasuredCell& cell = *line.measured;
      row.insert(
          row.end(),
          {std::to_string(cell.runs), success_words(line),
           fmt::format("{:.4f}{}", cell.mean_seconds,
                       line.paper.seconds ? fmt::format(" ({:.2f})", *line.paper.seconds) : ""),
           cost_words(cell.mean_makespan_s, cell.makespan_error_s, line.paper.makespan_s, line.makespan),
           cost_words(cell.mean_flowtime_s, cell.flowtime_error_s, line.paper.flowtime_s, line.flowtime)});
    }
    words.rows.push_back(std::move(row));
  }
  return words;
}

Words claim_words(const std::vector<MeasuredCell>& cells) {
  Words words{{"claim", "", "sentence", "figures"}, {}};
  for (const Claim& claim : check_claims(cells)) {
    const char* verdict = !claim.holds ? "not measured" : *claim.holds ? "holds" : "FAILS";
    words.rows.push_back({claim.id, verdict, claim.sentence, claim.figures});
  }
  return words;
}

/// Success of Figure 1, a row for each number of robots.
Words figure_words(const std::vector<MeasuredCell>& cells) {
  std::set<double> intervals;
  std::map<std::int64_t, std::map<double, double>> rates;
  for (const MeasuredCell& cell : cells) {
    if (cell.environment != "empty" || cell.reschedule != "none" || cell.order != "shortest") continue;
    intervals.insert(cell.ssi_s);
    rates[cell.robots][cell.ssi_s] = cell.success();
  }
  Words words{{"robots"}, {}};
  for (const double ssi_s : intervals) words.columns.push_back("ssi " + ssi_text(ssi_s));
  for (const auto& [robots, by_interval] : rates) {
    std::vector<std::string> row = {std::to_string(robots)};
    for (const double ssi_s : intervals) {
      const auto rate = by_interval.find(ssi_s);
      row.push_back(rate == by_interval.end() ? "" : fmt::format("{:.2f}", rate->second));
    }
    words.rows.push_back(std::move(row));
  }
  return words;
}

/// Characters of a cell that stays on one line.
constexpr std::size_t kLongestUnwrapped = 60;

std::string html_table(const Words& words) {
  std::vector<std::vector<HtmlCell>> rows;
  std::string kinds(words.columns.size(), 't');
  for (const auto& row : words.rows) {
    std::vector<HtmlCell>& cells = rows.emplace_back();
    for (std::size_t i = 0; i < row.size(); ++i) {
      const std::string& cell = row[i];
      const bool good = cell.ends_with(" reproduced") || cell.ends_with(" better") || cell == "holds";
      const bool bad = cell.ends_with(" differs") || cell == "FAILS";
      if (cell.size() > kLongestUnwrapped && !good && !bad) kinds[i] = 'w';
      cells.push_back({cell, bad ? "bad" : good ? "good" : ""});
    }
  }
  return html_table(words.columns, rows, kinds);
}

constexpr const char* kLegend =
    "In brackets: the paper. Success with its 95 % interval, makespan and flowtime over solved runs with "
    "that of "
    "their mean; seeds of one instance go together in both. Costs and claims of fewer than five instances "
    "are not judged. "
    "Seconds are of another machine there and judge nothing.";

/// "; n = 100 results a point".
std::string count_words(const std::pair<std::int64_t, std::int64_t>& counts) {
  return counts.second == 0
             ? ""
             : fmt::format("; n = {} results a point", range_words(counts.first, counts.second));
}

/// Points in order, and a label for each number of robots.
void finish(Chart& chart) {
  for (ChartLine& line : chart.lines)
    std::sort(line.points.begin(), line.points.end(), [](const ChartPoint& a, const ChartPoint& b) {
      return std::tie(a.x, a.y) < std::tie(b.x, b.y);
    });
  label_points(chart);
}

}  // namespace

std::string reproduction_text(const std::vector<MeasuredCell>& cells) {
  const auto table = [](const char* title, const Words& words) {
    return fmt::format("{}\n\n{}\n", title,
                       db::align(words.columns, words.rows, std::vector<bool>(words.columns.size(), false)));
  };
  return table("Figure 1: share solved, empty map, no re-scheduling", figure_words(cells)) +
         table("Table 1: warehouse, start-safe interval 5, shortest first", table_words(cells)) + kLegend +
         "\n\n" + table("What the paper says", claim_words(cells));
}

nlohmann::ordered_json reproduction_json(const std::vector<MeasuredCell>& cells, const std::string& run) {
  using Json = nlohmann::ordered_json;
  const auto number = [](const std::optional<double>& value) {
    return value && std::isfinite(*value) ? Json(*value) : Json(nullptr);
  };
  const auto measured = [&number](const MeasuredCell& cell) {
    const db::statistics::ConfidenceInterval interval = cell.success_interval();
    const bool some = cell.solved > 0;
    return Json{{"environment", cell.environment},
                {"robots", cell.robots},
                {"ssi", std::isfinite(cell.ssi_s) ? Json(cell.ssi_s) : Json("inf")},
                {"reschedule", cell.reschedule},
                {"order", cell.order},
                {"planner", cell.method},
                {"runs", cell.runs},
                {"solved", cell.solved},
                {"success", cell.success()},
                {"success_interval", {interval.low, interval.high}},
                {"seconds", cell.mean_seconds},
                {"makespan", number(cell.mean_makespan_s)},
                {"makespan_error", some ? number(cell.makespan_error_s) : Json(nullptr)},
                {"flowtime", number(cell.mean_flowtime_s)},
                {"flowtime_error", some ? number(cell.flowtime_error_s) : Json(nullptr)}};
  };
  Json json{{"run", run}, {"reproduced", is_reproduced(cells)}};
  json["cells"] = Json::array();
  for (const MeasuredCell& cell : cells) json["cells"].push_back(measured(cell));
  json["table1"] = Json::array();
  for (const TableLine& line : compare_with_table(cells)) {
    json["table1"].push_back({{"robots", line.paper.robots},
                              {"reschedule", line.paper.reschedule},
                              {"paper",
                               {{"success", line.paper.success},
                                {"seconds", number(line.paper.seconds)},
                                {"makespan", number(line.paper.makespan_s)},
                                {"flowtime", number(line.paper.flowtime_s)}}},
                              {"measured", line.measured ? measured(*line.measured) : Json(nullptr)},
                              {"success", name(line.success)},
                              {"makespan", name(line.makespan)},
                              {"flowtime", name(line.flowtime)}});
  }
  json["claims"] = Json::array();
  for (const Claim& claim : check_claims(cells)) {
    json["claims"].push_back({{"id", claim.id},
                              {"sentence", claim.sentence},
                              {"holds", claim.holds ? Json(*claim.holds) : Json(nullptr)},
                              {"figures", claim.figures}});
  }
  return json;
}

Chart figure_chart(const std::vector<MeasuredCell>& cells, const std::string& source) {
  Chart chart;
  std::pair<std::int64_t, std::int64_t> counts{std::numeric_limits<std::int64_t>::max(), 0};
  chart.title = "empty 32 x 32, no re-scheduling";
  chart.x_label = "robots";
  chart.y_label = "share of instances solved";
  chart.y_min = 0;
  chart.y_max = 1;
  std::map<double, ChartLine> lines;
  for (const MeasuredCell& cell : cells) {
    if (cell.environment != "empty" || cell.reschedule != "none" || cell.order != "shortest") continue;
    const db::statistics::ConfidenceInterval interval = cell.success_interval();
    lines[cell.ssi_s].points.push_back(
        {static_cast<double>(cell.robots), cell.success(), false, std::pair{interval.low, interval.high}});
    counts = {std::min(counts.first, cell.runs), std::max(counts.second, cell.runs)};
  }
  chart.caption = source + count_words(counts) + ", bars: 95 % (Wilson)";
  int colour = 0;
  for (auto& [ssi_s, line] : lines) {
    line.label = "ssi " + ssi_text(ssi_s);
    line.colour = colour++;
    chart.lines.push_back(std::move(line));
  }
  finish(chart);
  return chart;
}

Chart table_chart(const std::vector<MeasuredCell>& cells, const std::string& source) {
  Chart chart;
  std::pair<std::int64_t, std::int64_t> counts{std::numeric_limits<std::int64_t>::max(), 0};
  chart.title = "warehouse, start-safe interval 5";
  chart.x_label = "robots";
  chart.y_label = "mean planning time [s]";
  chart.log_y = true;
  std::map<std::string, ChartLine> lines;
  const auto add = [&lines](const std::string& label, double count, double seconds) {
    if (seconds > 0) lines[label].points.push_back({count, seconds, false, std::nullopt});
  };
  for (const MeasuredCell& cell : cells) {
    constexpr double kTableSsiS = 5;
    if (cell.environment != "warehouse" || cell.ssi_s != kTableSsiS) continue;
    add(cell.reschedule + ", " + cell.order, static_cast<double>(cell.robots), cell.mean_seconds);
    counts = {std::min(counts.first, cell.runs), std::max(counts.second, cell.runs)};
  }
  chart.caption = source + count_words(counts) + "; dashed: the paper's, of another machine";
  for (const PaperRow& paper : paper_table()) {
    const std::string label = std::string(paper.reschedule) + ", shortest";
    if (lines.count(label) != 0 && paper.seconds) {
      add(label + ", paper", static_cast<double>(paper.robots), *paper.seconds);
    }
  }
  int colour = -1;
  for (auto& [label, line] : lines) {
    line.label = label;
    line.dashed = label.ends_with(", paper");
    if (!line.dashed) ++colour;  // the paper's line comes right behind ours and shares its colour
    line.colour = colour;
    chart.lines.push_back(std::move(line));
  }
  finish(chart);
  return chart;
}

Expected<std::string, std::string> reproduction_page(const std::vector<MeasuredCell>& cells,
                                                     const std::string& source,
                                                     const std::vector<Chart>& charts) {
  return with_pictures(filled_page("reproduction", "AAMAS 2018, reproduced",
                                   {{"source", xml_escaped(source)},
                                    {"claims", html_table(claim_words(cells))},
                                    {"figure", picture_place(0)},
                                    {"figure_table", html_table(figure_words(cells))},
                                    {"table_chart", picture_place(1)},
                                    {"table", html_table(table_words(cells))},
                                    {"legend", kLegend}}),
                       charts);
}

bool is_reproduced(const std::vector<MeasuredCell>& cells) {
  for (const TableLine& line : compare_with_table(cells)) {
    for (const Standing standing : {line.success, line.makespan, line.flowtime}) {
      if (standing == Standing::kDiffers) return false;
    }
  }
  const std::vector<Claim> claims = check_claims(cells);
  return std::all_of(claims.begin(), claims.end(),
                     [](const Claim& claim) { return claim.holds.value_or(true); });
}

}  // namespace sipplab::bench
