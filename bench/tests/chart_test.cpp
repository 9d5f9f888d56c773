// Charts: what gnuplot is told, and what it draws.
#include <gtest/gtest.h>

#include "bench/tests/chart_support.hpp"

namespace sipplab::bench {
namespace {

Chart sample_chart() {
  Chart chart;
  chart.title = "it's `date` @x \"c\" <b>";
  chart.x_label = "robots";
  chart.y_label = "share";
  ChartLine line;
  line.label = "ssi 3";
  line.points = {{16, 1.0}, {32, 0.5}, {64, 0, true}};
  line.marks = {{24, "1a2b"}};
  chart.lines.push_back(line);
  return chart;
}

TEST(Charts, hold_every_point_and_no_name_is_a_command) {
  const std::string script = script_of(sample_chart());
  EXPECT_NE(script.find("'it''s `date` @x \"c\" <b>'"), std::string::npos) << script;
  EXPECT_NE(script.find("\n16 1 1 1 \"1 at 16, ssi 3\"\n32 0.5 0.5 0.5 \""), std::string::npos) << script;
  EXPECT_NE(script.find("$line0_hollow << EOD\n64 0 0 0 \"0 at 64, ssi 3\"\nEOD"), std::string::npos)
      << script;
  Chart named = sample_chart();
  named.lines[0].label = "a\nplot 'b'";
  EXPECT_EQ(script_of(named).find("\nplot 'b'"), std::string::npos) << "a name ends no line";
}

TEST(Charts, say_of_each_point_what_it_is_when_the_pointer_rests_on_it) {
  Chart chart = sample_chart();
  chart.lines[0].label = "<b> & 'c' \"d\" \\n";
  chart.lines[0].points[1].interval = {0.25, 0.75};
  chart.x_ticks = {{64, "1a2b3c"}};
  const std::string picture = picture_of(chart);
  EXPECT_NE(picture.find("<g><title>0.5 (0.25 to 0.75) at 32, &lt;b> &amp; 'c'  d   n</title>"),
            std::string::npos)
      << picture;
  EXPECT_NE(picture.find("<title>0 at 1a2b3c, "), std::string::npos);
  EXPECT_EQ(count(picture, "onmouse"), 0U);
  EXPECT_EQ(count(picture, "#FFFFFF"), 1U) << "behind a hollow point, and behind no interval";
}

TEST(Charts, are_drawn_as_a_file_within_a_page_and_as_pdf) {
  const std::string file = picture_of(sample_chart());
  EXPECT_NE(file.find("<title>it's `date` @x &quot;c&quot; &lt;b&gt;</title>"), std::string::npos)
      << file.substr(0, 600);
  EXPECT_EQ(count(file, "<title>"), 4U) << "of the chart and its points, and of nothing else";
  EXPECT_NE(file.find("ssi 3"), std::string::npos);
  const auto page =
      with_pictures(picture_place(1) + "|" + picture_place(0), {sample_chart(), sample_chart()});
  ASSERT_TRUE(page);
  EXPECT_EQ(count(*page, "<?xml"), 0U);
  EXPECT_EQ(count(*page, "<svg"), 2U);
  EXPECT_LT(page->find("c1_"), page->find("c0_")) << "each at its place";
  for (const char* own : {"'c0_gpPt", "'c1_gpPt", "#c0_gpPt", "#c1_gpPt"}) {
    EXPECT_NE(page->find(own), std::string::npos) << "two pictures of a page share no name: " << own;
  }
  EXPECT_EQ(count(*page, "'gpPt") + count(*page, "#gpPt"), 0U);
  EXPECT_EQ(picture_of(sample_chart(), PictureFormat::kPdf).substr(0, 5), "%PDF-");
  EXPECT_EQ(picture_format("a.pdf").value(), PictureFormat::kPdf);
  EXPECT_EQ(picture_format("a.svg").value(), PictureFormat::kSvg);
  EXPECT_FALSE(picture_format("svg").has_value());
}

TEST(Charts, draw_nothing_and_single_points_and_constants) {
  Chart chart = sample_chart();
  chart.lines[0].points.clear();
  EXPECT_TRUE(is_empty(chart));
  EXPECT_NE(picture_of(chart).find("nothing to show"), std::string::npos);
  for (const bool log : {false, true}) {
    chart.log_y = log;
    for (const double y : {2.0, 0.0}) {
      chart.lines[0].points = {{5, y}, {6, y}};
      EXPECT_EQ(is_empty(chart), log && y == 0);
      EXPECT_EQ(picture_of(chart).find("nan"), std::string::npos);
      chart.lines[0].points.pop_back();
      EXPECT_EQ(picture_of(chart).find("nan"), std::string::npos);
    }
  }
}

TEST(Charts, ticks_of_near_values_differ) {
  Chart chart = sample_chart();
  chart.lines[0].points = {{1, 1127.0001}, {2, 1127.0002}, {3, 1127.0004}};
  const std::string picture = picture_of(chart);
  EXPECT_EQ(count(picture, ">1127</"), 0U) << picture;
  EXPECT_GT(count(picture, ">1127.0"), 2U);
}

TEST(Charts, show_each_of_lines_that_coincide) {
  Chart chart = sample_chart();
  chart.lines.push_back(chart.lines[0]);
  chart.lines[1].colour = 1;
  EXPECT_NE(script_of(chart).find("linewidth 2.40"), std::string::npos) << "the lower one is wider";
  chart.lines[1].points = {{16, 0.9}, {32, 0.4}, {64, 0.1}};
  EXPECT_EQ(script_of(chart).find("linewidth 2.40"), std::string::npos);
  for (ChartLine& line : chart.lines) line.style = LineStyle::kSteps;
  chart.lines[0].points = {{1, 1}, {5, 2}, {9, 3}};
  chart.lines[1].points = {{2, 1}, {6, 2}, {8, 3}};
  EXPECT_NE(script_of(chart).find("linewidth 2.40"), std::string::npos) << "along each other from 2 to 5";
  chart.lines[1].points = {{2, 1.5}, {6, 2.5}, {8, 2.7}};
  EXPECT_EQ(script_of(chart).find("linewidth 2.40"), std::string::npos);
}

TEST(Charts, label_only_the_ticks_that_have_room) {
  Chart chart = sample_chart();
  chart.lines[0].points = {{-9, 1}, {320, 2}};
  chart.x_ticks = {{-9, "-9"}, {16, "16"}, {17, "17"}, {320, "320"}};
  const std::string script = script_of(chart);
  for (const char* shown : {"'-9' -9", "'17' 17", "'320' 320", "'' 16"}) {
    EXPECT_NE(script.find(shown), std::string::npos) << shown << "\n" << script;
  }
}

TEST(Charts, break_labels_that_are_wider_than_the_picture) {
  Chart chart = sample_chart();
  chart.lines[0].label =
      "warehouse, sipplab any-angle:no connectedness:3 improve:0.1s, deterministic, fifo, ssi inf";
  const std::string script = script_of(chart);
  EXPECT_EQ(count(script, "keyentry with"), 2U) << script;
  EXPECT_NE(script.find("keyentry with lines linetype nodraw title 'fifo, ssi inf'"), std::string::npos)
      << script;
  EXPECT_NE(script.find("maxrows 2"), std::string::npos) << "room for both";
  chart.lines[0].label = std::string(100, 'x');
  EXPECT_EQ(count(script_of(chart), "keyentry with"), 2U) << "a word that is too long is broken, too";
}

TEST(Charts, keep_the_legend_apart_from_the_axis) {
  Chart chart = sample_chart();
  EXPECT_NE(script_of(chart).find("set bmargin at screen 0.2101"), std::string::npos) << script_of(chart);
  for (int i = 0; i < 6; ++i) chart.lines.push_back(chart.lines[0]);
  const std::string script = script_of(chart);
  EXPECT_NE(script.find("maxrows 2"), std::string::npos) << "six in a row: " << script;
  EXPECT_NE(script.find("set bmargin at screen 0.2460"), std::string::npos) << script;
}

TEST(Charts, labels_of_marks_cover_no_other_and_stay_within) {
  Chart chart = sample_chart();
  chart.lines[0].marks = {{24, "1a2b -33 points"}, {28, "3c4d +50 points"}, {63.5, "5e6f +20 points"}};
  const std::string script = script_of(chart);
  EXPECT_NE(script.find("'1a2b -33 points' at 24, graph 1 center offset character 0, screen 0.0224"),
            std::string::npos)
      << script;
  EXPECT_NE(script.find("'3c4d +50 points' at 28, graph 1 center offset character 0, screen 0.0616"),
            std::string::npos)
      << script;
  EXPECT_NE(script.find("'5e6f +20 points' at 63.5, graph 1 right"), std::string::npos) << script;
}

}  // namespace
}  // namespace sipplab::bench
