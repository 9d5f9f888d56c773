// The parts of the picture that know nothing of robots: colours, numbers, the map.
#pragma once

#include <cstddef>
#include <string>
#include <string_view>
#include <utility>

#include "planner/geometry/vec2.hpp"
#include "planner/grid/grid_map.hpp"
#include "planner/solution/trajectory.hpp"

namespace sipplab {

/// An SVG text that grows.
class SvgCanvas {
 public:
  /// One unit within the world is a cell, drawn this many pixels wide.
  explicit SvgCanvas(double cell_px) : cell_px_(cell_px) {}

  double cell_px() const { return cell_px_; }
  /// Text as it stands; numbers with at most three decimals.
  SvgCanvas& operator<<(std::string_view text);
  SvgCanvas& operator<<(double value);
  /// Words for a person to read, escaped.
  void label(std::string_view words);
  /// ` name="value"`.
  void attribute(const char* name, double value);
  /// `style` holds further attributes.
  void circle(Vec2 at, double radius, const std::string& style);
  void text(Vec2 at, double size, const std::string& style, const std::string& words);
  /// A hover text for the element that was opened last.
  void tooltip(const std::string& words);

  std::string take() { return std::move(out_); }

 private:
  double cell_px_;
  std::string out_;
};

/// "#rrggbb", far apart for neighbouring positions: hues by the golden angle, in
/// three brightnesses.
std::string robot_colour(std::size_t position);

/// At most three decimals, as short as possible; "0" for what is not finite.
std::string short_number(double value);
/// A path element over all blocked cells, in runs along the rows.
void draw_blocked_cells(SvgCanvas& canvas, const GridMap& map);
/// A path element of the lines between cells, a pixel wide.
void draw_grid_lines(SvgCanvas& canvas, const GridMap& map);
/// The value of a polyline's points attribute, through the places that the trajectory visits.
void draw_points(SvgCanvas& canvas, const Trajectory& trajectory);

/// Red, for what is wrong.
inline constexpr const char* kViolationColour = "#d4142a";

/// Where the disk is at this time, in cells.
Vec2 position_at(const Trajectory& trajectory, double time_s);

}  // namespace sipplab
