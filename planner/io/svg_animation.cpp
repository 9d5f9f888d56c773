#include "planner/io/svg_animation.hpp"

#include <algorithm>
#include <utility>
#include <vector>

namespace sipplab {
namespace {

/// Seconds of the picture for which the end is shown before it begins again.
constexpr double kRestS = 1.5;

/// Shares of a round need more digits than places: a round may last minutes.
std::string share_text(double share) { return short_decimal(share, 6); }

/// ` keyTimes="..." values="..."`.
void key_values(SvgCanvas& canvas, const std::vector<std::pair<double, std::string>>& keys) {
  canvas << " keyTimes=\"";
  for (std::size_t i = 0; i < keys.size(); ++i) canvas << (i > 0 ? ";" : "") << share_text(keys[i].first);
  canvas << "\" values=\"";
  for (std::size_t i = 0; i < keys.size(); ++i) canvas << (i > 0 ? ";" : "") << keys[i].second;
  canvas << "\"";
}

}  // namespace

SvgClock::SvgClock(double end_s, double speed)
    : end_s_(std::max(end_s, 0.0)), round_s_(end_s_ + kRestS * speed) {
  attributes_ = " dur=\"" + short_decimal(round_s_ / speed) + "s\" repeatCount=\"indefinite\"";
}

double SvgClock::share(double time_s) const { return std::clamp(time_s / round_s_, 0.0, 1.0); }

void draw_movement(SvgCanvas& canvas, const Trajectory& trajectory, const SvgClock& clock) {
  const auto place = [](Cell cell) { return std::to_string(cell.x) + " " + std::to_string(cell.y); };
  std::vector<std::pair<double, std::string>> keys = {{0, place(trajectory.start)}};
  for (const TimedMotion& motion : trajectory.motions) {
    // A robot that waits between motions has a key where it begins to move.
    if (keys.back().first < clock.share(motion.begin_s))
      keys.emplace_back(clock.share(motion.begin_s), place(motion.from));
    keys.emplace_back(clock.share(motion.end_s), place(motion.to));
  }
  keys.emplace_back(1, keys.back().second);
  canvas << "<animateTransform attributeName=\"transform\" type=\"translate\"";
  key_values(canvas, keys);
  canvas << clock.attributes() << "/>";
}

void draw_progress(SvgCanvas& canvas, double width, const SvgClock& clock) {
  canvas << "<animate attributeName=\"width\"";
  key_values(canvas,
             {{0, "0"}, {clock.share(clock.end_s()), short_decimal(width)}, {1, short_decimal(width)}});
  canvas << clock.attributes() << "/>";
}

}  // namespace sipplab
