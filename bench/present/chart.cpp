// Charts as scripts of gnuplot.
#include "bench/present/chart.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <set>
#include <string_view>

#include "bench/present/chart_points.hpp"
#include "bench/present/numbers.hpp"
#include "planner/io/text.hpp"

namespace sipplab::bench {
namespace {

constexpr std::array<const char*, kMostChartLines> kPalette{"#0072b2", "#d55e00", "#009e73", "#cc79a7",
                                                            "#e69f00", "#56b4e9", "#7f7f7f"};
/// Gnuplot's numbers of filled points; the one before each is the hollow one of its shape.
constexpr std::array<int, kMostChartLines> kPoints{7, 5, 9, 13, 11, 15, 7};
/// More points than this are a line without dots.
constexpr std::size_t kMostDots = 60;
/// Gnuplot makes no box of fewer values: they are points.
constexpr std::size_t kFewestInBox = 5;
/// Pixels: a letter of ticks and labels, what stands left and right of the plot, a line of the legend; what
/// stands below the plot beside the legend: the labels of ticks and axis.
constexpr double kCharWidth = 6.4;
constexpr double kMargins = 90;
constexpr double kLeftMargin = 65;
constexpr double kLegendLine = 17;
constexpr double kBelowPlot = 58;
/// Gnuplot's own idea of a letter, by which it sets columns of the legend apart, and what else is in one, in
/// letters.
constexpr double kColumnLetter = 7.7;
constexpr double kBesideLabel = 6;
constexpr double kSample = 40;
constexpr double kTitleSize = 13;
/// Width of a letter of the title, as a share of its size; pixels left free beside it.
constexpr double kTitleLetter = 0.6;
constexpr double kTitleMargin = 20;
constexpr double kCaptionLetter = 4.8;
constexpr double kPixelsPerInch = 100;
constexpr double kMarkHeight = 14;

/// As gnuplot reads it, where nothing in it is a command: between single quotes it expands nothing.
std::string quoted(std::string text) {
  for (char& c : text) {
    if (static_cast<unsigned char>(c) < ' ') c = ' ';
  }
  std::string out = "'";
  for (const char c : text) out += c == '\'' ? std::string("''") : std::string(1, c);
  return out + "'";
}

/// In lines of at most so many letters, broken at spaces.
std::vector<std::string> wrapped(std::string_view text, std::size_t most) {
  std::vector<std::string> lines;
  while (!text.empty()) {
    std::size_t end = text.size() > most ? text.rfind(' ', most) : text.size();
    if (end == std::string_view::npos || end == 0)
      end = std::min(text.size(), std::max<std::size_t>(most, 1));
    lines.emplace_back(text.substr(0, end));
    text.remove_prefix(end);
    if (text.starts_with(' ')) text.remove_prefix(1);
  }
  return lines;
}

class Script {
 public:
  Script(const Chart& chart, PictureFormat format) : chart_(chart), format_(format) {
    std::size_t longest = 0;
    for (const ChartLine& one : chart_.lines) {
      const auto most = static_cast<std::size_t>((chart_.width - kTitleMargin - kSample) / kCharWidth);
      for (const std::string& words : labels_.emplace_back(wrapped(one.label, most))) {
        longest = std::max(longest, words.size());
        ++label_lines_;
      }
    }
    const double width = kColumnLetter * (static_cast<double>(longest) + kBesideLabel);
    const bool broken =
        std::any_of(labels_.begin(), labels_.end(), [](const auto& one) { return one.size() > 1; });
    const double columns = broken ? 1 : std::max(1.0, std::floor((chart_.width - kTitleMargin) / width));
    legend_rows_ = std::ceil(static_cast<double>(label_lines_) / columns);
    height_ = chart_.height + kLegendLine * legend_rows_;
    place_marks();
  }

