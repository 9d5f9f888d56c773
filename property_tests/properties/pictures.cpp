// Pictures show what is in a plan: each number in an SVG text is looked up in it and computed here once more.
#include <rapidcheck.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <map>
#include <pugixml.hpp>
#include <set>
#include <sstream>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "property_tests/support/generators.hpp"
#include "property_tests/support/property.hpp"
#include "property_tests/support/sampling_oracle.hpp"
#include "property_tests/support/texts.hpp"
#include "sipplab/svg.hpp"

namespace sipplab::pictures_laws {
namespace {

/// Cells: places have three decimals.
constexpr double kRoundingCells = 0.0005 + 1e-9;

bool is_near(double one, double other, double error = kRoundingCells) {
  return std::abs(one - other) <= error;
}

struct Picture {
  Scene scene;
  ValidationReport report;
  SvgOptions options;
  pugi::xml_document document;

  /// All elements of this name, in document order.
  std::vector<pugi::xml_node> all(const char* name) const {
    std::vector<pugi::xml_node> found;
    collect(document, name, found);
    return found;
  }

 private:
  static void collect(pugi::xml_node node, const char* name, std::vector<pugi::xml_node>& found) {
    for (const pugi::xml_node child : node.children()) {
      if (std::string_view(child.name()) == name) found.push_back(child);
      collect(child, name, found);
    }
  }
};

std::unique_ptr<Picture> any_picture(bool moves) {
  auto picture = std::make_unique<Picture>();
  picture->scene = *any_scene();
  Instance& instance = picture->scene.instance;
  for (std::size_t i = 0; i < instance.agents.size(); ++i) instance.agents[i].id = std::to_string(i);
  ValidationOptions options;
  options.max_violations = *rc::gen::element<std::size_t>(1000, 3);
  options.ssi_s = *rc::gen::element(0.0, 2.0);
  for (AgentIndex i = 0; i < instance.agents.size(); ++i) options.order.push_back(i);
  picture->report = validate(instance, picture->scene.solution, options);
  picture->options.title = *any_text();
  if (moves) {
    picture->options.animation_speed = *rc::gen::element(1.0, 4.0, 0.5);
    // Whoever is not said to wait waits all the same.
    for (Trajectory& trajectory : picture->scene.solution.trajectories) {
      std::erase_if(trajectory.motions, [](const TimedMotion& motion) {
        return motion.is_wait() && *rc::gen::arbitrary<bool>();
      });
    }
  }
  const std::string text = draw_svg(instance, picture->scene.solution, picture->report, picture->options);
  RC_ASSERT(static_cast<bool>(picture->document.load_string(text.c_str())));
  return picture;
}

std::string title_of(pugi::xml_node node) { return node.child("title").text().get(); }

/// Groups whose hover text tells of this robot and that hold a circle.
std::vector<pugi::xml_node> groups_of(const Picture& picture, AgentIndex agent) {
  std::vector<pugi::xml_node> found;
  const std::string words = "robot " + std::to_string(agent) + ": ";
  for (const pugi::xml_node group : picture.all("g")) {
    const bool tells =
        title_of(group).rfind(words, 0) == 0 || title_of(group.child("circle")).rfind(words, 0) == 0;
    if (tells && group.child("circle")) found.push_back(group);
  }
  return found;
}

double number(pugi::xml_node node, const char* name) { return node.attribute(name).as_double(-1e9); }

void shows_circle(pugi::xml_node circle, Vec2 at, double rim_cells) {
  RC_ASSERT(is_near(number(circle, "cx"), at.x));
  RC_ASSERT(is_near(number(circle, "cy"), at.y));
  const double stroke = circle.attribute("stroke") ? circle.attribute("stroke-width").as_double() : 0;
  RC_ASSERT(is_near(number(circle, "r") + stroke / 2, rim_cells, 2 * kRoundingCells));
}

/// "1,2 3,4".
std::vector<Cell> points_of(const std::string& text) {
  std::vector<Cell> points;
  std::istringstream words(text);
  for (std::string word; words >> word;) {
    const std::size_t comma = word.find(',');
    points.push_back({std::stoi(word.substr(0, comma)), std::stoi(word.substr(comma + 1))});
  }
  return points;
}

std::vector<Cell> places_of(const Trajectory& trajectory) {
  std::vector<Cell> places = {trajectory.start};
  for (const TimedMotion& motion : trajectory.motions) {
    if (motion.from != motion.to) places.push_back(motion.to);
  }
  return places;
}

void shows_lines(const Picture& picture) {
  const auto& trajectories = picture.scene.solution.trajectories;
  std::vector<std::vector<Cell>> expected;
  for (const DynamicObstacle& obstacle : picture.scene.instance.obstacles) {
    expected.push_back(places_of(obstacle.trajectory));
  }
  for (const Trajectory& trajectory : trajectories) {
    if (!trajectory.motions.empty()) expected.push_back(places_of(trajectory));
  }
  std::vector<std::vector<Cell>> found;
  for (const pugi::xml_node line : picture.all("polyline")) {
    found.push_back(points_of(line.attribute("points").value()));
  }
  RC_ASSERT(found == expected);
}

void shows_bodies(const Picture& picture) {
  const Instance& instance = picture.scene.instance;
  std::set<Cell> goals;
  for (const Agent& agent : instance.agents) goals.insert(agent.goal);
  std::set<std::string> colours;
  for (AgentIndex i = 0; i < instance.agents.size(); ++i) {
    const Agent& agent = instance.agents[i];
    const std::vector<pugi::xml_node> groups = groups_of(picture, i);
    RC_ASSERT(groups.size() == (picture.options.animation_speed > 0 ? 3u : 2u));
    shows_circle(groups[0].child("circle"), centre(agent.goal), agent.radius_cells);
    const double share = goals.count(agent.start) > 0 ? 0.66 : 1;
    if (agent.radius_cells > 0.1)
      shows_circle(groups[1].child("circle"), centre(agent.start), share * agent.radius_cells);
    colours.insert(groups[0].child("circle").attribute("fill").value());
    if (groups.size() > 2 && agent.radius_cells > 0.1) {
      shows_circle(groups[2].child("circle"), {0, 0}, agent.radius_cells);
    }
    const auto text = [](Cell cell) {
      return "(" + std::to_string(cell.x) + ", " + std::to_string(cell.y) + ")";
    };
    const std::string story = title_of(groups[0]);
    RC_ASSERT(story.find(": " + text(agent.start) + " to " + text(agent.goal) + ", radius ") !=
              std::string::npos);
    const std::size_t arrives = story.find(", arrives at ");
    RC_ASSERT(arrives != std::string::npos);
    RC_ASSERT(
        is_near(std::stod(story.substr(arrives + 13)), picture.scene.solution.trajectories[i].arrival_s()));
  }
  RC_ASSERT(colours.size() == instance.agents.size());
  std::size_t obstacle = 0;
  for (const pugi::xml_node group : picture.all("g")) {
    if (title_of(group).rfind("moving obstacle", 0) != 0 || !group.child("polyline")) continue;
    const DynamicObstacle& expected = instance.obstacles[obstacle++];
    const pugi::xml_node start = group.child("circle");
    RC_ASSERT(is_near(number(start, "cx"), expected.trajectory.start.x));
    RC_ASSERT(is_near(number(start, "cy"), expected.trajectory.start.y));
    RC_ASSERT(is_near(number(start, "r"), expected.radius_cells));
    shows_circle(start.next_sibling("circle"), centre(expected.trajectory.end()), expected.radius_cells);
  }
  RC_ASSERT(obstacle == instance.obstacles.size());
}

/// "M2 1h2v1h-2z" is cells (2, 1) and (3, 1).
void shows_the_map(const Picture& picture) {
  const GridMap& map = picture.scene.instance.map;
  std::set<Cell> blocked;
  std::set<std::pair<char, int>> lines;
  for (const pugi::xml_node path : picture.all("path")) {
    if (!path.attribute("transform")) continue;
    const bool is_grid = path.attribute("stroke");
    RC_ASSERT(std::string_view(path.attribute("transform").value()) == "translate(-.5 -.5)");
    std::istringstream text(path.attribute("d").value());
    for (std::string run; std::getline(text, run, 'M');) {
      if (run.empty()) continue;
      int x = 0, y = 0, length = 0, back = 0;
      char direction = ' ';
      std::istringstream numbers(run);
      numbers >> x >> y >> direction >> length;
      if (is_grid) {
        RC_ASSERT(length == (direction == 'v' ? map.height() : map.width()));
        RC_ASSERT((direction == 'v' ? y : x) == 0);
        lines.emplace(direction, direction == 'v' ? x : y);
        continue;
      }
      std::string rest;
      numbers >> rest;
      RC_ASSERT(std::sscanf(rest.c_str(), "v1h-%d", &back) == 1);
      RC_ASSERT(back == length);
      for (int i = 0; i < length; ++i) blocked.insert({x + i, y});
    }
  }
  std::set<Cell> expected;
  for (std::size_t i = 0; i < map.cell_count(); ++i) {
    if (map.is_blocked(map.cell(i))) expected.insert(map.cell(i));
  }
  RC_ASSERT(blocked == expected);
  if (lines.empty()) return;  // cells too small, or but one
  RC_ASSERT(lines.size() == static_cast<std::size_t>(map.width() - 1 + map.height() - 1));
  for (const auto& [direction, at] : lines) {
    RC_ASSERT(at >= 1);
    RC_ASSERT(at < (direction == 'v' ? map.width() : map.height()));
  }
}

/// The marks of violations, one circle for each body at the time of deepest overlap.
void shows_violations(const Picture& picture) {
  const Instance& instance = picture.scene.instance;
  std::map<std::string, std::vector<std::vector<pugi::xml_node>>> marks;  // by message
  for (const pugi::xml_node group : picture.all("g")) {
    const pugi::xml_node circle = group.child("circle");
    if (std::string_view(circle.attribute("stroke").value()) != "#d4142a") continue;
    std::vector<pugi::xml_node> circles(group.children("circle").begin(), group.children("circle").end());
    marks[title_of(group)].push_back(circles);
  }
  std::size_t shown = 0;
  for (const auto& [message, groups] : marks) shown += groups.size();
  RC_ASSERT(shown == std::min<std::size_t>(picture.report.violations.size(), 100));
  for (const Violation& violation : picture.report.violations) {
    if (shown < picture.report.violations.size()) break;
    const auto found = marks.find(violation.message);
    RC_ASSERT(found != marks.end());
    const std::vector<pugi::xml_node>& circles = found->second.front();
    const auto place = [&](const Trajectory& trajectory) {
      return sampled_position(trajectory, violation.time_s);
    };
    // A body that jumps in time has no one place.
    shows_circle(
        circles[0], place(picture.scene.solution.trajectories[violation.agent]),
        instance.agents[violation.agent].radius_cells + circles[0].attribute("stroke-width").as_double() / 2);
    RC_ASSERT(circles.size() == (violation.other ? 2u : 1u));
    if (!violation.other) continue;
    const double rim = circles[1].attribute("stroke-width").as_double() / 2;
    if (violation.kind == ViolationKind::kObstacleCollision) {
      const DynamicObstacle& other = instance.obstacles[*violation.other];
      shows_circle(circles[1], place(other.trajectory), other.radius_cells + rim);
    } else {
      const Agent& other = instance.agents[*violation.other];
      const Vec2 at = violation.kind == ViolationKind::kStartSafeInterval
                          ? centre(other.start)
                          : place(picture.scene.solution.trajectories[*violation.other]);
      shows_circle(circles[1], at, other.radius_cells + rim);
    }
  }
  std::size_t listed = 0;
  std::size_t more = 0;
  for (const pugi::xml_node text : picture.all("text")) {
    const std::string words = text.text().get();
    if (words.rfind("and ", 0) == 0 && words.find(" more") != std::string::npos) {
      more = static_cast<std::size_t>(std::stoul(words.substr(4)));
    }
    const std::string next = std::to_string(listed + 1) + ": ";
    if (listed < picture.report.violations.size() &&
        words == next + picture.report.violations[listed].message) {
      ++listed;
    }
  }
  RC_ASSERT(listed + more == picture.report.violations.size());
  RC_ASSERT(listed <= 12u);
}

std::vector<std::string> parts_of(const std::string& text, char separator) {
  std::vector<std::string> parts;
  std::istringstream stream(text);
  for (std::string part; std::getline(stream, part, separator);) parts.push_back(part);
  return parts;
}

/// Where a browser shows a body at this share of a round.
Vec2 played_at(pugi::xml_node movement, double share) {
  const std::vector<std::string> times = parts_of(movement.attribute("keyTimes").value(), ';');
  const std::vector<std::string> values = parts_of(movement.attribute("values").value(), ';');
  RC_ASSERT(times.size() == values.size());
  RC_ASSERT(std::stod(times.front()) == 0);
  RC_ASSERT(std::stod(times.back()) == 1);
  const auto place = [&](std::size_t i) {
    Vec2 at;
    std::istringstream(values[i]) >> at.x >> at.y;
    return at;
  };
  for (std::size_t i = 1; i < times.size(); ++i) {
    const double begin = std::stod(times[i - 1]);
    const double end = std::stod(times[i]);
    if (share > end || end <= begin) continue;
    return place(i - 1) + (place(i) - place(i - 1)) * ((share - begin) / (end - begin));
  }
  return place(times.size() - 1);
}

void plays_the_plan(const Picture& picture) {
  constexpr double kRestS = 1.5;
  const auto& trajectories = picture.scene.solution.trajectories;
  std::vector<const Trajectory*> bodies;
  for (const DynamicObstacle& obstacle : picture.scene.instance.obstacles)
    bodies.push_back(&obstacle.trajectory);
  for (const Trajectory& trajectory : trajectories) bodies.push_back(&trajectory);
  double end_s = 0;
  for (const Trajectory* trajectory : bodies) end_s = std::max(end_s, trajectory->end_s());
  const double speed = picture.options.animation_speed;
  const double round_s = end_s + kRestS * speed;
  const std::vector<pugi::xml_node> movements = picture.all("animateTransform");
  RC_ASSERT(movements.size() == bodies.size());
  for (std::size_t i = 0; i < bodies.size(); ++i) {
    RC_ASSERT(is_near(std::stod(movements[i].attribute("dur").value()), round_s / speed));
    double fastest = 0;
    for (const TimedMotion& motion : bodies[i]->motions) {
      if (motion.end_s > motion.begin_s)
        fastest = std::max(fastest, distance(motion.from, motion.to) / (motion.end_s - motion.begin_s));
    }
    constexpr int kMoments = 23;
    for (int moment = 0; moment <= kMoments; ++moment) {
      const double time_s = round_s * moment / kMoments;
      const Vec2 shown = played_at(movements[i], time_s / round_s);
      // Shares have six decimals.
      RC_ASSERT(norm(shown - sampled_position(*bodies[i], time_s)) <=
                2e-6 * round_s * fastest + kRoundingCells);
    }
  }
  const std::vector<pugi::xml_node> progress = picture.all("animate");
  RC_ASSERT(progress.size() == 1u);
  RC_ASSERT(
      is_near(std::stod(parts_of(progress[0].attribute("keyTimes").value(), ';')[1]), end_s / round_s, 1e-6));
}

const PropertyRoom room("pictures", [] {
  bool passed = true;

  passed &= property("a picture has the map, all bodies in true size and the way of each", [] {
    const auto picture = any_picture(false);
    shows_the_map(*picture);
    shows_bodies(*picture);
    shows_lines(*picture);
    RC_CLASSIFY(!picture->scene.instance.obstacles.empty(), "moving obstacles");
  });

  passed &= property("a picture marks each violation where and when it is deepest, and lists them", [] {
    const auto picture = any_picture(false);
    shows_violations(*picture);
    RC_CLASSIFY(picture->report.valid(), "valid");
    RC_CLASSIFY(picture->report.violations.size() > 12, "more than are listed");
  });

  passed &= property("a picture that moves plays the plan, rests, and begins again", [] {
    const auto picture = any_picture(true);
    RC_PRE(!picture->scene.solution.trajectories.empty());
    plays_the_plan(*picture);
    shows_bodies(*picture);
  });

  return passed;
});

}  // namespace
}  // namespace sipplab::pictures_laws
