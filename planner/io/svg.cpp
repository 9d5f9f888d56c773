// One picture of a solution: see svg.hpp. Robots and map are drawn in units of
// cells inside a scaled group; title, legend and list of violations in pixels.
#include "sipplab/svg.hpp"

#include <algorithm>
#include <cmath>
#include <optional>
#include <set>

#include "planner/io/svg_animation.hpp"
#include "planner/io/svg_paint.hpp"
#include "planner/io/svg_violations.hpp"
#include "planner/io/text.hpp"

namespace sipplab {
namespace {

// Pixels.
constexpr double kWantedMapSide = 960;
constexpr double kMaxCellSide = 56;
constexpr double kMinCellSide = 2;
constexpr double kMargin = 24;
constexpr double kHeaderHeight = 96;
constexpr double kMinPageWidth = 560;
constexpr double kGridLinesFromCellSide = 9;
constexpr double kIdsFromCellSide = 11;
/// Smaller letters inside a disk cannot be read: the id moves next to it.
constexpr double kSmallestIdInside = 8;
constexpr double kIdBeside = 12;

constexpr double kGoalBehindRobots = 0.25;
constexpr std::size_t kMaxRobotsWithIds = 150;
constexpr std::size_t kMaxRobotsWithIdsBeside = 40;

constexpr const char* kGrey = "#7b8190";

double cell_side_px(const GridMap& map) {
  return std::clamp(kWantedMapSide / std::max(map.width(), map.height()), kMinCellSide, kMaxCellSide);
}

/// How much ink a robot gets, in cells and shares, by how many there are.
struct Ink {
  double line_cells = 0;
  double line_opacity = 1;
  double goal_opacity = 1;
};

Ink ink_for(std::size_t robots, double cell_px) {
  Ink ink{0.13, 0.95, 0.9};
  if (robots > 24) ink = {0.09, 0.8, 0.75};
  if (robots > 150) ink = {0.06, 0.55, 0.6};
  if (robots > 1000) ink = {0.05, 0.25, 0.5};
  if (robots > 4000) ink = {0.05, 0.1, 0.4};
  constexpr double kThinnestPx = 0.7;
  ink.line_cells = std::max(ink.line_cells, kThinnestPx / cell_px);
  return ink;
}

std::string text_of(Cell cell) { return "(" + std::to_string(cell.x) + ", " + std::to_string(cell.y) + ")"; }
std::string seconds(double time_s) { return short_decimal(time_s) + " s"; }

class Painter {
 public:
  Painter(const Instance& instance, const Solution& solution, const ValidationReport& report,
          const SvgOptions& options)
      : instance_(instance),
        report_(report),
        options_(options),
        trajectories_(solution.trajectories),
        solved_(solution.trajectories.size() == instance.agents.size()),
        cell_px_(cell_side_px(instance.map)),
        ink_(ink_for(instance.agents.size(), cell_px_)),
        with_ids_(instance.agents.size() <= kMaxRobotsWithIds && cell_px_ >= kIdsFromCellSide),
        canvas_(cell_px_, 3) {
    // What has no trajectory rests at its start.
    for (std::size_t i = trajectories_.size(); i < instance.agents.size(); ++i) {
      trajectories_.push_back({instance.agents[i].start, {}});
    }
    if (options.animation_speed > 0 && solved_) start_clock();
  }

  std::string paint() {
    open_page();
    header();
    open_world();
    map();
    obstacles();
    lines();
    goals();
    starts();
    if (clock_) bodies();
    draw_violation_marks(canvas_, {instance_, trajectories_, report_});
    canvas_ << "</g>\n";
    draw_violation_list(canvas_, report_, {kMargin, kHeaderHeight + map_height_px() + kMargin / 2});
    canvas_ << "</svg>\n";
    return canvas_.take();
  }

 private:
  void start_clock() {
    double end_s = 0;
    const auto follow = [&end_s](const Trajectory& trajectory) {
      double last_s = 0;
      for (const TimedMotion& motion : trajectory.motions) {
        if (!(motion.begin_s >= last_s && motion.end_s >= motion.begin_s && std::isfinite(motion.end_s)))
          return false;
        last_s = motion.end_s;
      }
      end_s = std::max(end_s, last_s);
      return true;
    };
    for (const Trajectory& trajectory : trajectories_) {
      if (!follow(trajectory)) return;
    }
    for (const DynamicObstacle& obstacle : instance_.obstacles) follow(obstacle.trajectory);
    clock_.emplace(end_s, options_.animation_speed);
  }

