// Charts as scripts of gnuplot.
#include "bench/present/chart.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <set>
#include <string_view>

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
/// Pixels: a letter of ticks and labels, what stands left and right of the plot, a line of the legend.
constexpr double kCharWidth = 6.4;
constexpr double kMargins = 90;
constexpr double kLegendLine = 17;
constexpr double kTitleSize = 13;
/// Width of a letter of the title, as a share of its size; pixels left free beside it.
constexpr double kTitleLetter = 0.6;
constexpr double kTitleMargin = 20;
constexpr double kCaptionLetter = 4.8;
constexpr double kPixelsPerInch = 100;

/// As gnuplot reads it, where nothing in it is a command: between single quotes it expands nothing.
std::string quoted(std::string text) {
  for (char& c : text) {
    if (static_cast<unsigned char>(c) < ' ') c = ' ';
  }
  std::string out = "'";
  for (const char c : text) out += c == '\'' ? std::string("''") : std::string(1, c);
  return out + "'";
}

bool is_drawn(const Chart& chart, const ChartPoint& point) {
  return !(chart.log_y && point.y <= 0) && !(chart.log_x && point.x <= 0) && std::isfinite(point.y);
}

struct ChartRange {
  double low = std::numeric_limits<double>::infinity();
  double high = -std::numeric_limits<double>::infinity();
  void add(double value) {
    low = std::min(low, value);
    high = std::max(high, value);
  }
};

/// Whether two lines have a point in common, to the eye.
bool coincide(const Chart& chart) {
  constexpr double kToTheEye = 0.004;
  ChartRange y;
  for (const ChartLine& line : chart.lines) {
    for (const ChartPoint& point : line.points) y.add(point.y);
  }
  std::set<std::pair<double, long>> places;
  for (const ChartLine& line : chart.lines) {
    std::set<std::pair<double, long>> own;
    for (const ChartPoint& point : line.points) {
      const double share = y.high > y.low ? (point.y - y.low) / (y.high - y.low) : 0;
      own.insert({point.x, std::lround(share / kToTheEye)});
    }
    const std::size_t together = places.size() + own.size();
    places.merge(own);
    if (places.size() < together) return true;
  }
  return false;
}

class Script {
 public:
  Script(const Chart& chart, PictureFormat format) : chart_(chart), format_(format) {}

  std::string write(const std::string& file) {
    line("reset");
    line("set encoding utf8");
    const int height = chart_.height + static_cast<int>(kLegendLine * legend_lines());
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

  double legend_lines() const {
    std::size_t longest = 0;
    std::size_t labels = 0;
    for (const ChartLine& one : chart_.lines) {
      longest = std::max(longest, one.label.size());
      labels += one.label.empty() ? 0U : 1U;
    }
    constexpr double kSample = 40;
    const double width = kCharWidth * static_cast<double>(longest) + kSample;
    const auto columns = std::max(1.0, std::floor(chart_.width / width));
    return std::ceil(static_cast<double>(labels) / columns);
  }

  void titles() {
    // A long title becomes smaller rather than cut off.
    const double letters = kTitleLetter * static_cast<double>(chart_.title.size() + 1);
    const double size = std::min(kTitleSize, (chart_.width - kTitleMargin) / letters);
    std::string_view rest = chart_.caption;
    const auto most = static_cast<std::size_t>((chart_.width - kTitleMargin) / kCaptionLetter);
    std::vector<std::string> lines;
    while (!rest.empty()) {
      std::size_t end = rest.size() > most ? rest.rfind(' ', most) : rest.size();
      if (end == std::string_view::npos) end = rest.size();
      lines.emplace_back(rest.substr(0, end));
      rest.remove_prefix(std::min(rest.size(), end + 1));
    }
    constexpr double kCaptionHeight = 13;
    constexpr double kTitleHeight = 17;
    double y = kTitleHeight;
    label(1, chart_.title, y, fmt::format("font ',{:.1f}'", size));
    int number = 2;
    for (const std::string& words : lines) {
      y += kCaptionHeight;
      label(number++, words, y, "font ',8.5' textcolor rgb '#777777'");
    }
    constexpr double kBelowTitles = 16;  // half a tick's label and some air
    constexpr double kMarkHeight = 14;
    bool marked = false;
    for (const ChartLine& one : chart_.lines) marked = marked || !one.marks.empty();
    line(
        fmt::format("set tmargin at screen {:.4f}", from_top(y + kBelowTitles + (marked ? kMarkHeight : 0))));
  }
  double from_top(double pixels) const { return 1 - pixels / (chart_.height + kLegendLine * legend_lines()); }
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
    line("set key below left Left reverse samplen 2 width 1");
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
    if (!is_empty(chart_)) ranges(x, y);
    constexpr double kBesideBoxes = 0.6;
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
    if (high / low >= kFewPowers) return;
    constexpr double kHardlyAny = 8;
    const std::vector<double> factors = high / low < kHardlyAny
                                            ? std::vector<double>{1, 1.2, 1.5, 2, 2.5, 3, 4, 5, 6, 7, 8, 9}
                                            : std::vector<double>{1, 2, 5};
    std::string list;
    for (double power = std::pow(10, std::floor(std::log10(low))); power <= high; power *= 10) {
      for (const double factor : factors) {
        list += fmt::format("{}'{}' {}", list.empty() ? "" : ", ", short_number(factor * power),
                            format_real(factor * power));
      }
    }
    line(fmt::format("set {}tics ({})", axis, list));
  }

