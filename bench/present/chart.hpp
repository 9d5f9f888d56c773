// Charts, drawn by gnuplot, in colours that people with colour-blindness can tell apart (Okabe & Ito 2008).
#pragma once

#include <cstddef>
#include <limits>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "bench/present/picture_format.hpp"
#include "sipplab/error.hpp"

namespace sipplab::bench {

/// More lines than this are no picture: there are as many colours.
inline constexpr std::size_t kMostChartLines = 7;

/// More numbers of robots than this are not all written below the x axis.
inline constexpr std::size_t kMostNumbersOfRobots = 10;

/// " (the first 7 of 36 lines)", or nothing if all are drawn.
std::string omission_note(std::size_t lines);

struct ChartPoint {
  double x = 0;
  double y = 0;
  bool hollow = false;                                  ///< less certain than the others: drawn so
  std::optional<std::pair<double, double>> interval{};  ///< around y

  friend bool operator==(const ChartPoint&, const ChartPoint&) = default;
};

struct ChartMark {
  double x = 0;
  std::string label;  ///< short, above the plot
};

enum class LineStyle {
  kLine,    ///< dots, joined
  kSteps,   ///< steps, without dots
  kPoints,  ///< dots alone
  kBoxes,   ///< at each x the box plot of all y there: quartiles, whiskers of at most 1.5 boxes, what is
            ///< beyond; of fewer than five dots
};

struct ChartLine {
  std::string label;
  std::vector<ChartPoint> points;  ///< by x
  bool dashed = false;
  int colour = 0;                ///< number in the palette; lines that belong together share one
  std::vector<ChartMark> marks;  ///< vertical lines
  LineStyle style = LineStyle::kLine;
};

struct Chart {
  std::string title;
  std::string caption;  ///< what it was drawn from: runs, counts
  std::string x_label;
  std::string y_label;
  std::vector<ChartLine> lines;
  bool log_x = false;
  bool log_y = false;
  std::optional<double> y_min;
  std::optional<double> y_max;
  /// Where the x axis is labelled, and how; empty: round numbers.
  std::vector<std::pair<double, std::string>> x_ticks;
  bool diagonal = false;           ///< the line of equal x and y, and both axes alike
  std::optional<double> unsolved;  ///< where x and y stand for "unsolved"
  double box_width = 0;            ///< of box plots, in x
  int width = 560;                 ///< pixels
  int height = 340;                ///< pixels, without the legend
};

/// Labels the x axis at each x of a point; with more than `most` different ones at round numbers.
void label_points(Chart& chart, std::size_t most = std::numeric_limits<std::size_t>::max());

bool is_empty(const Chart& chart);

/// What gnuplot is told. Names of any kind are safe in it.
std::string gnuplot_script(const Chart& chart, PictureFormat format, const std::string& file);

/// The bytes of a picture of each chart, in one run of gnuplot. A chart without a point is a frame
/// that says so. Errors: one line, if gnuplot is not installed or fails.
Expected<std::vector<std::string>, std::string> pictures_of(const std::vector<Chart>& charts,
                                                            PictureFormat format);

/// Where a page has the picture of its chart of that number, until with_pictures() puts it there.
std::string picture_place(std::size_t chart);
Expected<std::string, std::string> with_pictures(std::string page, const std::vector<Chart>& charts);

/// One line if gnuplot is not installed, else none: to be asked before work that ends in pictures.
std::optional<std::string> find_gnuplot_error();

}  // namespace sipplab::bench
