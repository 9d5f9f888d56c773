// The parts of the picture that know nothing of robots: colours, the map, where a body is.
#pragma once

#include <cstddef>
#include <string>

#include "planner/io/svg_canvas.hpp"
#include "sipplab/geometry.hpp"
#include "sipplab/grid_map.hpp"
#include "sipplab/solution.hpp"

namespace sipplab {

/// "#rrggbb", far apart for neighbouring positions: hues by the golden angle, in
/// three brightnesses.
std::string robot_colour(std::size_t position);

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