  void range(const char* axis, const std::string& low, const std::string& high) {
    line(fmt::format("set {}range [{}:{}]", axis, low, high));
  }

  /// From the right, because what is largest matters most; a label without room is left out.
  void ticks() {
    ChartRange x;
    for (const ChartLine& one : chart_.lines) {
      for (const ChartPoint& point : one.points) x.add(point.x);
    }
    const double pixels = (chart_.width - kMargins) / std::max(x.high - x.low, 1e-9);
    double room_ends = std::numeric_limits<double>::infinity();
    std::string list;
    for (auto tick = chart_.x_ticks.rbegin(); tick != chart_.x_ticks.rend(); ++tick) {
      const auto& [value, words] = *tick;
      const double middle = (value - x.low) * pixels;
      const double half = kCharWidth / 2 * static_cast<double>(words.size() + 1);
      const bool fits = middle + half <= room_ends;
      if (fits) room_ends = middle - half;
      list +=
          fmt::format("{}{} {}", list.empty() ? "" : ", ", fits ? quoted(words) : "''", format_real(value));
    }
    line("set xtics (" + list + ")");
    // Room for the half of the last label that stands beside the plot.
    constexpr double kLeastMargin = 3;
    line(fmt::format(
        "set rmargin {:.1f}",
        std::max(kLeastMargin, static_cast<double>(chart_.x_ticks.back().second.size()) / 2 + 2)));
  }

  void marks() {
    int number = 20;
    for (const ChartLine& one : chart_.lines) {
      for (const ChartMark& mark : one.marks) {
        const std::string x = format_real(mark.x);
        line(
            fmt::format("set arrow {} from {}, graph 0 to {}, graph 1 nohead dashtype 3 linewidth 1.5 "
                        "linecolor rgb '{}'",
                        number, x, x, kPalette[1]));
        if (!mark.label.empty()) {
          line(fmt::format("set label {} {} at {}, graph 1.035 center font ',9'", number, quoted(mark.label),
                           x));
        }
        ++number;
      }
    }
    if (chart_.diagonal) {
      ChartRange all;
      for (const ChartLine& one : chart_.lines) {
        for (const ChartPoint& point : one.points) {
          if (!is_drawn(chart_, point)) continue;
          all.add(point.x);
          all.add(point.y);
        }
      }
      // Whole powers of ten, so that both axes are alike.
      if (chart_.log_x) {
        all.low = std::pow(10, std::floor(std::log10(all.low)));
        all.high *= 1.5;
      }
      const std::string range = fmt::format("[{}:{}]", format_real(all.low), format_real(all.high));
      line(fmt::format("set xrange {0}; set yrange {0}", range));
      line(
          "set arrow 10 from graph 0, graph 0 to graph 1, graph 1 nohead linecolor rgb '#777777' dashtype 2");
    }
    if (chart_.unsolved) {
      const std::string at = format_real(*chart_.unsolved);
      line(fmt::format("set xtics add ('unsolved' {0}); set ytics add ('unsolved' {0})", at));
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
      const std::string key = one.style == LineStyle::kBoxes
                                  ? fmt::format("boxes fillstyle solid 0.35 linecolor rgb '{}'", colour)
                              : one.style == LineStyle::kPoints ? "points " + dots(false, colour)
                              : one.style == LineStyle::kSteps
                                  ? "lines " + stroke
                                  : fmt::format("linespoints {} pointtype {} pointsize {:.2f}", stroke,
                                                one.dashed ? filled - 1 : filled, size);
      keys += fmt::format(", \\\n  keyentry with {} title {}", key, quoted(one.label));
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
      add(
          fmt::format("{} using ({}):2:({}) with boxplot fillstyle {} linewidth 1 pointtype 6 pointsize "
                      "0.3 linecolor rgb '{}' notitle",
                      data, format_real(x), format_real(chart_.box_width),
                      first->hollow ? "empty" : "solid 0.35", colour));
    }
  }

  const Chart& chart_;
  PictureFormat format_;
  std::string text_;
};

}  // namespace

std::string omission_note(std::size_t lines) {
  return lines > kMostChartLines ? fmt::format(" (the first {} of {} lines)", kMostChartLines, lines) : "";
}

void label_points(Chart& chart, std::size_t most) {
  std::set<double> values;
  for (const ChartLine& line : chart.lines) {
    for (const ChartPoint& point : line.points) values.insert(point.x);
  }
  if (values.size() > most) return;
  for (const double x : values) chart.x_ticks.emplace_back(x, short_number(x));
}

bool is_empty(const Chart& chart) {
  return std::all_of(chart.lines.begin(), chart.lines.end(), [&chart](const ChartLine& line) {
    return std::none_of(line.points.begin(), line.points.end(),
                        [&chart](const ChartPoint& point) { return is_drawn(chart, point); });
  });
}

std::string gnuplot_script(const Chart& chart, PictureFormat format, const std::string& file) {
  return Script(chart, format).write(file);
}

}  // namespace sipplab::bench