  double map_width_px() const { return cell_px_ * instance_.map.width(); }
  double map_height_px() const { return cell_px_ * instance_.map.height(); }

  void open_page() {
    const double width = std::max(map_width_px() + 2 * kMargin, kMinPageWidth);
    const double height = kHeaderHeight + map_height_px() + kMargin + violation_list_height_px(report_);
    canvas_.open_page(width, height,
                      "aria-labelledby=\"title description\" "
                      "font-family=\"DejaVu Sans, Verdana, Helvetica, Arial, sans-serif\"");
    canvas_ << "<title id=\"title\">";
    canvas_.label(options_.title);
    canvas_ << "</title>\n<desc id=\"description\">";
    canvas_.label(description());
    canvas_ << "</desc>\n<rect width=\"100%\" height=\"100%\" fill=\"#ffffff\"/>\n";
  }

  std::string description() const {
    const auto count = [](std::size_t number, const char* thing) {
      return std::to_string(number) + " " + thing + (number == 1 ? "" : "s");
    };
    std::string words = count(instance_.agents.size(), "robot") + " on a map of " +
                        std::to_string(instance_.map.width()) + " x " +
                        std::to_string(instance_.map.height()) + " cells";
    if (!solved_) words += ", no solution";
    if (!report_.valid()) words += ", " + count(report_.violations.size(), "violation");
    return words;
  }

  /// Title, line below it, legend.
  void header() {
    canvas_.text({kMargin, 30}, 19, "font-weight=\"bold\" fill=\"#1d2230\"", options_.title);
    const std::string below = options_.subtitle.empty() ? description() : options_.subtitle;
    canvas_.text({kMargin, 51}, 13, "fill=\"#4b5160\"", below);
    canvas_ << "\n<g font-size=\"12\" fill=\"#4b5160\">";
    double x = kMargin;
    const auto entry = [&](const std::string& symbol, const std::string& words) {
      constexpr double kY = 75;
      constexpr double kSymbolPx = 24;
      constexpr double kCharacterPx = 7;
      constexpr double kGapPx = 18;
      canvas_ << "<g transform=\"translate(" << x << " " << kY << ")\">" << symbol;
      canvas_ << "<text x=\"24\" y=\"4\">" << words << "</text></g>";
      x += kSymbolPx + kCharacterPx * static_cast<double>(words.size()) + kGapPx;
    };
    const std::string in_colour = "=\"" + robot_colour(0) + "\"";
    entry("<circle cx=\"10\" r=\"7\" fill=\"#ffffff\" stroke-width=\"2\" stroke" + in_colour + "/>", "start");
    const std::string faint = clock_ ? " fill-opacity=\"" + short_decimal(kGoalBehindRobots) + "\"/>" : "/>";
    entry("<circle cx=\"10\" r=\"8\" fill" + in_colour + faint, "goal");
    if (clock_) {
      entry("<circle cx=\"10\" r=\"8\" stroke=\"#1d2230\" fill" + in_colour + "/>", "robot");
    }
    if (solved_) {
      entry("<path d=\"M0 4L8 -4H20\" fill=\"none\" stroke-width=\"2.5\" stroke" + in_colour + "/>",
            "trajectory");
    }
    entry("<rect x=\"3\" y=\"-7\" width=\"14\" height=\"14\" fill=\"#4b5160\"/>", "blocked");
    const auto stroke = [](const char* colour) { return std::string(" stroke=\"") + colour + "\"/>"; };
    if (!instance_.obstacles.empty()) {
      entry("<path d=\"M0 0H20\" stroke-width=\"2\" stroke-dasharray=\"4 3\"" + stroke(kGrey),
            "moving obstacle");
    }
    if (!report_.valid()) {
      entry("<path d=\"M4 -6L16 6M16 -6L4 6\" stroke-width=\"3\"" + stroke(kViolationColour), "violation");
    }
    canvas_ << "</g>\n";
    if (clock_) progress_bar();
  }

  /// How much of the plan has been played, between header and map.
  void progress_bar() {
    constexpr double kHeightPx = 3;
    canvas_ << "<rect fill=\"#4b5160\"";
    canvas_.attribute("x", kMargin);
    canvas_.attribute("y", kHeaderHeight - 2 * kHeightPx);
    canvas_.attribute("width", 0);
    canvas_.attribute("height", kHeightPx);
    canvas_ << ">";
    draw_progress(canvas_, map_width_px(), *clock_);
    canvas_ << "</rect>\n";
  }

