// Reports: what is drawn and written for people.
#include <gtest/gtest.h>

#include <limits>

#include "bench/present/chart.hpp"
#include "bench/present/density.hpp"
#include "bench/present/numbers.hpp"
#include "bench/present/runtime_chart.hpp"
#include "bench/present/trend_text.hpp"

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

Chart sample_chart() {
  Chart chart;
  chart.title = "a < b & \"c\"";
  chart.x_label = "robots";
  chart.y_label = "share";
  ChartLine line;
  line.label = "ssi 3";
  line.points = {{16, 1.0}, {32, 0.5}, {64, 0}};
  line.marks = {{24, "1a2b", "from here on"}};
  chart.lines.push_back(line);
  return chart;
}

std::size_t count(const std::string& text, const std::string& part) {
  std::size_t found = 0;
  for (std::size_t at = text.find(part); at != std::string::npos; at = text.find(part, at + 1)) ++found;
  return found;
}

TEST(Charts, show_every_point_and_escape_what_is_written) {
  const std::string picture = svg(sample_chart(), SvgUse::kFile);
  EXPECT_EQ(count(picture, "<circle"), 3U);
  EXPECT_EQ(count(picture, "<polyline"), 1U);
  EXPECT_NE(picture.find("a &lt; b &amp; &quot;c&quot;"), std::string::npos);
  EXPECT_NE(picture.find("from here on"), std::string::npos);
  EXPECT_NE(picture.find(">ssi 3</text>"), std::string::npos);
  EXPECT_EQ(picture.find("nan"), std::string::npos);
}

TEST(Charts, draw_nothing_and_single_points_and_constants) {
  Chart chart = sample_chart();
  chart.lines[0].points.clear();
  EXPECT_NE(svg(chart, SvgUse::kFile).find("nothing to show"), std::string::npos);
  for (const bool log : {false, true}) {
    chart.log_y = log;
    chart.lines[0].points = {{5, 2}};
    EXPECT_EQ(svg(chart, SvgUse::kFile).find("nan"), std::string::npos);
    chart.lines[0].points = {{5, 0}, {6, 0}};
    EXPECT_EQ(svg(chart, SvgUse::kFile).find("nan"), std::string::npos);
  }
}

TEST(Charts, ring_the_points_of_dashed_lines) {
  Chart chart = sample_chart();
  chart.lines.push_back(chart.lines[0]);
  chart.lines[1].dashed = true;
  chart.lines[1].label = "";
  const std::string picture = svg(chart, SvgUse::kFile);
  EXPECT_EQ(count(picture, "r=\"2.5\""), 3U);
  EXPECT_EQ(count(picture, "r=\"4.5\" fill=\"none\""), 3U) << "to be seen around dots in the same place";
  EXPECT_EQ(count(picture, "<title>: "), 0U);
}

TEST(Charts, label_only_the_ticks_that_have_room) {
  Chart chart = sample_chart();
  chart.lines[0].points = {{-9, 1}, {320, 2}};
  chart.x_ticks = {{-9, "-9"}, {16, "16"}, {17, "17"}, {320, "320"}};
  const std::string picture = svg(chart, SvgUse::kFile);
  for (const char* shown : {">-9<", ">17<", ">320<"}) {
    EXPECT_NE(picture.find(shown), std::string::npos) << shown;
  }
  EXPECT_EQ(picture.find(">16<"), std::string::npos);
}