  std::string write(const std::string& file) {
    line("reset");
    line("set encoding utf8");
    const int height = static_cast<int>(height_);
    if (format_ == PictureFormat::kPdf) {
      line(fmt::format("set terminal pdfcairo noenhanced font 'sans,9' size {:.2f}in,{:.2f}in",
                       chart_.width / kPixelsPerInch, height / kPixelsPerInch));
    } else {
      line(fmt::format("set terminal svg noenhanced dynamic font 'sans-serif,11' size {},{}{}", chart_.width,
                       height, format_ == PictureFormat::kSvg ? " background '#ffffff'" : ""));
    }
    line("set output " + quoted(file));
    titles();
    axes();
    if (is_empty(chart_)) {
      line("set label 9 'nothing to show' at graph 0.5, graph 0.5 center");
      line("set xrange [0:1]; set yrange [0:1]; unset key; plot 1/0 notitle");
    } else {
      marks();
      draw();
    }
    line("unset output");
    return std::move(text_);
  }

 private:
  void line(const std::string& words) { text_ += words + '\n'; }

  /// Labels of marks stand in rows, so that none covers another: row and horizontal justification of each.
  struct MarkPlace {
    std::size_t row = 0;
    const char* justified = "center";
  };
  void place_marks() {
    constexpr double kMarkLetter = 5.6;
    ChartRange x;
    for (const ChartLine& one : chart_.lines) {
      for (const ChartPoint& point : one.points) x.add(point.x);
    }
    std::vector<double> row_ends;
    for (const ChartLine& one : chart_.lines) {
      for (const ChartMark& mark : one.marks) {
        MarkPlace& place = mark_places_.emplace_back();
        if (mark.label.empty()) continue;
        const double width = kMarkLetter * static_cast<double>(mark.label.size() + 1);
        const double middle =
            kLeftMargin + (mark.x - x.low) * (chart_.width - kMargins) / std::max(x.high - x.low, 1e-9);
        double begin = middle - width / 2;
        if (begin < 0) {
          place.justified = "left";
          begin = middle;
        } else if (begin + width > chart_.width) {
          place.justified = "right";
          begin = middle - width;
        }
        while (place.row < row_ends.size() && begin < row_ends[place.row]) ++place.row;
        if (place.row == row_ends.size()) row_ends.push_back(0);
        row_ends[place.row] = begin + width;
      }
    }
    mark_rows_ = row_ends.size();
  }

  void titles() {
    // A long title becomes smaller rather than cut off.
    const double letters = kTitleLetter * static_cast<double>(chart_.title.size() + 1);
    const double size = std::min(kTitleSize, (chart_.width - kTitleMargin) / letters);
    const auto most = static_cast<std::size_t>((chart_.width - kTitleMargin) / kCaptionLetter);
    constexpr double kCaptionHeight = 13;
    constexpr double kTitleHeight = 17;
    double y = kTitleHeight;
    label(1, chart_.title, y, fmt::format("font ',{:.1f}'", size));
    int number = 2;
    for (const std::string& words : wrapped(chart_.caption, most)) {
      y += kCaptionHeight;
      label(number++, words, y, "font ',8.5' textcolor rgb '#777777'");
    }
    constexpr double kBelowTitles = 16;  // half a tick's label and some air
    y += kBelowTitles + kMarkHeight * static_cast<double>(mark_rows_);
    line(fmt::format("set tmargin at screen {:.4f}", from_top(y)));
    line(fmt::format("set bmargin at screen {:.4f}", (kBelowPlot + kLegendLine * legend_rows_) / height_));
  }
  double from_top(double pixels) const { return 1 - pixels / height_; }
  void label(int number, const std::string& words, double y, const std::string& more) {
    line(fmt::format("set label {} {} at screen {:.4f}, screen {:.4f} left {}", number, quoted(words),
                     8.0 / chart_.width, from_top(y), more));
  }

