// Line charts as SVG: scale, axes, lines, legend.
#include "bench/present/chart.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <set>

#include "bench/present/numbers.hpp"
#include "planner/io/svg_canvas.hpp"

namespace sipplab::bench {
namespace {

constexpr std::array<const char*, kMostChartLines> kPalette{"#0072b2", "#d55e00", "#009e73", "#cc79a7",
                                                            "#e69f00", "#56b4e9", "#7f7f7f"};
// Pixels. The legend stands to the right of the plot, where no line can hide behind it.
constexpr double kLeft = 64;
constexpr double kTop = 34;
constexpr double kBottom = 46;
constexpr double kRightBare = 16;
constexpr double kLegendGap = 34;
constexpr double kCharWidth = 6.4;
constexpr double kLegendLine = 18;
constexpr double kLabelGap = 3;
constexpr double kTitleMargin = 8;
constexpr double kTitleSize = 13;
/// Width of a bold letter, as a share of the size.
constexpr double kBoldWidth = 0.62;
constexpr int kTicks = 5;
/// More points than this are a line without dots.
constexpr std::size_t kMostDots = 60;

struct Range {
  double low = std::numeric_limits<double>::infinity();
  double high = -std::numeric_limits<double>::infinity();
  void add(double value) {
    low = std::min(low, value);
    high = std::max(high, value);
  }
  bool empty() const { return low > high; }
};

/// 1, 2 or 5 times a power of ten.
double nice_step(double span) {
  const double raw = span / kTicks;
  const double power = std::pow(10, std::floor(std::log10(raw)));
  for (const double factor : {1.0, 2.0, 5.0}) {
    if (raw <= factor * power * (1 + 1e-9)) return factor * power;
  }
  return 10 * power;
}

std::vector<double> linear_ticks(const Range& range) {
  const double step = nice_step(range.high - range.low);
  std::vector<double> ticks;
  for (double k = std::ceil(range.low / step - 1e-9); k * step <= range.high + step * 1e-9; ++k) {
    ticks.push_back(k == 0 ? 0 : k * step);
  }
  return ticks;
}

/// Powers of ten; with 2 and 5 between them if there are few; round numbers if there
/// would be hardly any.
std::vector<double> log_ticks(const Range& range) {
  constexpr double kHardlyAny = 8;
  if (range.high / range.low < kHardlyAny) return linear_ticks(range);
  std::vector<double> ticks;
  const bool few = range.high / range.low < 1e3;
  for (double power = std::floor(std::log10(range.low)); power <= std::log10(range.high) + 1e-9; ++power) {
    for (const double factor : {1.0, 2.0, 5.0}) {
      const double tick = factor * std::pow(10, power);
      if ((few || factor == 1) && tick >= range.low * (1 - 1e-9) && tick <= range.high * (1 + 1e-9)) {
        ticks.push_back(tick);
      }
    }
  }
  return ticks;
}

class Drawing {
 public:
  explicit Drawing(const Chart& chart) : chart_(chart) {
    for (const ChartLine& line : chart.lines) {
      for (const auto& [x, y] : line.points) {
        if (chart.log_y && y <= 0) continue;
        x_.add(x);
        y_.add(y);
      }
      if (!line.label.empty()) longest_label_ = std::max(longest_label_, line.label.size());
    }
    if (x_.empty()) return;
    if (chart.y_min) y_.low = *chart.y_min;
    if (chart.y_max) y_.high = *chart.y_max;
    if (x_.low == x_.high) x_ = {x_.low - 1, x_.high + 1};
    widen_y();
    right_ =
        chart.width -
        (longest_label_ == 0 ? kRightBare : kLegendGap + kCharWidth * static_cast<double>(longest_label_));
    right_ = std::max(right_, kLeft + 80);
  }

  std::string svg(SvgUse use) {
    const std::string page = use == SvgUse::kFile ? " style=\"background:#fff;color:#222\"" : "";
    canvas_.open_page(chart_.width, chart_.height, "font-family=\"sans-serif\" font-size=\"11\"" + page);
    canvas_.tooltip(chart_.title);
    if (use == SvgUse::kFile) canvas_ << "\n<rect width=\"100%\" height=\"100%\" fill=\"#fff\"/>";
    canvas_ << "\n";
    // A long title becomes smaller rather than cut off.
    const double space = chart_.width - 2 * kTitleMargin;
    const double size =
        std::min(kTitleSize, space / (kBoldWidth * static_cast<double>(chart_.title.size() + 1)));
    label({kTitleMargin, 20}, chart_.title, "start",
          fmt::format(" font-weight=\"bold\" font-size=\"{:.1f}\"", size));
    if (x_.empty()) {
      label({chart_.width / 2.0, chart_.height / 2.0}, "nothing to show", "middle");
    } else {
      axes();
      for (const ChartLine& line : chart_.lines) draw(line);
      legend();
    }
    canvas_ << "</svg>\n";
    return canvas_.take();
  }

 private:
  void widen_y() {
    if (chart_.log_y) {
      y_.low /= 1.2;
      y_.high *= 1.2;
      return;
    }
    const double span = y_.high - y_.low;
    const double margin = span > 0 ? span * 0.06 : std::max(std::abs(y_.high) * 0.05, 1e-12);
    if (!chart_.y_min) y_.low -= margin;
    if (!chart_.y_max) y_.high += margin;
    if (y_.low >= y_.high) y_.high = y_.low + 1;
  }