TEST(DensityCharts, have_a_line_for_each_interval_and_dash_the_base) {
  db::RunReport run;
  for (const double ssi_s : {0.0, kInfinity}) {
    for (const std::int64_t robots : {16, 32}) {
      db::CellSummary cell;
      cell.parameters.environment = "ware/house";
      cell.parameters.robots = robots;
      cell.parameters.options["ssi_s"] = ssi_s;
      cell.parameters.options["reschedule"] = "none";
      cell.parameters.options["initial_order"] = "fifo";
      cell.parameters.planner = "sipplab connectedness:3";
      cell.success_rate = 0.5;
      cell.median_planning_time_s = 0.01;
      run.cells.push_back(cell);
    }
  }
  const auto charts = density_charts(run, run);
  ASSERT_EQ(charts.size(), 2U);
  EXPECT_EQ(charts[0].name, "success-ware-house-none-fifo-sipplab-connectedness-3");
  EXPECT_EQ(charts[1].name, "runtime-ware-house-none-fifo-sipplab-connectedness-3");
  run.cells.push_back(run.cells.front());
  run.cells.back().parameters.environment = "ware=house";
  EXPECT_EQ(density_charts(run, run)[3].name, "runtime-ware-house-none-fifo-sipplab-connectedness-3-2");
  ASSERT_EQ(charts[0].chart.lines.size(), 4U);
  EXPECT_EQ(charts[0].chart.lines[2].label, "ssi inf");
  EXPECT_TRUE(charts[0].chart.lines[3].dashed);
  EXPECT_EQ(charts[1].chart.lines[0].points[0].second, 10) << "milliseconds";
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

TEST(TrendChart, puts_each_series_where_its_versions_are) {
  const auto series_of = [](int first, int last) {
    db::TrendSeries series;
    series.case_id = first;
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
  EXPECT_EQ(chart.lines[0].points.back().first, 7);
  ASSERT_EQ(chart.lines[1].points.size(), 4U);
  EXPECT_EQ(chart.lines[1].points.front().first, 4);
  EXPECT_EQ(chart.lines[1].points.back().first, 7);
  ASSERT_EQ(chart.lines[1].marks.size(), 1U);
  EXPECT_EQ(chart.x_ticks.back().first, 7);
  EXPECT_EQ(chart.x_ticks.back().second, "iiiiiiiiii");
  const std::vector<db::TrendSeries> many(9, series_of(1, 3));
  EXPECT_NE(trend_chart(*db::find_trend_metric("success"), many).title.find("first 7 of 9 lines"),
            std::string::npos);
}

db::CellSummary timed_cell(const std::string& environment, std::int64_t robots, double median_s) {
  db::CellSummary cell;
  cell.parameters.environment = environment;
  cell.parameters.robots = robots;
  cell.parameters.options["ssi_s"] = 5.0;
  cell.parameters.options["reschedule"] = "none";
  cell.parameters.options["initial_order"] = "fifo";
  cell.parameters.planner = "sipplab";
  cell.median_planning_time_s = median_s;
  return cell;
}

TEST(RuntimeChart, draws_as_many_lines_as_there_are_colours) {
  db::RunReport run;
  for (int ssi_s = 0; ssi_s < 9; ++ssi_s) {
    run.cells.push_back(timed_cell("empty", 8, 0.01));
    run.cells.back().parameters.options["ssi_s"] = 1.0 * ssi_s;
  }
  const Chart chart = runtime_chart({run}, {});
  EXPECT_EQ(chart.lines.size(), kMostChartLines);
  EXPECT_NE(chart.title.find("first 7 of 9"), std::string::npos) << chart.title;

  run.cells.back().parameters.environment = "warehouse";
  EXPECT_EQ(runtime_chart({run}, {}).lines[0].label, "ssi 0") << "what tells apart those that are drawn";
}

TEST(RuntimeChart, names_lines_by_what_tells_them_apart) {
  db::RunReport ours;
  ours.run.uuid = "11111111-rest";
  ours.cells = {timed_cell("empty", 32, 0.002), timed_cell("empty", 16, 0.001),
                timed_cell("warehouse", 16, 0.004)};
  db::RunReport theirs;
  theirs.run.uuid = "22222222-rest";
  theirs.cells = {timed_cell("empty", 16, 0.5), timed_cell("empty", 16, 0.7)};
  theirs.cells[0].parameters.planner = theirs.cells[1].parameters.planner = "cmd:other";

  db::CaseFilter empty_maps;
  empty_maps.environment = "empty";
  const Chart chart = runtime_chart({ours, theirs}, empty_maps);
  ASSERT_EQ(chart.lines.size(), 2U);
  EXPECT_EQ(chart.title, "empty, none, fifo, ssi 5") << "what all lines share";
  EXPECT_EQ(chart.lines[0].label, "cmd:other, run 22222222");
  ASSERT_EQ(chart.lines[0].points.size(), 1U) << "cases that differ in nothing shown are one point";
  EXPECT_DOUBLE_EQ(chart.lines[0].points[0].second, 600);
  EXPECT_EQ(chart.lines[1].label, "sipplab, run 11111111");
  EXPECT_EQ(chart.lines[1].points, (std::vector<std::pair<double, double>>{{16, 1}, {32, 2}}));

  EXPECT_EQ(runtime_chart({ours, theirs}, {}).lines.size(), 3U);
  EXPECT_TRUE(runtime_chart({}, {}).lines.empty());
}

}  // namespace
}  // namespace sipplab::bench
