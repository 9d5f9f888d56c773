// Colours and map of the picture: see svg_paint.hpp.
#include "planner/io/svg_paint.hpp"

#include <algorithm>
#include <array>
#include <cmath>

namespace sipplab {
namespace {

void append_hex_byte(std::string& out, double share) {
  constexpr const char* kHexDigits = "0123456789abcdef";
  const auto value = static_cast<unsigned>(std::lround(std::clamp(share, 0.0, 1.0) * 255));
  out += kHexDigits[value / 16];
  out += kHexDigits[value % 16];
}

}  // namespace

std::string robot_colour(std::size_t position) {
  constexpr double kGoldenAngleDeg = 137.50776405003785;
  constexpr std::array<double, 3> kLightness = {0.42, 0.32, 0.52};
  // The palette repeats after some thousand robots; so many colours cannot be told apart anyway.
  const double hue = std::fmod(205 + kGoldenAngleDeg * static_cast<double>(position % 3600), 360.0) / 60;
  // From yellow to cyan the eye sees more light: darker there, to stand out from white.
  const double dimming = hue > 0.7 && hue < 3.3 ? 0.8 : 1;
  const double lightness = dimming * kLightness[position % kLightness.size()];
  constexpr double kSaturation = 0.72;
  const double chroma = (1 - std::abs(2 * lightness - 1)) * kSaturation;
  const double second = chroma * (1 - std::abs(std::fmod(hue, 2.0) - 1));
  const double base = lightness - chroma / 2;
  constexpr std::array<std::array<int, 3>, 6> kParts = {
      {{2, 1, 0}, {1, 2, 0}, {0, 2, 1}, {0, 1, 2}, {1, 0, 2}, {2, 0, 1}}};  // 2: chroma, 1: second, 0: none
  std::string colour = "#";
  for (const int part : kParts[static_cast<std::size_t>(hue) % 6]) {
    append_hex_byte(colour, base + (part == 2 ? chroma : part == 1 ? second : 0));
  }
  return colour;
}

void draw_blocked_cells(SvgCanvas& canvas, const GridMap& map) {
  canvas << "<path fill=\"#4b5160\" d=\"";
  for (std::int32_t y = 0; y < map.height(); ++y) {
    for (std::int32_t x = 0; x < map.width(); ++x) {
      if (!map.is_blocked({x, y})) continue;
      const std::int32_t first_x = x;
      while (x + 1 < map.width() && map.is_blocked({x + 1, y})) ++x;
      const std::int32_t length = x + 1 - first_x;
      canvas << "M" << first_x << " " << y << "h" << length << "v1h-" << length << "z";
    }
  }
  canvas << "\" transform=\"translate(-.5 -.5)\"/>\n";  // cells have their corners at half-integers
}

void draw_grid_lines(SvgCanvas& canvas, const GridMap& map) {
  canvas << "<path fill=\"none\" stroke=\"#e2e4e9\"";
  canvas.attribute("stroke-width", 1 / canvas.unit_px());
  canvas << " d=\"";
  for (std::int32_t x = 1; x < map.width(); ++x) canvas << "M" << x << " 0v" << map.height();
  for (std::int32_t y = 1; y < map.height(); ++y) canvas << "M0 " << y << "h" << map.width();
  canvas << "\" transform=\"translate(-.5 -.5)\"/>\n";
}

void draw_points(SvgCanvas& canvas, const Trajectory& trajectory) {
  canvas << trajectory.start.x << "," << trajectory.start.y;
  for (const TimedMotion& motion : trajectory.motions) {
    if (!motion.is_wait()) canvas << " " << motion.to.x << "," << motion.to.y;
  }
}

Vec2 position_at(const Trajectory& trajectory, double time_s) {
  for (const TimedMotion& motion : trajectory.motions) {
    if (time_s >= motion.end_s) continue;
    const double duration_s = motion.end_s - motion.begin_s;
    const double share = duration_s > 0 ? std::clamp((time_s - motion.begin_s) / duration_s, 0.0, 1.0) : 0;
    return centre(motion.from) + (centre(motion.to) - centre(motion.from)) * share;
  }
  return centre(trajectory.end());
}

}  // namespace sipplab