  void axes() {
    line("set border 3 linecolor rgb '#444444'");
    line("set tics nomirror out scale 0.6 textcolor rgb '#444444'");
    line("set grid y linecolor rgb '#cccccc' linetype 1 linewidth 0.5");
    line("set xlabel " + quoted(chart_.x_label) + " offset 0,0.3");
    line("set ylabel " + quoted(chart_.y_label));
    // Where it is, not where gnuplot finds room: it would take less than there is, and write over the axis.
    constexpr double kKeyLeft = 8;
    constexpr double kKeyBottom = 4;
    line(fmt::format(
        "set key at screen {:.4f}, screen {:.4f} left bottom Left reverse samplen 2 width 1 maxrows {}",
        kKeyLeft / chart_.width, kKeyBottom / height_, std::max(legend_rows_, 1.0)));
    // Ten digits tell apart whatever gnuplot puts a tick at.
    line("set format x '%.10g'; set format y '%.10g'");
    ChartRange x;
    ChartRange y;
    for (const ChartLine& one : chart_.lines) {
      for (const ChartPoint& point : one.points) {
        if (!is_drawn(chart_, point)) continue;
        x.add(point.x);
        y.add(point.y);
      }
    }
    if (chart_.diagonal) {
      for (const double value : {y.low, y.high}) x.add(value);
      y = x;
    }
    if (!is_empty(chart_)) ranges(x, y);
    constexpr double kBesideBoxes = 0.6;
    // Ends of whiskers are as wide as their box, which keeps them off the boxes beside it.
    if (chart_.box_width > 0) line("set errorbars fullwidth");
    if (chart_.box_width > 0 && !chart_.x_ticks.empty()) {
      range("x", format_real(chart_.x_ticks.front().first - kBesideBoxes),
            format_real(chart_.x_ticks.back().first + kBesideBoxes));
    }
    line(chart_.log_x || chart_.diagonal ? "set offsets 0,0,0,0"
                                         : "set offsets graph 0.02, graph 0.02, 0, 0");
    if (!chart_.x_ticks.empty()) ticks();
    if (chart_.diagonal) line("set size square; set grid x");
  }

  void ranges(const ChartRange& x, const ChartRange& y) {
    if (chart_.log_x) log_range("x", x, {}, {});
    if (chart_.log_y) return log_range("y", y, chart_.y_min, chart_.y_max);
    if (chart_.diagonal && !chart_.log_x) range("x", format_real(x.low), format_real(x.high));
    if (chart_.diagonal) return range("y", format_real(y.low), format_real(y.high));
    range("y", chart_.y_min ? format_real(*chart_.y_min) : "*",
          chart_.y_max ? format_real(*chart_.y_max) : "*");
  }

  /// Gnuplot would widen a logarithmic axis to whole powers of ten, and put ticks at those alone.
  void log_range(const char* axis, const ChartRange& values, const std::optional<double>& least,
                 const std::optional<double>& most) {
    constexpr double kBeyond = 1.25;
    constexpr double kFewPowers = 100;
    const double low = least.value_or(values.low / kBeyond);
    const double high = most.value_or(values.high * kBeyond);
    line(fmt::format("set logscale {}", axis));
    range(axis, format_real(low), format_real(high));
    constexpr double kFewPowersAcross = 1000;  // where labels without room are left out
    const bool many = high / low >= (chart_.unsolved ? kFewPowersAcross : kFewPowers);
    if (many && !chart_.unsolved) return;
    constexpr double kHardlyAny = 8;
    const std::vector<double> factors = many ? std::vector<double>{1}
                                        : high / low < kHardlyAny
                                            ? std::vector<double>{1, 1.2, 1.5, 2, 2.5, 3, 4, 5, 6, 7, 8, 9}
                                            : std::vector<double>{1, 2, 5};
    constexpr double kBesideUnsolved = 1.5;
    std::vector<std::pair<double, std::string>> found;
    for (double power = std::pow(10, std::floor(std::log10(low))); power <= high; power *= 10) {
      for (const double factor : factors) {
        const double value = factor * power;
        const bool is_time = !chart_.unsolved || value * kBesideUnsolved < *chart_.unsolved;
        if (value >= low && value <= high && is_time) found.emplace_back(value, short_number(value));
      }
    }
    if (chart_.unsolved) found.emplace_back(*chart_.unsolved, "unsolved");
    const double pixels =
        *axis == 'x' ? chart_.width - kMargins : height_ - kLegendLine * legend_rows_ - kMargins;
    tick_labels(axis, found, *axis == 'x',
                [&](double value) { return std::log(value / low) / std::log(high / low) * pixels; });
  }