  double to_x(double x) const { return kLeft + (x - x_.low) / (x_.high - x_.low) * (right_ - kLeft); }
  double to_y(double y) const {
    const double share =
        chart_.log_y ? std::log(y / y_.low) / std::log(y_.high / y_.low) : (y - y_.low) / (y_.high - y_.low);
    const double bottom = chart_.height - kBottom;
    return bottom - std::clamp(share, 0.0, 1.0) * (bottom - kTop);
  }

  void label(Vec2 at, const std::string& words, const char* anchor, const std::string& more = "") {
    canvas_.text(at, fmt::format("text-anchor=\"{}\" fill=\"currentColor\"{}", anchor, more), words);
    canvas_ << "\n";
  }
  void rule(Vec2 from, Vec2 to, const char* more = "") {
    canvas_.line(from, to, std::string("stroke=\"currentColor\"") + more);
    canvas_ << "\n";
  }

  void axes() {
    const double bottom = chart_.height - kBottom;
    for (const double tick : chart_.log_y ? log_ticks(y_) : linear_ticks(y_)) {
      rule({kLeft, to_y(tick)}, {right_, to_y(tick)}, " stroke-opacity=\"0.15\"");
      label({kLeft - 6, to_y(tick) + 4}, short_number(tick), "end");
    }
    std::vector<std::pair<double, std::string>> ticks = chart_.x_ticks;
    if (ticks.empty()) {
      for (const double tick : linear_ticks(x_)) ticks.emplace_back(tick, short_number(tick));
    }
    // From the right, because what is largest matters most; a label without room is left out.
    double room_ends = chart_.width;
    for (auto tick = ticks.rbegin(); tick != ticks.rend(); ++tick) {
      const auto& [value, words] = *tick;
      const double x = to_x(value);
      rule({x, bottom}, {x, bottom + 4});
      // The outermost labels stay within the picture.
      const double half = kCharWidth / 2 * static_cast<double>(words.size());
      const double middle = std::clamp(x, std::min(half, chart_.width / 2.0),
                                       std::max(chart_.width - half, chart_.width / 2.0));
      if (middle + half > room_ends) continue;
      room_ends = middle - half - kLabelGap;
      label({middle, bottom + 16}, words, "middle");
    }
    rule({kLeft, bottom}, {right_, bottom});
    rule({kLeft, kTop}, {kLeft, bottom});
    label({(kLeft + right_) / 2, chart_.height - 8.0}, chart_.x_label, "middle");
    const std::string turned = fmt::format(" transform=\"rotate(-90 14 {0:.1f})\"", (kTop + bottom) / 2);
    label({14, (kTop + bottom) / 2}, chart_.y_label, "middle", turned);
  }

  void draw(const ChartLine& line) {
    for (const ChartMark& mark : line.marks) {
      const double x = to_x(mark.x);
      canvas_.line({x, kTop}, {x, chart_.height - kBottom},
                   "stroke=\"#d55e00\" stroke-width=\"1.5\" stroke-dasharray=\"3 3\"", mark.text);
      const bool left = x > (kLeft + right_) / 2;
      label({x + (left ? -4 : 4), kTop + 10}, mark.label, left ? "end" : "start", " font-size=\"10\"");
    }
    canvas_ << "<polyline points=\"";
    for (const auto& [x, y] : line.points) {
      if (!chart_.log_y || y > 0) canvas_ << to_x(x) << "," << to_y(y) << " ";
    }
    canvas_ << "\" fill=\"none\" " << stroke_of(line) << "/>\n";
    if (line.points.size() > kMostDots) return;
    // A ring can be seen around a dot in the same place.
    const std::string dot =
        line.dashed ? fmt::format("fill=\"none\" stroke=\"{}\" stroke-width=\"1.5\"", colour_of(line))
                    : fmt::format("fill=\"{}\"", colour_of(line));
    const std::string name = line.label.empty() ? "" : line.label + ": ";
    for (const auto& [x, y] : line.points) {
      if (chart_.log_y && y <= 0) continue;
      canvas_.circle({to_x(x), to_y(y)}, line.dashed ? 4.5 : 2.5, dot, name + short_number(y));
      canvas_ << "\n";
    }
  }

  void legend() {
    double y = kTop + 6;
    for (const ChartLine& line : chart_.lines) {
      if (line.label.empty()) continue;
      canvas_.line({right_ + 8, y}, {right_ + 26, y}, stroke_of(line));
      label({right_ + 30, y + 4}, line.label, "start");
      y += kLegendLine;
    }
  }

  static std::string stroke_of(const ChartLine& line) {
    return fmt::format("stroke=\"{}\" stroke-width=\"2\"{}", colour_of(line),
                       line.dashed ? " stroke-dasharray=\"6 4\"" : "");
  }
  static const char* colour_of(const ChartLine& line) {
    return kPalette[static_cast<std::size_t>(line.colour) % kPalette.size()];
  }

  const Chart& chart_;
  Range x_;
  Range y_;
  std::size_t longest_label_ = 0;
  double right_ = 0;
  SvgCanvas canvas_;
};

}  // namespace

std::string omission_note(std::size_t lines) {
  return lines > kMostChartLines ? fmt::format(" (the first {} of {} lines)", kMostChartLines, lines) : "";
}

void label_points(Chart& chart, std::size_t most) {
  std::set<double> values;
  for (const ChartLine& line : chart.lines) {
    for (const auto& [x, y] : line.points) values.insert(x);
  }
  if (values.size() > most) return;
  for (const double x : values) chart.x_ticks.emplace_back(x, short_number(x));
}

std::string svg(const Chart& chart, SvgUse use) { return Drawing(chart).svg(use); }

}  // namespace sipplab::bench
