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

/// Places labels near their marks, inside of the map and not on each other.
class LabelPlacer {
 public:
  LabelPlacer(double cell_px, const GridMap& map) : size_(kLabelPx / cell_px), map_(map) {}

  /// Height of the letters, in cells.
  double size() const { return size_; }

  struct Box {
    double left = 0, top = 0, width = 0, height = 0;

    bool overlaps(const Box& other) const {
      return left < other.left + other.width && other.left < left + width && top < other.top + other.height &&
             other.top < top + height;
    }
  };

  /// A free place above or below the mark, the nearest one; if all are taken, the first.
  Box place(std::size_t letters, Vec2 mark, double radius_cells) {
    constexpr double kLetterWidth = 0.66;  // of the font's size, bold
    Box box{0, 0, (kLetterWidth * static_cast<double>(letters) + 0.4) * size_, 1.4 * size_};
    const double right_most = std::max(-0.5, map_.width() - 0.5 - box.width);
    box.left = std::clamp(mark.x - box.width / 2, -0.5, right_most);
    constexpr int kSteps = 12;
    for (int step = 0; step < kSteps; ++step) {
      const double away = radius_cells + (1.5 * (step / 2) + 0.2) * size_;
      box.top = step % 2 == 0 ? mark.y - away - box.height : mark.y + away;
      const bool inside = box.top >= -0.5 && box.top + box.height <= map_.height() - 0.5;
      const auto hits = [&box](const Box& other) { return other.overlaps(box); };
      if (inside && std::none_of(placed_.begin(), placed_.end(), hits)) break;
    }
    placed_.push_back(box);
    return box;
  }

 private:
  static constexpr double kLabelPx = 13;

  double size_;
  const GridMap& map_;
  std::vector<Box> placed_;
};

void draw_cross(SvgCanvas& canvas, Vec2 at) {
  const double arm = std::max(0.22, 5 / canvas.unit_px());
  canvas << "<path fill=\"none\" stroke=\"" << kViolationColour << "\"";
  canvas.attribute("stroke-width", std::max(0.12, 2.5 / canvas.unit_px()));
  canvas << " d=\"M" << at.x - arm << " " << at.y - arm << "L" << at.x + arm << " " << at.y + arm;
  canvas << "M" << at.x - arm << " " << at.y + arm << "L" << at.x + arm << " " << at.y - arm << "\"/>";
}

/// Where a violation is and whom it concerns.
struct Mark {
  Vec2 at;
  double radius_cells = 0;
  std::string words;
};

Mark mark_of(const ViolationScene& scene, std::size_t number) {
  const Violation& violation = scene.report.violations[number];
  const Agent& agent = scene.instance.agents[violation.agent];
  Mark mark{position_at(scene.trajectories[violation.agent], violation.time_s), agent.radius_cells,
            std::to_string(number + 1) + ": " + agent.id};
  if (const auto other = other_body(scene, violation)) {
    // Between the two, where their rims would touch.
    const double share = agent.radius_cells / (agent.radius_cells + other->radius_cells);
    mark.at = mark.at + (other->at - mark.at) * share;
    mark.words += " and " + other->name;
  }
  mark.words += ", depth " + short_decimal(violation.depth_cells);
  return mark;
}

bool is_drawable(const ViolationScene& scene, std::size_t number) {
  return scene.report.violations[number].agent < scene.instance.agents.size();
}

void draw_mark(SvgCanvas& canvas, const ViolationScene& scene, std::size_t number) {
  const Violation& violation = scene.report.violations[number];
  const Vec2 at = position_at(scene.trajectories[violation.agent], violation.time_s);
  const std::string colour = std::string("=\"") + kViolationColour + "\"";
  const std::string body = "stroke" + colour + " fill" + colour + " fill-opacity=\".22\" stroke-width=\"" +
                           short_decimal(std::max(0.06, 1 / canvas.unit_px())) + "\"";
  canvas << "<g>";
  canvas.tooltip(violation.message);
  canvas.circle(at, scene.instance.agents[violation.agent].radius_cells, body);
  if (const auto other = other_body(scene, violation)) canvas.circle(other->at, other->radius_cells, body);
  draw_cross(canvas, mark_of(scene, number).at);
  canvas << "</g>\n";
}

void draw_label(SvgCanvas& canvas, LabelPlacer& placer, const Mark& mark) {
  const LabelPlacer::Box box = placer.place(mark.words.size(), mark.at, mark.radius_cells);
  const bool above = box.top < mark.at.y;
  const Vec2 anchor{std::clamp(mark.at.x, box.left, box.left + box.width),
                    above ? box.top + box.height : box.top};
  canvas << "<path stroke=\"" << kViolationColour << "\"";
  canvas.attribute("stroke-width", 1 / canvas.unit_px());
  canvas << " d=\"M" << mark.at.x << " " << mark.at.y << "L" << anchor.x << " " << anchor.y << "\"/>";
  canvas << "<rect fill=\"#ffffff\" fill-opacity=\".88\"";
  canvas.attribute("x", box.left);
  canvas.attribute("y", box.top);
  canvas.attribute("width", box.width);
  canvas.attribute("height", box.height);
  canvas.attribute("rx", 0.25 * placer.size());
  canvas << "/>";
  canvas.text({box.left + 0.2 * placer.size(), box.top + 1.05 * placer.size()}, placer.size(),
              std::string("font-weight=\"bold\" fill=\"") + kViolationColour + "\"", mark.words);
  canvas << "\n";
}

}  // namespace

void draw_violation_marks(SvgCanvas& canvas, const ViolationScene& scene) {
  const std::size_t count = std::min(scene.report.violations.size(), kMaxMarked);
  for (std::size_t i = 0; i < count; ++i) {
    if (is_drawable(scene, i)) draw_mark(canvas, scene, i);
  }
  LabelPlacer placer(canvas.unit_px(), scene.instance.map);
  for (std::size_t i = 0; i < std::min(count, kMaxListed); ++i) {
    if (is_drawable(scene, i)) draw_label(canvas, placer, mark_of(scene, i));
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