  void range(const char* axis, const std::string& low, const std::string& high) {
    line(fmt::format("set {}range [{}:{}]", axis, low, high));
  }

  /// From the largest, which matters most; a label without room is left out. `place` is in pixels.
  template <class Place>
  void tick_labels(const char* axis, const std::vector<std::pair<double, std::string>>& ticks, bool across,
                   const Place& place) {
    constexpr double kLetterHeight = 14;
    double room_ends = std::numeric_limits<double>::infinity();
    std::string list;
    for (auto tick = ticks.rbegin(); tick != ticks.rend(); ++tick) {
      const auto& [value, words] = *tick;
      const double half = across ? kCharWidth / 2 * static_cast<double>(words.size() + 1) : kLetterHeight / 2;
      const bool fits = place(value) + half <= room_ends;
      if (fits) room_ends = place(value) - half;
      list +=
          fmt::format("{}{} {}", list.empty() ? "" : ", ", fits ? quoted(words) : "''", format_real(value));
    }
    line(fmt::format("set {}tics ({})", axis, list));
  }

  void ticks() {
    ChartRange x;
    for (const ChartLine& one : chart_.lines) {
      for (const ChartPoint& point : one.points) x.add(point.x);
    }
    const double pixels = (chart_.width - kMargins) / std::max(x.high - x.low, 1e-9);
    tick_labels("x", chart_.x_ticks, true, [&](double value) { return (value - x.low) * pixels; });
    // Room for the half of the last label that stands beside the plot.
    constexpr double kLeastMargin = 3;
    line(fmt::format(
        "set rmargin {:.1f}",
        std::max(kLeastMargin, static_cast<double>(chart_.x_ticks.back().second.size()) / 2 + 2)));
  }

  void marks() {
    int number = 20;
    auto place = mark_places_.begin();
    for (const ChartLine& one : chart_.lines) {
      for (const ChartMark& mark : one.marks) {
        const std::string x = format_real(mark.x);
        line(
            fmt::format("set arrow {} from {}, graph 0 to {}, graph 1 nohead dashtype 3 linewidth 1.5 "
                        "linecolor rgb '{}'",
                        number, x, x, kPalette[1]));
        if (!mark.label.empty()) {
          const double above = 8 + kMarkHeight * static_cast<double>(place->row);
          line(fmt::format("set label {} {} at {}, graph 1 {} offset character 0, screen {:.4f} font ',9'",
                           number, quoted(mark.label), x, place->justified, above / height_));
        }
        ++place;
        ++number;
      }
    }
    if (chart_.diagonal) {
      line(
          "set arrow 10 from graph 0, graph 0 to graph 1, graph 1 nohead linecolor rgb '#777777' dashtype 2");
    }
    if (chart_.unsolved) {
      const std::string at = format_real(*chart_.unsolved);
      line(fmt::format("set arrow 11 from {0}, graph 0 to {0}, graph 1 nohead linecolor rgb '#cccccc'", at));
      line(
          fmt::format("set arrow 12 from graph 0, first {0} to graph 1, first {0} nohead linecolor rgb "
                      "'#cccccc'",
                      at));
    }
  }