  /// From here on one unit is one cell and the centre of cell (0, 0) is the origin.
  void open_world() {
    canvas_ << "<g stroke-linejoin=\"round\" stroke-linecap=\"round\" transform=\"translate("
            << kMargin + cell_px_ / 2 << " " << kHeaderHeight + cell_px_ / 2 << ") scale("
            << format_real(cell_px_) << ")\">\n";
  }

  void map() {
    const auto frame = [this](const std::string& style) {
      canvas_ << "<rect x=\"-.5\" y=\"-.5\"";
      canvas_.attribute("width", instance_.map.width());
      canvas_.attribute("height", instance_.map.height());
      canvas_ << " " << style << "/>\n";
    };
    frame("fill=\"#fafbfc\"");
    if (cell_px_ >= kGridLinesFromCellSide) draw_grid_lines(canvas_, instance_.map);
    draw_blocked_cells(canvas_, instance_.map);
    frame("fill=\"none\" stroke=\"#4b5160\" stroke-width=\"" + short_decimal(1.5 / cell_px_) + "\"");
  }

  void obstacles() {
    for (const DynamicObstacle& obstacle : instance_.obstacles) {
      const Trajectory& trajectory = obstacle.trajectory;
      canvas_ << "<g>";
      canvas_.tooltip("moving obstacle " + obstacle.id + ": radius " + format_real(obstacle.radius_cells) +
                      ", " + text_of(trajectory.start) + " to " + text_of(trajectory.end()) + " until " +
                      seconds(trajectory.arrival_s()));
      canvas_ << "<polyline fill=\"none\" stroke=\"" << kGrey << "\" stroke-dasharray=\".35 .3\"";
      canvas_.attribute("stroke-width", std::max(0.1, 1 / cell_px_));
      canvas_ << " points=\"";
      draw_points(canvas_, trajectory);
      canvas_ << "\"/>";
      const std::string grey = std::string("=\"") + kGrey + "\"";
      canvas_.circle(
          centre(trajectory.start), obstacle.radius_cells,
          "fill=\"#d5d8de\" fill-opacity=\".7\" stroke-width=\".08\" stroke-dasharray=\".2 .15\" stroke" +
              grey);
      canvas_.circle(centre(trajectory.end()), obstacle.radius_cells, "fill-opacity=\".55\" fill" + grey);
      canvas_ << "</g>\n";
    }
  }

  std::string story(std::size_t i) const {
    const Agent& agent = instance_.agents[i];
    std::string words = "robot " + agent.id + ": " + text_of(agent.start) + " to " + text_of(agent.goal) +
                        ", radius " + format_real(agent.radius_cells);
    if (solved_) words += ", arrives at " + seconds(trajectories_[i].arrival_s());
    return words;
  }

  /// All trajectories before all bodies, so that no line crosses a label.
  void lines() {
    canvas_ << "<g fill=\"none\"";
    canvas_.attribute("stroke-width", ink_.line_cells);
    canvas_.attribute("stroke-opacity", ink_.line_opacity);
    canvas_ << ">\n";
    for (std::size_t i = 0; i < instance_.agents.size(); ++i) {
      if (trajectories_[i].motions.empty()) continue;
      canvas_ << "<polyline stroke=\"" << robot_colour(i) << "\" points=\"";
      draw_points(canvas_, trajectories_[i]);
      canvas_ << "\">";
      canvas_.tooltip(story(i));
      canvas_ << "</polyline>\n";
    }
    canvas_ << "</g>\n";
  }

  /// Disks at the goals, in true size.
  void goals() {
    for (std::size_t i = 0; i < instance_.agents.size(); ++i) {
      const Agent& agent = instance_.agents[i];
      const std::string in_colour = "=\"" + robot_colour(i) + "\"";
      canvas_ << "<g>";
      canvas_.tooltip(story(i));
      // Where robots move, what stands still steps back.
      const double opacity = clock_ ? kGoalBehindRobots : ink_.goal_opacity;
      canvas_.circle(centre(agent.goal), agent.radius_cells,
                     "fill" + in_colour + " fill-opacity=\"" + short_decimal(opacity) + "\"");
      id(agent, agent.goal, agent.radius_cells, in_colour, clock_ ? in_colour : "=\"#ffffff\"");
      canvas_ << "</g>\n";
    }
  }

