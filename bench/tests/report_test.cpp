// Reports: what is drawn and written for people.
#include <gtest/gtest.h>

#include <limits>

#include "bench/present/density.hpp"
#include "bench/present/html_table.hpp"
#include "bench/present/numbers.hpp"
#include "bench/present/plots.hpp"
#include "bench/present/trend_text.hpp"
#include "bench/tests/chart_support.hpp"

namespace sipplab::bench {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();

TEST(Numbers, are_as_long_as_a_person_reads) {
  EXPECT_EQ(short_number(0.857142857), "0.8571");
  EXPECT_EQ(short_number(123456), "123456");
  EXPECT_EQ(short_number(kInfinity), "inf");
  EXPECT_EQ(with_unit(0.00021, "s"), "210 us");
  EXPECT_EQ(with_unit(0.5, "s"), "500 ms");
  EXPECT_EQ(with_unit(-12, "s"), "-12 s");
  EXPECT_EQ(with_unit(3, ""), "3");
  EXPECT_EQ(signed_share(0.031, false), "+3.1 %");
  EXPECT_EQ(signed_share(-0.2, true), "-20.0 points");
  EXPECT_EQ(signed_share(kInfinity, false), "from 0");
  EXPECT_EQ(ssi_text(2.5), "2.5");
  EXPECT_EQ(ssi_text(kInfinity), "inf");
}

TEST(Sparkline, shows_low_and_high) {
  EXPECT_EQ(sparkline({}, 10), "");
  EXPECT_EQ(sparkline({3}, 10), sparkline({7}, 10)) << "one value has no shape";
  EXPECT_EQ(sparkline({1, 2, 1}, 10), "▁█▁");
  EXPECT_EQ(sparkline({1, 1, 1, 1, 5, 5, 5, 5}, 2), "▁█") << "neighbours are put together";
}

TEST(HtmlTables, escape_texts_and_say_kinds_and_styles) {
  EXPECT_EQ(
      html_table({"a<b", "n"}, {{{"<i>", "bad"}, {"1"}}}, "wn"),
      "<div class=\"scroll\"><table><thead><tr><th>a&lt;b</th><th class=\"n\">n</th></tr></thead><tbody>\n"
      "<tr><td class=\"wrap bad\">&lt;i&gt;</td><td class=\"n\">1</td></tr>\n"
      "</tbody></table></div>\n");
}

db::CellSummary measured_cell(const std::string& environment, std::int64_t robots, double median_s,
                              std::int64_t solved = 10) {
  db::CellSummary cell;
  cell.parameters.environment = environment;
  cell.parameters.robots = robots;
  cell.parameters.options["ssi_s"] = 5.0;
  cell.parameters.options["reschedule"] = "none";
  cell.parameters.options["initial_order"] = "fifo";
  cell.parameters.planner = "sipplab";
  cell.results = 10;
  cell.solved = solved;
  cell.success_rate = static_cast<double>(solved) / 10;
  cell.median_planning_time_s = 1e-9;  // of failures, which must not show
  if (solved > 0) cell.median_solved_time_s = median_s;
  return cell;
}

TEST(DensityCharts, have_a_line_for_each_interval_and_dash_the_base) {
  db::RunReport run;
  for (const double ssi_s : {0.0, 10.0, 3.0, kInfinity}) {
    for (const std::int64_t robots : {16, 32}) {
      run.cells.push_back(measured_cell("ware/house", robots, 0.01, 5));
      run.cells.back().parameters.options["ssi_s"] = ssi_s;
    }
  }
  const auto charts = density_charts(run, run);
  ASSERT_EQ(charts.size(), 2U);
  EXPECT_EQ(charts[0].name, "success-ware-house-none-fifo-sipplab");
  EXPECT_EQ(charts[1].name, "runtime-ware-house-none-fifo-sipplab");
  run.cells.push_back(run.cells.front());
  run.cells.back().parameters.environment = "ware=house";
  EXPECT_EQ(density_charts(run, run)[3].name, "runtime-ware-house-none-fifo-sipplab-2");
  const auto& lines = charts[0].chart.lines;
  ASSERT_EQ(lines.size(), 8U);
  EXPECT_EQ(lines[2].label, "ssi 3") << "by number, not by letter";
  EXPECT_EQ(lines[3].label, "ssi 3, base");
  EXPECT_TRUE(lines[3].dashed);
  EXPECT_FALSE(lines[2].dashed);
  EXPECT_EQ(lines[3].colour, lines[2].colour);
  EXPECT_NE(lines[4].colour, lines[2].colour);
  EXPECT_EQ(charts[1].chart.lines[0].points[0].y, 10) << "milliseconds";
  EXPECT_NE(charts[1].chart.y_label.find("[ms]"), std::string::npos);
}

TEST(TrendText, tells_versions_changes_and_sizes) {
  db::TrendSeries series;
  series.case_id = 7;
  series.label = "warehouse";
  for (int i = 0; i < 4; ++i) {
    db::TrendPoint point;
    point.commit = std::string(40, static_cast<char>('a' + i));
    point.subject = "Change\tone";
    point.runs = 1;
    point.value = i < 2 ? 1 : 0.5;
    series.points.push_back(point);
  }
  series.changes.push_back({2, 1, 0.5, 0.001});
  const db::TrendMetric& metric = *db::find_trend_metric("success");
  const std::string text = trend_text(metric, {series}, 2);
  EXPECT_NE(text.find("██▁▁"), std::string::npos) << text;
  EXPECT_NE(text.find("(2 older versions"), std::string::npos) << text;
  EXPECT_NE(text.find("  cccccccccc  Change\\tone\n    1 -> 0.5 (-50.0 points, worse)"), std::string::npos)
      << text;
  const auto json = trend_json(metric, {series});
  EXPECT_EQ(json["series"][0]["changes"][0]["effect"], -0.5);
  EXPECT_EQ(json["series"][0]["points"].size(), 4U);
}

TEST(TrendText, says_over_which_plannings_a_mean_of_solved_ones_is) {
  db::TrendSeries series;
  series.label = "warehouse";
  series.plannings = 10;
  series.solved_by_all = 7;
  for (const double share : {1.0, 0.7}) {
    db::TrendPoint point;
    point.value = 3;
    point.solved_share = share;
    series.points.push_back(point);
  }
  const db::TrendMetric& metric = *db::find_trend_metric("flowtime");
  std::string text = trend_text(metric, {series}, 2);
  EXPECT_NE(text.find("2 versions; over the 7 of 10 plannings that all solved\n\n"), std::string::npos)
      << text;
  EXPECT_NE(text.find("flowtime  solved  runs"), std::string::npos) << text;
  EXPECT_NE(text.find("0.7"), std::string::npos) << text;
  EXPECT_EQ(trend_json(metric, {series})["series"][0]["solved_by_all"], 7);
  EXPECT_EQ(trend_json(metric, {series})["series"][0]["points"][1]["solved_share"], 0.7);
  text = trend_text(metric, {series, series}, 2);
  EXPECT_NE(text.find("7 of 10"), std::string::npos) << text;
  series.solved_by_all = 0;
  for (const auto& shown : {std::vector{series}, {series, series}}) {
    text = trend_text(metric, shown, 2);
    EXPECT_NE(text.find("each value is of other plannings"), std::string::npos) << text;
  }
}

TEST(TrendChart, puts_each_series_where_its_versions_are) {
  const auto series_of = [](int first, int last) {
    db::TrendSeries series;
    series.case_id = first;
    series.label = "warehouse";
    for (int i = first; i <= last; ++i) {
      db::TrendPoint point;
      point.commit = std::string(40, static_cast<char>('a' + i));
      point.ancestor_count = i;
      point.started_utc = std::to_string(first);  // each case was first measured at a time of its own
      point.value = i;
      series.points.push_back(point);
    }
    return series;
  };
  db::TrendSeries late = series_of(5, 8);
  late.changes.push_back({2, 6, 7, 0.001});
  const Chart chart = trend_chart(*db::find_trend_metric("success"), {series_of(1, 8), late});
  ASSERT_EQ(chart.lines.size(), 2U);
  EXPECT_EQ(chart.lines[0].points.back().x, 7);
  ASSERT_EQ(chart.lines[1].points.size(), 4U);
  EXPECT_EQ(chart.lines[1].points.front().x, 4);
  EXPECT_EQ(chart.lines[1].points.back().x, 7);
  ASSERT_EQ(chart.lines[1].marks.size(), 1U);
  EXPECT_EQ(chart.x_ticks.back().first, 7);
  EXPECT_EQ(chart.x_ticks.back().second, "iiiiiiiiii");
  EXPECT_EQ(chart.lines[1].label, "case 5: warehouse") << "what the case is";
  EXPECT_NE(chart.caption.find("dotted: the level changed"), std::string::npos);
  const std::vector<db::TrendSeries> many(9, series_of(1, 3));
  EXPECT_NE(trend_chart(*db::find_trend_metric("success"), many).title.find("first 7 of 9 lines"),
            std::string::npos);
}

TEST(Plots, draw_as_many_lines_as_there_are_colours) {
  PlotRequest request;
  PlottedRun& run = request.runs.emplace_back();
  for (int ssi_s = 0; ssi_s < 9; ++ssi_s) {
    run.report.cells.push_back(measured_cell("empty", 8, 0.01));
    run.report.cells.back().parameters.options["ssi_s"] = 1.0 * ssi_s;
  }
  const Chart chart = runtime_chart(request);
  EXPECT_EQ(chart.lines.size(), kMostChartLines);
  EXPECT_NE(chart.title.find("first 7 of 9"), std::string::npos) << chart.title;

  run.report.cells.back().parameters.environment = "warehouse";
  EXPECT_EQ(runtime_chart(request).lines[0].label, "ssi 0") << "what tells apart those that are drawn";
}

TEST(Plots, name_lines_by_what_tells_them_apart_and_the_runs_in_the_caption) {
  PlotRequest request;
  request.runs.resize(2);
  db::RunReport& ours = request.runs[0].report;
  db::RunReport& theirs = request.runs[1].report;
  ours.run.uuid = "11111111-rest";
  ours.run.suite = "density";
  ours.cells = {measured_cell("empty", 32, 0.002), measured_cell("empty", 16, 0.001),
                measured_cell("warehouse", 16, 0.004)};
  theirs.run.uuid = "22222222-rest";
  theirs.cells = {measured_cell("empty", 16, 0.5), measured_cell("empty", 16, 0.7)};
  theirs.cells[0].parameters.planner = theirs.cells[1].parameters.planner = "cmd:other";

  request.filter.environment = "empty";
  const Chart chart = runtime_chart(request);
  ASSERT_EQ(chart.lines.size(), 2U);
  EXPECT_EQ(chart.title, "empty, none, fifo, ssi 5") << "what all lines share";
  EXPECT_EQ(chart.caption.find("run 11111111 (density), run 22222222 ()"), 0U) << chart.caption;
  EXPECT_NE(chart.caption.find("n = 10 to 20 results a point"), std::string::npos) << chart.caption;
  EXPECT_EQ(chart.lines[0].label, "cmd:other, run 22222222");
  ASSERT_EQ(chart.lines[0].points.size(), 1U) << "cases that differ in nothing shown are one point";
  EXPECT_DOUBLE_EQ(chart.lines[0].points[0].y, 600);
  EXPECT_EQ(chart.lines[1].label, "sipplab, run 11111111");
  ASSERT_EQ(chart.lines[1].points.size(), 2U);
  EXPECT_EQ(chart.lines[1].points[0].x, 16);
  EXPECT_EQ(chart.lines[1].points[1].y, 2);

  request.filter = {};
  EXPECT_EQ(runtime_chart(request).lines.size(), 3U);
  EXPECT_TRUE(runtime_chart({}).lines.empty());
}

TEST(Plots, failures_are_never_fast) {
  PlotRequest request;
  request.runs.resize(1);
  request.runs[0].report.cells = {measured_cell("empty", 16, 0.002), measured_cell("empty", 32, 0.004, 4),
                                  measured_cell("empty", 64, 0, 0)};
  const Chart chart = runtime_chart(request);
  ASSERT_EQ(chart.lines[0].points.size(), 2U) << "where nothing is solved there is no time";
  EXPECT_FALSE(chart.lines[0].points[0].hollow);
  EXPECT_TRUE(chart.lines[0].points[1].hollow);
  EXPECT_NE(chart.caption.find("; hollow: fewer than half"), std::string::npos);
  const Chart success = success_chart(request);
  request.runs.push_back(request.runs[0]);
  request.second_is_base = true;
  EXPECT_NE(runtime_chart(request).caption.find("; hollow on a full line: fewer than half"),
            std::string::npos)
      << "points of the base are hollow, too";
  ASSERT_EQ(success.lines[0].points.size(), 3U);
  EXPECT_EQ(success.lines[0].points[2].y, 0);
  EXPECT_NEAR(success.lines[0].points[2].interval->second, 0.2775, 1e-4);  // Wilson, 0 of 10
}

/// Two re-schedulings of ten instances: the second solves one more, and takes twice as long.
PlotRequest two_sides() {
  PlotRequest request;
  PlottedRun& run = request.runs.emplace_back();
  run.report.run.uuid = "11111111-rest";
  for (const std::int64_t side : {1, 2}) {
    run.report.cells.push_back(measured_cell("empty", 16, 0.01, side == 1 ? 4 : 5));
    run.report.cells.back().case_id = side;
    run.report.cells.back().parameters.options["reschedule"] = side == 1 ? "none" : "random";
    for (int i = 0; i < 10; ++i) {
      const bool solved = i < 3 + side;
      run.results.push_back({side, "i" + std::to_string(i), solved,
                             0.001 * static_cast<double>(side * (i + 1)),
                             solved ? std::optional(100.0 + i) : std::nullopt,
                             solved ? std::optional(10.0 + i) : std::nullopt});
    }
  }
  return request;
}

TEST(Plots, count_what_is_solved_within_a_time) {
  const Chart chart = cactus_chart(two_sides());
  ASSERT_EQ(chart.lines.size(), 2U);
  EXPECT_EQ(chart.lines[0].label, "none: 4 of 10");
  EXPECT_EQ(chart.lines[1].label, "random: 5 of 10");
  ASSERT_EQ(chart.lines[1].points.size(), 5U);
  EXPECT_DOUBLE_EQ(chart.lines[1].points[4].x, 10) << "milliseconds";
  EXPECT_EQ(chart.lines[1].points[4].y, 5);
}

TEST(Plots, draw_boxes_of_solved_results) {
  const Chart chart = box_chart(two_sides(), Measure::kFlowtimes);
  ASSERT_EQ(chart.lines.size(), 2U);
  ASSERT_EQ(chart.lines[0].points.size(), 4U);
  EXPECT_TRUE(chart.lines[0].points[0].hollow) << "fewer than half are solved";
  EXPECT_FALSE(chart.lines[1].points[0].hollow);
  EXPECT_LT(chart.lines[0].points[0].x, chart.lines[1].points[0].x) << "side by side";
  EXPECT_EQ(chart.x_ticks, (std::vector<std::pair<double, std::string>>{{0, "16"}}));
  EXPECT_NE(picture_of(chart).find("<svg"), std::string::npos);
  EXPECT_EQ(count(script_of(chart), "set errorbars fullwidth"), 1U) << "no whisker reaches into another box";
  EXPECT_EQ(count(script_of(chart), "with boxplot"), 1U) << "fewer than five values make no box";
  EXPECT_NE(script_of(chart).find("$box0_0 using 1:2 with points pointtype 6 "), std::string::npos)
      << script_of(chart);
  EXPECT_NE(script_of(chart).find("keyentry with points pointtype 7 pointsize 0.5"), std::string::npos)
      << script_of(chart);
  EXPECT_NE(script_of(chart).find("keyentry with boxes"), std::string::npos);
  EXPECT_NE(chart.caption.find("fewer than five values are dots"), std::string::npos) << chart.caption;
}

TEST(Plots, set_two_sides_against_each_other_instance_by_instance) {
  PlotRequest request = two_sides();
  const auto chart = scatter_chart(request, Measure::kRuntimes);
  ASSERT_TRUE(chart);
  ASSERT_EQ(chart->lines.size(), 1U);
  ASSERT_EQ(chart->lines[0].points.size(), 5U);
  EXPECT_DOUBLE_EQ(chart->lines[0].points[0].y, 2 * chart->lines[0].points[0].x);
  ASSERT_TRUE(chart->unsolved);
  EXPECT_EQ(chart->lines[0].points[4].x, *chart->unsolved) << "solved by the second alone";
  EXPECT_NE(chart->caption.find("4 solved by both, 0 by the first alone, 1 by the second alone"),
            std::string::npos);
  EXPECT_EQ(chart->x_label, "none [ms]");
  EXPECT_NE(picture_of(*chart).find("unsolved"), std::string::npos);
  // Values beside "unsolved" have no label where there is no room.
  for (PlottedResult& result : request.runs[0].results) {
    if (result.flowtime_s) *result.flowtime_s *= result.instance == "i3" ? 60 : 1;
  }
  const auto flowtimes = scatter_chart(request, Measure::kFlowtimes);
  ASSERT_TRUE(flowtimes);
  for (const char* ticks : {"set xtics ('unsolved' 18540, '' 10000, '5000' 5000, ",
                            "set ytics ('unsolved' 18540, '10000' 10000, "})
    EXPECT_NE(script_of(*flowtimes).find(ticks), std::string::npos) << script_of(*flowtimes);
  request.filter.options["reschedule"] = "none";
  EXPECT_FALSE(scatter_chart(request, Measure::kRuntimes));
}

TEST(Plots, have_a_title_where_lines_share_nothing) {
  PlotRequest request = two_sides();
  auto& cells = request.runs[0].report.cells;
  cells[1].parameters.environment = "warehouse";
  cells[1].parameters.planner = "other";
  cells[1].parameters.options["initial_order"] = "random";
  cells[1].parameters.options["ssi_s"] = 3.0;
  EXPECT_EQ(success_chart(request).title, "success");
}

TEST(Plots, curves_of_improvement_keep_their_last_value) {
  PlotRequest request;
  PlottedRun& run = request.runs.emplace_back();
  run.report.cells = {measured_cell("empty", 16, 0.01)};
  run.report.cells[0].case_id = 1;
  run.steps = {{1, "a", 0.1, 0.4}, {1, "a", 0.2, 0.2}, {1, "b", 0.4, 0.8}, {1, "b", 1.6, 0.4}};
  const Chart chart = improvement_chart(request);
  const auto& points = chart.lines[0].points;
  ASSERT_GT(points.size(), 10U);
  EXPECT_DOUBLE_EQ(points.front().x, 0.4) << "when both have a plan";
  EXPECT_DOUBLE_EQ(points.front().y, 50) << "the first ended at 0.2 s";
  EXPECT_DOUBLE_EQ(points.back().y, 30);
}

}  // namespace
}  // namespace sipplab::bench