  /// Data blocks first, then one plot command. Where lines coincide the first are the widest, so that each is
  /// seen around those that are drawn over it.
  void draw() {
    const bool graded = coincide(chart_);
    std::string plots;
    const auto add = [&plots](const std::string& words) {
      plots += (plots.empty() ? "plot " : ", \\\n  ") + words;
    };
    std::string keys;
    for (std::size_t i = 0; i < chart_.lines.size(); ++i) {
      const ChartLine& one = chart_.lines[i];
      const auto behind = static_cast<double>(graded ? chart_.lines.size() - 1 - i : 0);
      const std::string colour = kPalette[static_cast<std::size_t>(one.colour) % kPalette.size()];
      const std::string stroke = fmt::format("linecolor rgb '{}' linewidth {:.2f} dashtype {}", colour,
                                             1.8 + 0.6 * behind, one.dashed ? "(8,5)" : "1");
      const int filled = kPoints[static_cast<std::size_t>(one.colour) % kPoints.size()];
      const double size = (one.style == LineStyle::kPoints ? 0.4 : 0.65) + 0.1 * behind;
      const auto dots = [&](bool hollow, const std::string& in) {
        return fmt::format("pointtype {} pointsize {:.2f} linewidth 1.2 linecolor rgb '{}'",
                           hollow ? filled - 1 : filled, size, in);
      };
      // In SVG each dot says what it stands for when the pointer rests on it.
      const std::string with_dots = format_ == PictureFormat::kPdf || one.points.size() > kMostDots
                                        ? "using 1:2 with points"
                                        : "using 1:2:5 with labels hypertext point";
      if (one.style == LineStyle::kBoxes) {
        boxes(i, one, colour, add);
      } else {
        const std::string data = fmt::format("$line{}", i);
        const bool dotted = one.style != LineStyle::kSteps && one.points.size() <= kMostDots;
        points(data, one, [](const ChartPoint&) { return true; });
        const bool any_hollow = points(data + "_hollow", one,
                                       [&](const ChartPoint& point) { return point.hollow || one.dashed; });
        const bool any_full = points(data + "_full", one,
                                     [&](const ChartPoint& point) { return !point.hollow && !one.dashed; });
        const bool intervals = std::any_of(one.points.begin(), one.points.end(), [](const ChartPoint& point) {
          return point.interval.has_value();
        });
        if (intervals) {
          // Gnuplot's own bars of errors have a white dot below, which hides what other lines have there.
          const std::string bars =
              "using 1:3:(0):($4-$3) with vectors heads size graph 0.008,90 linewidth 0.9";
          add(fmt::format("{} {} linecolor rgb '{}' notitle", data, bars, colour));
        }
        if (one.style == LineStyle::kLine)
          add(fmt::format("{} using 1:2 with lines {} notitle", data, stroke));
        if (one.style == LineStyle::kSteps)
          add(fmt::format("{} using 1:2 with steps {} notitle", data, stroke));
        if (dotted || one.style == LineStyle::kPoints) {
          // Gnuplot ends with nothing said where hints have no point.
          if (any_hollow && one.style == LineStyle::kLine) {
            add(fmt::format("{}_hollow using 1:2 with points {} notitle", data, dots(false, "#ffffff")));
          }
          if (any_hollow) add(fmt::format("{}_hollow {} {} notitle", data, with_dots, dots(true, colour)));
          if (any_full) add(fmt::format("{}_full {} {} notitle", data, with_dots, dots(false, colour)));
        }
      }
      if (one.label.empty()) continue;
      const std::string key = one.style == LineStyle::kBoxes && any_box(one)
                                  ? fmt::format("boxes fillstyle solid 0.35 linecolor rgb '{}'", colour)
                              : one.style == LineStyle::kBoxes  ? "points " + few_points(colour, false)
                              : one.style == LineStyle::kPoints ? "points " + dots(false, colour)
                              : one.style == LineStyle::kSteps
                                  ? "lines " + stroke
                                  : fmt::format("linespoints {} pointtype {} pointsize {:.2f}", stroke,
                                                one.dashed ? filled - 1 : filled, size);
      const std::vector<std::string>& words = labels_[i];
      keys += fmt::format(", \\\n  keyentry with {} title {}", key, quoted(words.front()));
      for (std::size_t rest = 1; rest < words.size(); ++rest)
        keys += ", \\\n  keyentry with lines linetype nodraw title " + quoted(words[rest]);
    }
    line(plots + keys);
  }

