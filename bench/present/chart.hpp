// Line charts as SVG: one file that needs nothing else, in colours that people with
// colour-blindness can tell apart (Okabe & Ito 2008).
#pragma once

#include <cstddef>
#include <limits>
#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace sipplab::bench {

/// More lines than this are no picture: there are as many colours, and the legend ends with the plot.
inline constexpr std::size_t kMostChartLines = 7;

/// More numbers of robots than this are not all written below the x axis.
inline constexpr std::size_t kMostNumbersOfRobots = 10;

/// " (the first 7 of 36 lines)", or nothing if all are drawn.
std::string omission_note(std::size_t lines);

struct ChartMark {
  double x = 0;
  std::string label;  ///< short, beside the line
  std::string text;   ///< shown when the pointer rests on it
};

struct ChartLine {
  std::string label;
  std::vector<std::pair<double, double>> points;  ///< x, y; by x
  bool dashed = false;
  int colour = 0;                ///< number in the palette; lines that belong together share one
  std::vector<ChartMark> marks;  ///< vertical lines
};

struct Chart {
  std::string title;
  std::string x_label;
  std::string y_label;
  std::vector<ChartLine> lines;
  bool log_y = false;
  std::optional<double> y_min;
  std::optional<double> y_max;
  /// Where the x axis is labelled, and how; empty: round numbers.
  std::vector<std::pair<double, std::string>> x_ticks;
  int width = 560;   ///< pixels
  int height = 320;  ///< pixels
};

/// Labels the x axis at each x of a point; with more than `most` different ones at round numbers.
void label_points(Chart& chart, std::size_t most = std::numeric_limits<std::size_t>::max());

enum class SvgUse {
  kFile,    ///< on a white page of its own
  kInline,  ///< within a page, whose colour of text it takes
};

/// Without any point: a frame that says so.
std::string svg(const Chart& chart, SvgUse use);

}  // namespace sipplab::bench
