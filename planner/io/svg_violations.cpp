// Violations in the picture: see svg_violations.hpp.
#include "planner/io/svg_violations.hpp"

#include <algorithm>

namespace sipplab {
namespace {

constexpr std::size_t kMaxListed = 12;
constexpr std::size_t kMaxMarked = 100;
constexpr double kLineHeightPx = 18;

bool is_with_obstacle(const Violation& violation) {
  return violation.kind == ViolationKind::kObstacleCollision;
}

/// The other party of a violation, if it has one.
struct OtherBody {
  std::string name;
  double radius_cells = 0;
  Vec2 at;
};

std::optional<OtherBody> other_body(const ViolationScene& scene, const Violation& violation) {
  if (!violation.other) return std::nullopt;
  const std::size_t other = *violation.other;
  if (is_with_obstacle(violation)) {
    if (other >= scene.instance.obstacles.size()) return std::nullopt;
    const DynamicObstacle& obstacle = scene.instance.obstacles[other];
    return OtherBody{"obstacle " + obstacle.id, obstacle.radius_cells,
                     position_at(obstacle.trajectory, violation.time_s)};
  }
  if (other >= scene.instance.agents.size()) return std::nullopt;
  const Agent& agent = scene.instance.agents[other];
  // A start-safe interval protects the place where the other one starts.
  const bool is_start = violation.kind == ViolationKind::kStartSafeInterval;
  return OtherBody{agent.id, agent.radius_cells,
                   is_start ? centre(agent.start) : position_at(scene.trajectories[other], violation.time_s)};
}

/// "1: 3 and 5, depth 0.2", beside the mark and inside of the map.
void draw_label(SvgCanvas& canvas, const ViolationScene& scene, const std::string& words, Vec2 mark,
                double radius_cells) {
  const double size = std::max(0.42, 12 / canvas.cell_px());
  constexpr double kCharacterWidth = 0.64;  // of the font's size, bold
  const double width = kCharacterWidth * size * static_cast<double>(words.size());
  const double last_x = std::max(-0.4, scene.instance.map.width() - 0.6 - width);
  const double x = std::clamp(mark.x - width / 2, -0.4, last_x);
  double y = mark.y - radius_cells - 0.6 * size;
  if (y < size) y = mark.y + radius_cells + 1.5 * size;
  canvas << "<rect fill=\"#ffffff\" fill-opacity=\".85\"";
  canvas.attribute("x", x - 0.2 * size);
  canvas.attribute("y", y - size);
  canvas.attribute("width", width + 0.4 * size);
  canvas.attribute("height", 1.35 * size);
  canvas.attribute("rx", 0.25 * size);
  canvas << "/>";
  canvas.text({x, y}, size, std::string("font-weight=\"bold\" fill=\"") + kViolationColour + "\"", words);
}

void draw_cross(SvgCanvas& canvas, Vec2 at) {
  const double arm = std::max(0.22, 5 / canvas.cell_px());
  canvas << "<path fill=\"none\" stroke=\"" << kViolationColour << "\"";
  canvas.attribute("stroke-width", std::max(0.12, 2.5 / canvas.cell_px()));
  canvas << " d=\"M" << at.x - arm << " " << at.y - arm << "L" << at.x + arm << " " << at.y + arm;
  canvas << "M" << at.x - arm << " " << at.y + arm << "L" << at.x + arm << " " << at.y - arm << "\"/>";
}

void draw_mark(SvgCanvas& canvas, const ViolationScene& scene, std::size_t number) {
  const Violation& violation = scene.report.violations[number];
  if (violation.agent >= scene.instance.agents.size()) return;
  const Agent& agent = scene.instance.agents[violation.agent];
  const Vec2 at = position_at(scene.trajectories[violation.agent], violation.time_s);
  const std::string colour = std::string("=\"") + kViolationColour + "\"";
  const std::string body = "stroke" + colour + " fill" + colour + " fill-opacity=\".22\" stroke-width=\"" +
                           short_number(std::max(0.06, 1 / canvas.cell_px())) + "\"";
  canvas << "<g>";
  canvas.tooltip(violation.message);
  canvas.circle(at, agent.radius_cells, body);
  Vec2 mark = at;
  std::string words = std::to_string(number + 1) + ": " + agent.id;
  if (const auto other = other_body(scene, violation)) {
    canvas.circle(other->at, other->radius_cells, body);
    mark = at + (other->at - at) * (agent.radius_cells / (agent.radius_cells + other->radius_cells));
    words += " and " + other->name;
  }
  draw_cross(canvas, mark);
  if (number < kMaxListed) {
    draw_label(canvas, scene, words + ", depth " + short_number(violation.depth_cells), mark,
               agent.radius_cells);
  }
  canvas << "</g>\n";
}

}  // namespace

void draw_violation_marks(SvgCanvas& canvas, const ViolationScene& scene) {
  // Backwards, so that the first one, which a person reads first, lies on top.
  for (std::size_t i = std::min(scene.report.violations.size(), kMaxMarked); i > 0; --i) {
    draw_mark(canvas, scene, i - 1);
  }
}

double violation_list_height_px(const ValidationReport& report) {
  if (report.violations.empty()) return 0;
  const std::size_t lines = std::min(report.violations.size(), kMaxListed + 1);  // the last: "and more"
  return kLineHeightPx * (static_cast<double>(lines) + 1);
}

void draw_violation_list(SvgCanvas& canvas, const ValidationReport& report, Vec2 corner_px) {
  const std::string style = std::string("fill=\"") + kViolationColour + "\"";
  constexpr double kFontPx = 13;
  for (std::size_t i = 0; i < std::min(report.violations.size(), kMaxListed); ++i) {
    corner_px.y += kLineHeightPx;
    canvas.text(corner_px, kFontPx, style, std::to_string(i + 1) + ": " + report.violations[i].message);
    canvas << "\n";
  }
  if (report.violations.size() <= kMaxListed) return;
  corner_px.y += kLineHeightPx;
  canvas.text(corner_px, kFontPx, style,
              "and " + std::to_string(report.violations.size() - kMaxListed) + " more");
}

}  // namespace sipplab