  /// Whether there is any.
  template <class Keep>
  bool points(const std::string& name, const ChartLine& one, const Keep& keep) {
    line(name + " << EOD");
    bool any = false;
    for (const ChartPoint& point : one.points) {
      if (!is_drawn(chart_, point) || !keep(point)) continue;
      any = true;
      const auto interval = point.interval.value_or(std::pair{point.y, point.y});
      line(fmt::format("{} {} {} {} \"{}\"", format_real(point.x), format_real(point.y),
                       format_real(interval.first), format_real(interval.second), words_of(one, point)));
    }
    if (!any) line("NaN NaN NaN NaN");
    line("EOD");
    return any;
  }

  /// "0.9 (0.8 to 0.95) at 64, ssi 5": without what would end the text or be a command in it.
  std::string words_of(const ChartLine& one, const ChartPoint& point) const {
    const auto tick = std::find_if(chart_.x_ticks.begin(), chart_.x_ticks.end(),
                                   [&point](const auto& known) { return known.first == point.x; });
    std::string words = short_number(point.y);
    if (point.interval) {
      words += fmt::format(" ({} to {})", short_number(point.interval->first),
                           short_number(point.interval->second));
    }
    words += " at " + (tick == chart_.x_ticks.end() ? short_number(point.x) : tick->second);
    if (!one.label.empty()) words += ", " + one.label;
    for (char& c : words) {
      if (static_cast<unsigned char>(c) < ' ' || c == '"' || c == '\\') c = ' ';
    }
    return words;
  }

  static std::size_t count_at(const ChartLine& one, double x) {
    return static_cast<std::size_t>(std::count_if(one.points.begin(), one.points.end(),
                                                  [x](const ChartPoint& point) { return point.x == x; }));
  }
  static bool any_box(const ChartLine& one) {
    return std::any_of(one.points.begin(), one.points.end(),
                       [&one](const ChartPoint& point) { return count_at(one, point.x) >= kFewestInBox; });
  }
  static std::string few_points(const std::string& colour, bool hollow) {
    return fmt::format("pointtype {} pointsize 0.5 linewidth 1.2 linecolor rgb '{}'", hollow ? 6 : 7, colour);
  }

  template <class Add>
  void boxes(std::size_t i, const ChartLine& one, const std::string& colour, const Add& add) {
    std::set<double> places;
    for (const ChartPoint& point : one.points) places.insert(point.x);
    int number = 0;
    for (const double x : places) {
      const std::string data = fmt::format("$box{}_{}", i, number++);
      points(data, one, [x](const ChartPoint& point) { return point.x == x; });
      const auto first = std::find_if(one.points.begin(), one.points.end(),
                                      [x](const ChartPoint& point) { return point.x == x; });
      if (count_at(one, x) < kFewestInBox) {
        add(fmt::format("{} using 1:2 with points {} notitle", data, few_points(colour, first->hollow)));
        continue;
      }
      add(
          fmt::format("{} using ({}):2:({}) with boxplot fillstyle {} linewidth 1 pointtype 6 pointsize "
                      "0.3 linecolor rgb '{}' notitle",
                      data, format_real(x), format_real(chart_.box_width),
                      first->hollow ? "empty" : "solid 0.35", colour));
    }
  }

  const Chart& chart_;
  PictureFormat format_;
  std::vector<std::vector<std::string>> labels_;  ///< of lines, broken where they are too long
  std::size_t label_lines_ = 0;
  double legend_rows_ = 0;
  double height_ = 0;  ///< of the picture, pixels
  std::vector<MarkPlace> mark_places_;
  std::size_t mark_rows_ = 0;
  std::string text_;
};

}  // namespace

std::string omission_note(std::size_t lines) {
  return lines > kMostChartLines ? fmt::format(" (the first {} of {} lines)", kMostChartLines, lines) : "";
}

std::string gnuplot_script(const Chart& chart, PictureFormat format, const std::string& file) {
  return Script(chart, format).write(file);
}

}  // namespace sipplab::bench