  /// Rings at the starts, in true size; smaller if a goal would be hidden.
  void starts() {
    std::set<Cell> goal_cells;
    for (const Agent& agent : instance_.agents) goal_cells.insert(agent.goal);
    for (std::size_t i = 0; i < instance_.agents.size(); ++i) {
      const Agent& agent = instance_.agents[i];
      const std::string in_colour = "=\"" + robot_colour(i) + "\"";
      const double ring_cells = std::max(std::min(0.09, agent.radius_cells / 3), 0.6 / cell_px_);
      constexpr double kShareOverGoal = 0.66;
      const double radius = agent.radius_cells * (goal_cells.count(agent.start) != 0 ? kShareOverGoal : 1);
      canvas_ << "<g>";
      canvas_.tooltip(story(i));
      // The ring lies inside of the body, whose rim is its outer edge.
      canvas_.circle(centre(agent.start), std::max(radius - ring_cells / 2, 0.01),
                     "fill=\"#ffffff\" stroke" + in_colour + " fill-opacity=\"" +
                         (with_ids_ ? "0.85" : "0.35") + "\" stroke-width=\"" + short_decimal(ring_cells) +
                         "\"");
      id(agent, agent.start, radius, in_colour, in_colour);
      canvas_ << "</g>\n";
    }
  }

  /// The robots themselves, and the obstacles, on their way.
  void bodies() {
    const auto moving = [this](const Trajectory& trajectory, double radius, const std::string& style) {
      canvas_ << "<g transform=\"translate(" << trajectory.start.x << " " << trajectory.start.y << ")\">";
      draw_movement(canvas_, trajectory, *clock_);
      canvas_.circle({0, 0}, radius, style);
    };
    for (const DynamicObstacle& obstacle : instance_.obstacles) {
      moving(obstacle.trajectory, obstacle.radius_cells, std::string("fill=\"") + kGrey + "\"");
      canvas_ << "</g>\n";
    }
    for (std::size_t i = 0; i < instance_.agents.size(); ++i) {
      const Agent& agent = instance_.agents[i];
      const double rim_cells = std::max(0.04, 0.5 / cell_px_);
      moving(trajectories_[i], std::max(agent.radius_cells - rim_cells / 2, 0.01),
             "stroke=\"#1d2230\" stroke-width=\"" + short_decimal(rim_cells) + "\" fill=\"" +
                 robot_colour(i) + "\"");
      canvas_.tooltip(story(i));
      id(agent, {0, 0}, agent.radius_cells, "=\"#1d2230\"", "=\"#ffffff\"");
      canvas_ << "</g>\n";
    }
  }

  /// The robot's id within a disk of this radius, or next to it if the disk is too small.
  void id(const Agent& agent, Cell cell, double radius, const std::string& in_colour,
          const std::string& in_disk) {
    if (!with_ids_) return;
    const double letters = std::max<double>(2, static_cast<double>(agent.id.size()));
    const double inside_cells = std::min(1.1, 2.1 / letters) * radius;
    if (inside_cells * cell_px_ >= kSmallestIdInside) {
      const Vec2 down{0, 0.36 * inside_cells};  // half of a digit's height
      canvas_.text(centre(cell) + down, inside_cells, "text-anchor=\"middle\" fill" + in_disk, agent.id);
    } else if (instance_.agents.size() <= kMaxRobotsWithIdsBeside) {
      const double size = kIdBeside / cell_px_;
      const Vec2 aside{agent.radius_cells * 0.8 + 0.1 * size, -agent.radius_cells * 0.8};
      canvas_.text(centre(cell) + aside, size,
                   "font-weight=\"bold\" paint-order=\"stroke\" stroke=\"#ffffff\" stroke-width=\"" +
                       short_decimal(0.25 * size) + "\" fill" + in_colour,
                   agent.id);
    }
  }

  const Instance& instance_;
  const ValidationReport& report_;
  const SvgOptions& options_;
  std::vector<Trajectory> trajectories_;
  bool solved_;
  double cell_px_;
  Ink ink_;
  bool with_ids_;
  SvgCanvas canvas_;
  std::optional<SvgClock> clock_;  ///< of a picture that moves
};

}  // namespace

std::string draw_svg(const Instance& instance, const Solution& solution, const ValidationReport& report,
                     const SvgOptions& options) {
  return Painter(instance, solution, report, options).paint();
}

}  // namespace sipplab
