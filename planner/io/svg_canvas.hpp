// An SVG text that grows: the one place that writes elements of pictures.
#pragma once

#include <string>
#include <string_view>
#include <utility>

#include "sipplab/geometry.hpp"

namespace sipplab {

/// `style` holds further attributes, written as they are; words are escaped.
class SvgCanvas {
 public:
  /// A unit is drawn this many pixels wide. Numbers have at most `decimals` decimals.
  explicit SvgCanvas(double unit_px = 1, int decimals = 1);

  double unit_px() const { return unit_px_; }
  std::string take() { return std::move(out_); }

  /// Text as it stands, and numbers.
  SvgCanvas& operator<<(std::string_view text);
  SvgCanvas& operator<<(double value);
  /// Words for a person to read.
  void label(std::string_view words);
  /// ` name="value"`.
  void attribute(const char* name, double value);

  /// The root, from (0, 0); `</svg>` ends it.
  void open_page(double width, double height, const std::string& style);
  /// A hover text for the element that was opened last.
  void tooltip(std::string_view words);
  /// Elements with a hover text, if there is one.
  void circle(Vec2 at, double radius, const std::string& style, std::string_view hover = {});
  void line(Vec2 from, Vec2 to, const std::string& style, std::string_view hover = {});
  void text(Vec2 at, const std::string& style, std::string_view words);
  void text(Vec2 at, double size, const std::string& style, std::string_view words);

 private:
  void close(const char* name, std::string_view hover);

  double unit_px_;
  int decimals_;
  std::string out_;
};

/// At most this many decimals, as short as possible; "0" for what is not finite.
std::string short_decimal(double value, int decimals = 3);

}  // namespace sipplab
